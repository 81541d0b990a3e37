// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric Gauss rules of the triangle, with positive weights and inner points: those of D. A. Dunavant,
// Int. J. Numer. Methods Eng. 21 (1985) 1129-1148, and for degree 10, where his has points close to the
// edges, of F. D. Witherden, P. E. Vincent, Comput. Math. Appl. 69 (2015) 1232-1241. The numbers are computed
// anew, from the published ones, by Newton's method in 50 digits on the moments of the symmetric polynomials.
// Degrees 3, 7, 11 and 13 take the next rule: such rules of their own would save 5 points at most.
#include <algorithm>
#include <vector>

#include "solver/error.hpp"
#include "solver/fe/quadrature.hpp"

namespace esfem {
namespace {

/// The points whose barycentric coordinates are the permutations of (a, b, 1-a-b): 1 (the centre; a, b
/// unused), 3 (a = b; b unused) or 6 of them, each with the same weight.
struct Orbit {
  int size;
  double weight, a, b;
};

struct SymmetricRule {
  int degree;
  std::vector<Orbit> orbits;
};

const std::vector<SymmetricRule>& symmetric_rules() {
  static const std::vector<SymmetricRule> rules = {
      {1, {{1, 0.5, 0, 0}}},
      {2, {{3, 0.16666666666666666, 0.16666666666666666, 0}}},
      {4,
       {{3, 0.11169079483900574, 0.44594849091596489, 0},
        {3, 0.054975871827660935, 0.091576213509770743, 0}}},
      {5,
       {{1, 0.1125, 0, 0},
        {3, 0.066197076394253096, 0.47014206410511511, 0},
        {3, 0.06296959027241357, 0.10128650732345634, 0}}},
      {6,
       {{3, 0.058393137863189684, 0.24928674517091043, 0},
        {3, 0.025422453185103409, 0.063089014491502227, 0},
        {6, 0.041425537809186785, 0.053145049844816945, 0.31035245103378439}}},
      {8,
       {{1, 0.072157803838893586, 0, 0},
        {3, 0.051608685267359122, 0.17056930775176021, 0},
        {3, 0.04754581713364231, 0.45929258829272318, 0},
        {3, 0.01622924881159904, 0.050547228317030977, 0},
        {6, 0.013615157087217496, 0.0083947774099576052, 0.26311282963463811}}},
      {9,
       {{1, 0.048567898141399418, 0, 0},
        {3, 0.015667350113569536, 0.48968251919873762, 0},
        {3, 0.038913770502387139, 0.43708959149293664, 0},
        {3, 0.039823869463605124, 0.18820353561903272, 0},
        {3, 0.012788837829349016, 0.044729513394452712, 0},
        {6, 0.021641769688644688, 0.036838412054736286, 0.22196298916076571}}},
      {10,
       {{1, 0.040871664573142986, 0, 0},
        {3, 0.0066764844065747833, 0.03205537321694351, 0},
        {3, 0.022978981802372365, 0.14216110105656438, 0},
        {6, 0.012648878853644192, 0.028367665339938439, 0.1637017337371825},
        {6, 0.017092324081479714, 0.029619889488729768, 0.36914678182781097},
        {6, 0.031952453198212022, 0.14813288578382056, 0.32181299528883545}}},
      {12,
       {{3, 0.012865533220227668, 0.48821738977380486, 0},
        {3, 0.021846272269019203, 0.43972439229446025, 0},
        {3, 0.031429112108942552, 0.27121038501211592, 0},
        {3, 0.017398056465354472, 0.12757614554158592, 0},
        {3, 0.0030831305257795088, 0.021317350453210371, 0},
        {6, 0.020185778883190463, 0.115343494534698, 0.27571326968551418},
        {6, 0.011178386601151722, 0.022838332222257028, 0.28132558098993954},
        {6, 0.0086581155543294461, 0.02573405054833023, 0.11625191590759715}}},
      {14,
       {{3, 0.010941790684714445, 0.48896391036217862, 0},
        {3, 0.016394176772062674, 0.41764471934045394, 0},
        {3, 0.025887052253645793, 0.27347752830883865, 0},
        {3, 0.021081294368496508, 0.17720553241254344, 0},
        {3, 0.0072168498348883338, 0.061799883090872601, 0},
        {3, 0.0024617018012000409, 0.019390961248701048, 0},
        {6, 0.012332876606281837, 0.05712475740364794, 0.17226668782135557},
        {6, 0.019285755393530342, 0.09291624935697182, 0.33686145979634502},
        {6, 0.0072181540567669202, 0.01464695005565441, 0.29837288213625773},
        {6, 0.002505114419250336, 0.0012683309328720251, 0.11897449769695685}}}};
  return rules;
}

/// Reference coordinates of an orbit's points, one row a point.
Eigen::Matrix<double, Eigen::Dynamic, 2> orbit_points(const Orbit& orbit) {
  const double a = orbit.a, b = orbit.size == 3 ? a : orbit.b, c = 1 - a - b;
  Eigen::Matrix<double, Eigen::Dynamic, 2> points(orbit.size, 2);
  if (orbit.size == 1)
    points << 1.0 / 3, 1.0 / 3;
  else if (orbit.size == 3)
    points << a, a, c, a, a, c;
  else
    points << a, b, b, a, a, c, c, a, b, c, c, b;
  return points;
}

}  // namespace

Quadrature symmetric_quadrature(int degree) {
  const std::vector<SymmetricRule>& rules = symmetric_rules();
  const auto found = std::find_if(rules.begin(), rules.end(),
                                  [&](const SymmetricRule& rule) { return rule.degree >= degree; });
  if (degree < 0 || found == rules.end())
    throw InputError(
        format("symmetric quadrature of degree %d: expected 0 to %d; the conical rules go to degree 126",
               degree, rules.back().degree));
  int count = 0;
  for (const Orbit& orbit : found->orbits) count += orbit.size;
  Quadrature rule;
  rule.points.resize(count, 2);
  rule.weights.resize(count);
  int row = 0;
  for (const Orbit& orbit : found->orbits) {
    rule.points.middleRows(row, orbit.size) = orbit_points(orbit);
    rule.weights.segment(row, orbit.size).setConstant(orbit.weight);
    row += orbit.size;
  }
  rule.degree = found->degree;
  rule.name = format("symmetric degree %d (%d points)", rule.degree, count);
  return rule;
}

}  // namespace esfem
