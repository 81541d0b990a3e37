// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/formula_evolution.hpp"

#include <cmath>
#include <limits>

namespace esfem {
namespace {

constexpr const char* coordinates[] = {"x", "y", "z"};

/// A formula d in space and time with its gradient and Hessian, in one list of operations.
class SecondDerivatives {
 public:
  explicit SecondDerivatives(const Formula& d) {
    std::vector<Formula> formulas = {d};
    for (const char* name : coordinates) formulas.push_back(d.derivative(name));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) formulas.push_back(formulas[1 + i].derivative(coordinates[j]));
    compiled_ = CompiledFormulas(formulas);
  }

  template <class T>
  struct At {
    T value, gradient[3], hessian[3][3];
  };

  template <class T>
  void at(double t, const T (&x)[3], At<T>& out) const {
    const T in[] = {x[0], x[1], x[2], T{} + t};
    T values[10];
    compiled_.evaluate(in, values);
    out.value = values[0];
    for (int i = 0, next = 4; i < 3; ++i) {
      out.gradient[i] = values[1 + i];
      for (int j = 0; j <= i; ++j) out.hessian[i][j] = out.hessian[j][i] = values[next++];
    }
  }

 private:
  CompiledFormulas compiled_;
};

/// Solves (B, g; gᵀ, 0) (y, s) = (a, b) for a symmetric B, by its adjugate.
void solve_bordered(const Pack (&B)[3][3], const Pack (&g)[3], const Pack (&a)[3], const Pack& b,
                    Pack (&y)[3], Pack& s) {
  Pack adjugate[3][3], B_a[3], B_g[3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
      adjugate[i][j] = B[k][m] * B[l][n] - B[k][n] * B[l][m];
    }
  const Pack inverse = 1.0 / dot(B[0], adjugate[0]);
  for (int i = 0; i < 3; ++i) {
    B_a[i] = inverse * dot(adjugate[i], a);
    B_g[i] = inverse * dot(adjugate[i], g);
  }
  s = (dot(g, B_a) - b) / dot(g, B_g);
  for (int i = 0; i < 3; ++i) y[i] = B_a[i] - s * B_g[i];
}

/// Newton's method for y + s grad d(y) = x, d(y) = 0 from y = x, s = 0. Not finite where it fails.
SurfacePoints closest_points(const SecondDerivatives& d, double t, double size, const Pack (&x)[3]) {
  SurfacePoints points;
  Pack s = {};
  for (int i = 0; i < 3; ++i) points.y[i] = x[i];
  SecondDerivatives::At<Pack> at;
  const int most_iterations = 20;
  const double tolerance = 1e-14 * size;
  double largest = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations && !(largest <= tolerance); ++iteration) {
    d.at(t, points.y, at);
    Pack B[3][3], rest[3], step[3], s_step;
    for (int i = 0; i < 3; ++i) {
      rest[i] = x[i] - points.y[i] - s * at.gradient[i];
      for (int j = 0; j < 3; ++j) B[i][j] = (i == j ? 1.0 : 0.0) + s * at.hessian[i][j];
    }
    solve_bordered(B, at.gradient, rest, -at.value, step, s_step);
    for (int i = 0; i < 3; ++i) points.y[i] += step[i];
    s += s_step;
    const double before = largest;
    const Pack squared = dot(step, step);
    largest = 0;
    for (int lane = 0; lane < pack_size; ++lane) largest = std::max(largest, std::sqrt(squared[lane]));
    if (largest < 1e-10 * size && largest >= before / 2) break;  // at round-off
  }
  d.at(t, points.y, at);
  const Pack inverse_slope = inverse_sqrt(dot(at.gradient, at.gradient));
  for (int i = 0; i < 3; ++i) points.normal[i] = inverse_slope * at.gradient[i];
  // P (Hess d) P/|grad d|
  Pack H_nu[3];
  for (int i = 0; i < 3; ++i) H_nu[i] = dot(at.hessian[i], points.normal);
  const Pack nu_H_nu = dot(points.normal, H_nu);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      points.weingarten[i][j] =
          inverse_slope * (at.hessian[i][j] - points.normal[i] * H_nu[j] - H_nu[i] * points.normal[j] +
                           nu_H_nu * points.normal[i] * points.normal[j]);
  if (!(largest < 1e-10 * size)) points.y[0] = pack(NAN);
  return points;
}

}  // namespace

std::function<Surface(double t)> formula_level_set(const Formula& d, double size) {
  return [derivatives = SecondDerivatives(d), size](double t) {
    Surface surface;
    surface.name = "level set";
    surface.level_set = [derivatives, t](const Vec3& y) {
      SecondDerivatives::At<double> at;
      derivatives.at(t, {y[0], y[1], y[2]}, at);
      LevelSetJet jet = {at.value, Vec3(at.gradient), {}};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) jet.hessian(i, j) = at.hessian[i][j];
      return jet;
    };
    surface.bounding_radius = size;
    surface.smallest_curvature_radius = size;
    surface.euler_characteristic = 0;
    surface.own_closest_points = [derivatives, t, size](const Pack(&x)[3]) {
      return closest_points(derivatives, t, size, x);
    };
    return surface;
  };
}

std::function<void(double t, const SurfacePoints& at, FieldsAtPoints& out)> formula_fields(
    const std::vector<std::pair<ExactEvolution::Quantity, std::vector<Formula>>>& quantities) {
  std::vector<Formula> formulas;
  std::vector<int> position;  // of each component: 0 to 2 where it is one of the position, else -1
  for (const auto& [quantity, components] : quantities)
    for (int l = 0; l < quantity.components; ++l) {
      position.push_back(quantity.name == "x" ? l : -1);
      if (position.back() >= 0) continue;
      formulas.push_back(components.at(l));
      for (const char* name : coordinates) formulas.push_back(components.at(l).derivative(name));
    }
  return [compiled = CompiledFormulas(formulas), position, values = std::vector<Pack>(formulas.size())](
             double t, const SurfacePoints& at, FieldsAtPoints& out) mutable {
    const Pack in[] = {at.y[0], at.y[1], at.y[2], pack(t)};
    if (!values.empty()) compiled.evaluate(in, values.data());
    const Pack* next = values.data();
    for (std::size_t l = 0; l < position.size(); ++l) {
      const int i = position[l];
      if (i >= 0) {
        out.value[l] = at.y[i];
        for (int j = 0; j < 3; ++j) out.gradient[l][j] = at.projection(i, j);
        continue;
      }
      out.value[l] = next[0];
      const Pack along_normal = next[1] * at.normal[0] + next[2] * at.normal[1] + next[3] * at.normal[2];
      for (int j = 0; j < 3; ++j) out.gradient[l][j] = next[1 + j] - along_normal * at.normal[j];
      next += 4;
    }
  };
}

}  // namespace esfem
