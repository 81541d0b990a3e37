// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/error.hpp"
#include "solver/flows/reaction_diffusion.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_formula_data {
namespace {

const std::map<std::string, double> schnakenberg = {{"a", 0.1}, {"b", 0.9}, {"gamma", 15}};

PointwiseKinetics kinetics_of(const std::vector<std::string>& texts) {
  std::vector<Formula> f;
  for (const std::string& text : texts)
    f.emplace_back(text, names_of_kinetics(2, {{}, schnakenberg}), "kinetics");
  return formula_kinetics(f);
}

/// The rate at which the harmonic of degree l grows on the unit sphere from a small disturbance of
/// Schnakenberg's steady state, and the largest eigenvalue of J - l(l+1) D there.
struct GrowthRates {
  double measured, expected;
};
GrowthRates growth_of_harmonic(const Mesh& mesh, const std::vector<std::string>& f, int l) {
  const double gamma = schnakenberg.at("gamma"), D = 10;
  const SurfaceSpace space(mesh);
  const Field& x = mesh.nodes;
  ReactionDiffusion flow(space, kinetics_of(f), {1, D}, [&x](double) -> const Field& { return x; }, {});
  Eigen::Matrix2d J;
  J << 0.8 * gamma - l * (l + 1), gamma, -1.8 * gamma, -gamma - D * l * (l + 1);
  const Eigen::EigenSolver<Eigen::Matrix2d> modes(J);
  const int largest = modes.eigenvalues()[0].real() > modes.eigenvalues()[1].real() ? 0 : 1;
  const Eigen::Vector2d mode = modes.eigenvectors().col(largest).real().normalized();
  Eigen::VectorXd harmonic(x.rows());
  for (int j = 0; j < x.rows(); ++j) harmonic[j] = std::legendre(l, x(j, 2));
  Field u(x.rows(), 2);
  for (int s = 0; s < 2; ++s) u.col(s) = (s == 0 ? 1.0 : 0.9) + 1e-5 * mode[s] * harmonic.array();
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const Field weighted = M * Field(harmonic);
  const double rate = std::abs(modes.eigenvalues()[largest].real());
  const int steps = 60;
  const double tau = std::min(1e-3, 0.05 / rate);
  double first = 0, last = 0;
  integrate(flow, {3, tau, steps, parse_start("substeps:4")}, flow.state(0, u),
            [&](int n, const ReactionDiffusionState& state) {
              const double amplitude = weighted.col(0).dot(Eigen::VectorXd(state.u.col(0).array() - 1));
              if (n == steps / 2) first = amplitude;
              last = amplitude;
            });
  return {std::log(last / first) / (tau * (steps - steps / 2)), modes.eigenvalues()[largest].real()};
}

TEST(FormulaKinetics, SphericalHarmonicsGrowAtTuringsRates) {
  Mesh mesh = lagrange_mesh(icosphere(1, 3), 2);
  project_nodes(mesh, sphere(1));
  for (int l = 1; l <= 8; ++l) {
    const auto [measured, expected] =
        growth_of_harmonic(mesh, {"gamma*(a-u1+u1^2*u2)", "gamma*(b-u1^2*u2)"}, l);
    EXPECT_NEAR(measured, expected, 0.01 * std::abs(expected)) << l;
  }
  // Broken: another rate of one reaction, with the same steady state.
  const auto [measured, expected] =
      growth_of_harmonic(mesh, {"gamma*(a-u1+u1^2*u2)", "1.1*gamma*(b-u1^2*u2)"}, 2);
  EXPECT_GT(std::abs(measured - expected), 0.05 * std::abs(expected));
}

/// The largest entry of the residual of (2.20) after a step of backward Euler,
///   int v . phi + alpha grad v : grad phi + beta grad x : grad phi + sign grad beta . phi - g nu . phi
/// on the old surface, for alpha = 1 + x² + u, beta = 1/2 + z² and g = 1 + x u.
double residual_of_law(const Mesh& mesh, double sign) {
  const SurfaceSpace space(mesh);
  const Field& x = mesh.nodes;
  const FormulaNames names = names_of_kinetics(1, {});
  const auto formula = [&](const char* text) { return Formula(text, names, "kinetics"); };
  const VariableLaw law = {formula_nodal_function(formula("1+x^2+u")),
                           formula_nodal_function(formula("1/2+z^2"))};
  CoupledKinetics flow(space, formula_kinetics({formula("0"), formula("1+x*u")}), {1, 1, {1}}, {}, {}, law);
  CoupledDiffusionState end;
  const Field u = x.col(1).array().sin();
  integrate(flow, {1, 0.1, 1, parse_start("cascade")},
            {coupled_diffusion_state(space, 0, x, Field::Zero(x.rows(), 3), u)},
            [&](int, const CoupledDiffusionState& state) { end = state; });
  Field inputs(x.rows(), 9), residual, alpha, beta;
  law.alpha(0.1, x, u, alpha);
  law.beta(0.1, x, u, beta);
  inputs << end.v, end.x, alpha, beta, u;
  const auto weak_form = [&](const PointData<9>& p, Integrand<3, 3>& out) {
    const Pack g = 1.0 + p.x[0] * p.u[8];
    for (int i = 0; i < 3; ++i) {
      out.value[i] = p.u[i] + sign * p.grad[7][i] - g * p.normal[i];
      for (int j = 0; j < 3; ++j) out.flux[i][j] = p.u[6] * p.grad[i][j] + p.u[7] * p.grad[3 + i][j];
    }
  };
  space.assemble_load<9, 3, 3>(x, inputs, weak_form, residual);
  return residual.cwiseAbs().maxCoeff();
}

TEST(FormulaLaw, AStepFulfilsTheWeakFormWithVaryingAlphaAndBeta) {
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);
  mesh.nodes.col(2) *= 0.7;
  EXPECT_LT(residual_of_law(mesh, 1), 1e-13);
  for (double broken : {0, -1}) EXPECT_GT(residual_of_law(mesh, broken), 1e-3);
}

TEST(FormulaVelocity, IsThatOfTheLevelSet) {
  const FormulaNames names = names_in_space_time({});
  const Velocity formula =
                     formula_normal_velocity(Formula("x^2/(1+sin(2*pi*t)/4)+y^2+z^2-1", names, "velocity")),
                 exact = EvolvingEllipsoid().velocity();
  const Velocity components = formula_velocity({Formula("pi*cos(2*pi*t)/4/(1+sin(2*pi*t)/4)*x", names, "v"),
                                                Formula("0", names, "v"), Formula("0", names, "v")}),
                 stretching = EvolvingEllipsoid().stretching_velocity();
  const Field x = Field::Random(20, 3);
  Field v, expected;
  for (double t : {0.0, 0.3, 0.8}) {
    formula(t, x, v);
    exact(t, x, expected);
    EXPECT_LT((v - expected).cwiseAbs().maxCoeff(), 1e-14);
    components(t, x, v);
    stretching(t, x, expected);
    EXPECT_LT((v - expected).cwiseAbs().maxCoeff(), 1e-14);
  }
  EXPECT_THROW(formula_velocity({Formula("0", names, "v")}), InputError);
}

}  // namespace
}  // namespace esfem::test_formula_data
