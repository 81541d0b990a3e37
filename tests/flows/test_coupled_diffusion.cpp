// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/analysis/errors.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/problems/growing_sphere.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"
#include "tests/flows/semi_discrete_solution.hpp"

namespace esfem::test_coupled_diffusion {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using State = CoupledDiffusionState;
using Parameters = CoupledDiffusionParameters;
using Variant = CoupledDiffusionVariant;

constexpr Variant reassembled = {Variant::reassembled, Variant::regularised},
                  dynamic = {Variant::extrapolated, Variant::dynamic},
                  reassembled_dynamic = {Variant::reassembled, Variant::dynamic};

double largest(const Field& field) {
  return field.cwiseAbs().maxCoeff();
}

// ---- the growing sphere

/// A run with exact starting values, on a mesh of the unit sphere.
struct GrowingSphereRun {
  GrowingSphereRun(const Mesh& mesh, const Quadrature& rule) : x0(mesh.nodes), space(mesh, rule) {}

  State exact_state(double t) const { return exact_growing_sphere_state(space, exact, x0, t); }

  State end(const UniformSteps& grid, Variant variant = {},
            GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive) const {
    const Parameters parameters;
    CoupledDiffusion<GrowingSphereProblem> flow(
        space, GrowingSphereProblem(parameters, variant.law, coupling), parameters, variant);
    return last_state(flow, grid, {exact_state(0), [this](double t) { return exact_state(t); }});
  }

  /// Errors of a state against the exact solution.
  Errors errors(const State& state) const {
    ErrorRecorder recorder(space, exact, x0);
    recorder.record(state);
    return recorder.maxima();
  }

  Field x0;
  SurfaceSpace space;
  ExactEvolution exact = growing_sphere();
};

TEST(GrowingSphere, AgreesWithTheIndependentImplementation) {
  const ReferenceCase reference("coupled_diffusion_additive_bdf3");
  const auto deviation = [&](int points, Variant variant, GrowingSphereProblem::Coupling coupling) {
    const GrowingSphereRun run(reference.mesh, conical_quadrature(points));
    return reference.deviation(run.end(reference.grid, variant, coupling));
  };
  EXPECT_LT(deviation(12, {}, GrowingSphereProblem::additive), 1e-12);
  // A rule that is too weak, another coupling or another variant of the scheme is seen.
  EXPECT_GT(deviation(4, {}, GrowingSphereProblem::additive), 1e-6);
  EXPECT_GT(deviation(12, {}, GrowingSphereProblem::none), 1e-4);
  EXPECT_GT(deviation(12, reassembled, GrowingSphereProblem::additive), 1e-4);
  EXPECT_GT(deviation(12, dynamic, GrowingSphereProblem::additive), 1e-4);
}

TEST(GrowingSphere, TheQuotientOfThePaperLosesTheSolution) {
  const ReferenceCase reference("coupled_diffusion_additive_bdf3");
  const GrowingSphereRun run(reference.mesh, conical_quadrature(12));
  const auto error = [&](GrowingSphereProblem::Coupling coupling) {
    const State end = run.end(reference.grid, {}, coupling);
    return largest(end.v - run.exact_state(end.t).v);
  };
  EXPECT_LT(error(GrowingSphereProblem::additive), 0.01);
  EXPECT_LT(error(GrowingSphereProblem::none), 0.01);
  EXPECT_GT(error(GrowingSphereProblem::quotient), 1);
  // Quadrature points on the planes x1 x2 x3 = 0.
  const GrowingSphereRun symmetric(sphere_mesh(1, 1, 1), vertex_quadrature());
  EXPECT_THROW(symmetric.end({1, 0.01, 1, {}}, {}, GrowingSphereProblem::quotient), NumericsError);
  EXPECT_NO_THROW(symmetric.end({1, 0.01, 1, {}}, {}, GrowingSphereProblem::additive));
}

TEST(GrowingSphere, ErrorsAgreeWithTheIndependentTable) {
  const std::string folder = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";
  const nlohmann::json table = read_json(folder + "table_coupled_diffusion.json");
  int compared = 0;
  for (const nlohmann::json& row : table["rows"]) {
    const double tau = row["tau"];
    if (row["nodes"] != 642 || tau < 0.05) continue;
    const GrowingSphereRun run(read_mesh(folder + row["mesh"].get<std::string>()).mesh,
                               conical_quadrature(4));
    Errors errors = run.errors(run.end({3, tau, static_cast<int>(std::lround(1 / tau)), {}}));
    for (const auto& [quantity, norms] : row["errors"].items()) {
      for (const auto& [norm, value] : norms.items()) {
        EXPECT_NEAR(errors[quantity][norm] / value.get<double>(), 1, 1e-9)
            << quantity << " " << norm << " " << tau;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 24);
}

/// Orders in h of x, v, u in the lifted H1 norm, from two meshes with proportion 2:1, at a short time with a
/// negligible error in time.
std::vector<double> orders_in_space(int degree, Variant variant) {
  const UniformSteps grid = {4, 0.01, 10, {}};
  std::vector<Errors> errors;
  for (int subdivisions : {degree > 2 ? 1 : 2, degree > 2 ? 2 : 3}) {
    const GrowingSphereRun run(sphere_mesh(1, degree, subdivisions), default_quadrature(degree));
    errors.push_back(run.errors(run.end(grid, variant)));
  }
  std::vector<double> orders;
  for (const char* quantity : {"x", "v", "u"})
    orders.push_back(order(errors[0][quantity]["lifted_H1"], errors[1][quantity]["lifted_H1"]));
  return orders;
}

TEST(GrowingSphere, ErrorsInSpaceHaveTheOrderOfTheDegree) {
  for (const Variant& variant : {Variant(), reassembled, dynamic, reassembled_dynamic}) {
    for (int degree : {1, 2, 3, 4}) {
      const std::vector<double> orders = orders_in_space(degree, variant);
      EXPECT_GE(*std::min_element(orders.begin(), orders.end()), degree - 0.2) << "P" << degree;
    }
  }
}

// ---- orders in time

/// Schnakenberg's reactions, driven so fast that orders are asymptotic at large steps; u_1 pushes the
/// surface.
struct DrivenReactions {
  static constexpr int species = 2;
  void f(double t, const PointData<2>& p, Pack (&out)[2]) const {
    const Pack production = p.u[0] * p.u[0] * p.u[1];
    out[0] = 0.1 - p.u[0] + production + 5 * std::sin(10 * t);
    out[1] = 0.9 - production + 5 * std::cos(10 * t) * p.x[2];
  }
  Pack g(double t, const PointData<2>& p) const { return p.u[0] * (1 + std::sin(10 * t) * p.x[0]); }
};

const SurfaceSpace& space() {
  static const SurfaceSpace instance(flattened_sphere_mesh());
  return instance;
}

State reactions_start() {
  const Field x = flattened_sphere_mesh().nodes;
  Field u(x.rows(), 2);
  u.col(0) = 1 + 0.1 * x.col(0).array();
  u.col(1) = 0.9 + 0.1 * x.col(1).array() * x.col(2).array();
  return coupled_diffusion_state(space(), 0, x, 0 * x, u);
}

using DrivenFlow = CoupledDiffusion<DrivenReactions>;

SemiDiscreteSolution<DrivenFlow>& driven_solution(const Variant& variant) {
  static std::map<Variant::Law, SemiDiscreteSolution<DrivenFlow>> solutions;
  const Parameters parameters = {1, 1, {1, 0.5}};
  const auto [entry, is_new] =
      solutions.try_emplace(variant.law, space(), reactions_start(), DrivenReactions(), parameters, variant);
  return entry->second;
}

constexpr Field State::*evolved_fields[] = {&State::x, &State::v, &State::u};

TEST(CoupledDiffusionInTime, PositionVelocityAndSpeciesHaveTheOrderOfTheBdf) {
  const double tolerance = 0.3;
  for (const Variant& variant : {Variant(), dynamic}) {
    for (int q : {1, 2, 3, 4, 5}) {
      for (const auto& field : evolved_fields)
        EXPECT_GE(driven_solution(variant).order(q, 64, {}, field), q - tolerance) << "BDF" << q;
    }
  }
}

TEST(CoupledDiffusionInTime, CascadeOfTheSameStepLosesTheOrder) {
  const double tolerance = 0.3;
  const auto driven_order = [](int q, const std::string& start, Field State::*field) {
    return driven_solution({}).order(q, 64, parse_start(start), field);
  };
  for (const auto& field : evolved_fields) {
    EXPECT_LT(driven_order(3, "cascade", field), 3 - tolerance);
    EXPECT_LT(driven_order(4, "cascade", field), 4 - tolerance);
    EXPECT_GE(driven_order(3, "substeps:64", field), 3 - tolerance);
  }
}

/// The largest difference of u at t = 0.2 between (7.2) and (2.19), both from exact starting values.
double difference_of_masses(int subdivisions, int q, int steps) {
  const GrowingSphereRun run(sphere_mesh(1, 2, subdivisions), default_quadrature(2));
  const UniformSteps grid = {q, 0.2 / steps, steps, {}};
  return largest(run.end(grid, reassembled).u - run.end(grid).u);
}

TEST(CoupledDiffusionInTime, ReassembledMassLosesAnOrderWhateverTheMesh) {
  const double tolerance = 0.2;
  for (int q : {2, 3, 4}) {
    double at_40_steps[2];
    for (int subdivisions : {1, 2}) {
      const double coarse = difference_of_masses(subdivisions, q, 40);
      EXPECT_NEAR(order(coarse, difference_of_masses(subdivisions, q, 80)), q - 1, tolerance) << "BDF" << q;
      at_40_steps[subdivisions - 1] = coarse;
    }
    EXPECT_NEAR(at_40_steps[0] / at_40_steps[1], 1, 0.15) << "BDF" << q;
  }
}

TEST(CoupledDiffusionInTime, ReassembledMassIsInconsistentWithBdf1) {
  EXPECT_GT(difference_of_masses(1, 1, 40), 0.15);
  EXPECT_GT(difference_of_masses(1, 1, 160), 0.15);
}

// ---- conservation

/// f = rate u, and a surface that u_1 pushes, or rests (push = 0).
template <int m>
struct Growth {
  static constexpr int species = m;
  double rate = 0, push = 0;
  void f(double, const PointData<m>& p, Pack (&out)[m]) const {
    for (int l = 0; l < m; ++l) out[l] = rate * p.u[l];
  }
  Pack g(double, const PointData<m>& p) const { return push * p.u[0]; }
};

/// A start on the flattened sphere, at rest, with m different fields u.
State start_at_rest(int m) {
  const Field x = flattened_sphere_mesh().nodes;
  Field u(x.rows(), m);
  for (int l = 0; l < m; ++l) u.col(l) = 1 + 0.1 * l + 0.2 * x.col(0).array().sin();
  return coupled_diffusion_state(space(), 0, x, 0 * x, u);
}

/// int u_l of each species.
Eigen::VectorXd masses(const State& state) {
  SymmetricMatrix M = space().matrix(), A = space().matrix();
  space().assemble(state.x, M, A);
  return (M * state.u).colwise().sum();
}

TEST(CoupledDiffusion, WithoutForcesTheSurfaceRestsAndMassesStay) {
  const State start = start_at_rest(4);
  const Parameters parameters = {1, 0, {1, 0.1, 1, 10}};
  for (const Variant& variant : {Variant(), reassembled, dynamic}) {
    CoupledDiffusion<Growth<4>> flow(space(), {}, parameters, variant);
    const State end = last_state(flow, {3, 0.05, 20, parse_start("cascade")}, start);
    EXPECT_LT(largest(end.x - start.x), 1e-13);
    EXPECT_LT(largest(end.v), 1e-13);
    EXPECT_LT((masses(end) - masses(start)).cwiseAbs().maxCoeff(), 1e-12 * masses(start).maxCoeff());
    // The fields have changed, the faster the larger D is.
    const auto oscillation = [&](int l) { return end.u.col(l).maxCoeff() - end.u.col(l).minCoeff(); };
    EXPECT_NEAR(oscillation(2), oscillation(0), 1e-13);
    EXPECT_GT(oscillation(1), 1.2 * oscillation(0));
    EXPECT_GT(oscillation(0), 10 * oscillation(3));
  }
}

/// A species has the values that it has alone.
TEST(CoupledDiffusion, SpeciesOfEqualAndDifferentDiffusionDoNotMix) {
  const State start = start_at_rest(4);
  CoupledDiffusion<Growth<4>> together(space(), {-1, 0}, {1, 0, {1, 0.1, 1, 10}}, {});
  const UniformSteps grid = {2, 0.05, 4, parse_start("cascade")};
  const Field u = last_state(together, grid, start).u;
  const double D[] = {1, 0.1, 1, 10};
  for (int l = 0; l < 4; ++l) {
    CoupledDiffusion<Growth<1>> alone(space(), {-1, 0}, {1, 0, {D[l]}}, {});
    const State one = coupled_diffusion_state(space(), 0, start.x, start.v, start.u.col(l));
    EXPECT_LT(largest(last_state(alone, grid, one).u - u.col(l)), 1e-13) << l;
  }
}

/// The largest residual of 1/tau sum_j delta_j 1ᵀ(M u)^{n-j} = 1ᵀ f(x̃, ũ) over a run with a moving surface,
/// relative to 1ᵀ f.
double mass_balance_residual(const Variant& variant) {
  const double rate = -0.7, tau = 0.02;
  const int q = 3;
  CoupledDiffusion<Growth<2>> flow(space(), {rate, 1}, {1, 1, {1, 0.3}}, variant);
  std::vector<State> states;
  integrate(flow, {q, tau, 15, parse_start("cascade")}, start_at_rest(2),
            [&](int, const State& now) { states.push_back(now); });

  const std::vector<double> delta = bdf_delta(q), gamma = bdf_gamma(q);
  double largest_residual = 0;
  for (std::size_t n = q; n < states.size(); ++n) {
    State tilde;
    tilde.x = gamma[0] * states[n - 1].x;
    tilde.u = gamma[0] * states[n - 1].u;
    Field change = delta[0] * states[n].Mu;
    for (int j = 1; j <= q; ++j) change += delta[j] * states[n - j].Mu;
    for (int j = 1; j < q; ++j) {
      tilde.x += gamma[j] * states[n - 1 - j].x;
      tilde.u += gamma[j] * states[n - 1 - j].u;
    }
    const Eigen::VectorXd source = rate * masses(tilde);
    const Eigen::VectorXd residual = change.colwise().sum().transpose() / tau - source;
    largest_residual = std::max(largest_residual, residual.norm() / source.norm());
  }
  return largest_residual;
}

TEST(CoupledDiffusion, DiscreteMassBalanceHoldsToRoundOff) {
  EXPECT_LT(mass_balance_residual({}), 1e-12);
  EXPECT_LT(mass_balance_residual(dynamic), 1e-12);
  EXPECT_GT(mass_balance_residual(reassembled), 1e-3);
}

/// Error of int u(T) = exp(rate T) int u(0) on a moving surface, relative; T = 0.2.
double mass_error(const Variant& variant, int q, int steps) {
  const double rate = -1, T = 0.2;
  const State start = start_at_rest(1);
  CoupledDiffusion<Growth<1>> flow(space(), {rate, 1}, {}, variant);
  const State end = last_state(flow, {q, T / steps, steps, parse_start("substeps:64")}, start);
  return masses(end)[0] / (std::exp(rate * T) * masses(start)[0]) - 1;
}

// The semi-discrete mass has no error: what is left is that of the steps.
TEST(CoupledDiffusion, MassGrowsAsTheSourceSays) {
  const double tolerance = 0.3;
  const auto mass_order = [](const Variant& variant, int q) {
    return order(mass_error(variant, q, 16), mass_error(variant, q, 32));
  };
  for (int q : {1, 2, 3}) {
    EXPECT_GE(mass_order({}, q), q - tolerance) << "BDF" << q;
    EXPECT_GE(mass_order(dynamic, q), q - tolerance) << "BDF" << q;
    EXPECT_LT(mass_order(reassembled, q), q - tolerance) << "BDF" << q;
  }
}

// ---- errors, fields

/// Pushes some parts of the surface out and pulls others in, until the elements degenerate.
struct Tearing {
  static constexpr int species = 1;
  void f(double, const PointData<1>&, Pack (&out)[1]) const { out[0] = Pack{}; }
  Pack g(double, const PointData<1>& p) const { return 100 * p.x[0] * p.x[1]; }
};

TEST(CoupledDiffusion, DegenerateElementsAreASingularity) {
  for (const Variant& variant : {Variant(), dynamic}) {
    CoupledDiffusion<Tearing> flow(space(), {}, {0.01, 0, {1}}, variant);
    EXPECT_THROW(last_state(flow, {2, 0.01, 500, parse_start("cascade")}, start_at_rest(1)),
                 SingularityError);
  }
}

TEST(CoupledDiffusion, ParametersAndFieldsOutOfRangeAreInputErrors) {
  const double nan = std::nan(""), infinity = HUGE_VAL;
  const auto message = [](const Parameters& parameters) -> std::string {
    try {
      CoupledDiffusion<Growth<2>>(space(), {}, parameters, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({1, 0, {1, 2}}), "");
  for (double alpha : {0.0, -1.0, nan, infinity})
    EXPECT_THAT(message({alpha, 1, {1, 1}}), HasSubstr("alpha")) << alpha;
  for (double beta : {-1.0, nan, infinity})
    EXPECT_THAT(message({1, beta, {1, 1}}), HasSubstr("beta")) << beta;
  EXPECT_EQ(message({1, 1, {1, 0}}), "");
  for (double D : {-1.0, nan, infinity}) EXPECT_THAT(message({1, 1, {1, D}}), HasSubstr("of species 2")) << D;
  EXPECT_THAT(message({1, 1, {1}}), HasSubstr("1 diffusion coefficients for 2 species"));
  EXPECT_THROW(GrowingSphereProblem({1, 1, {1, 1}}, Variant::regularised), InputError);

  const State start = start_at_rest(1);
  EXPECT_THROW(coupled_diffusion_state(space(), 0, start.x, start.u, start.u), InputError);
  EXPECT_THROW(coupled_diffusion_state(space(), 0, start.x, start.v, start.u.topRows(5)), InputError);
  // A state with fewer species than the problem.
  CoupledDiffusion<Growth<2>> flow(space(), {}, {1, 1, {1, 1}}, {});
  EXPECT_THROW(last_state(flow, {1, 0.1, 1, {}}, start), InputError);
}

TEST(CoupledDiffusion, NodalFieldsHaveTheNamesOfTheSpecies) {
  const auto names = [](const State& state) {
    std::vector<std::string> result;
    for (const NodalField& field : nodal_fields(state)) result.push_back(field.name);
    return result;
  };
  EXPECT_THAT(names(start_at_rest(1)), ElementsAre("v", "u"));
  const State three = start_at_rest(3);
  EXPECT_THAT(names(three), ElementsAre("v", "u1", "u2", "u3"));
  EXPECT_EQ(nodal_fields(three)[2].values, three.u.col(1));
}

}  // namespace
}  // namespace esfem::test_coupled_diffusion
