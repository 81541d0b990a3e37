// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/problems/power_law_sphere.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_generalised_mean_curvature_flow {
namespace {

using Flow = GeneralisedMeanCurvatureFlow;
using State = Flow::State;

std::function<State(double)> exact_state(const ExactEvolution& exact, const Field& x0) {
  return [&exact, &x0](double t) { return exact_generalised_mean_curvature_state(exact, x0, t); };
}

TEST(GeneralisedMeanCurvatureFlow, AgreesWithTheIndependentImplementation) {
  for (const auto& [name, power] : {std::pair("gmcf_h2_bdf2", 2.0), {"gmcf_imcf_bdf2", -1.0}}) {
    const ReferenceCase reference(name);
    const SurfaceSpace space(reference.mesh, conical_quadrature(8));
    const PowerLaw law(power);
    const ExactEvolution exact = power_law_sphere(2, law);
    const auto states = exact_state(exact, reference.mesh.nodes);
    const auto deviation = [&](Flow flow) {
      return reference.deviation(last_state(flow, reference.grid, {states(0), states}));
    };
    EXPECT_LT(deviation(Flow(space, law)), 1e-8) << name;
    EXPECT_GT(deviation(Flow(space, law, MeanCurvatureFlow::Variant::interpolation)), 5e-8)
        << name << ": the other velocity is told from it";
  }
}

TEST(PowerLaw, InverseAndWeightBelongToV) {
  for (const double power : {0.5, 1.0, 2.0, 3.0, -1.0, -2.0}) {
    const PowerLaw law(power);
    for (const double H : {0.3, 1.0, 7.0}) {
      const double e = 1e-6 * H, V = law.V(H), slope = (law.V(H + e) - law.V(H - e)) / (2 * e);
      EXPECT_TRUE(law.has(V));
      EXPECT_NEAR(law.H(V), H, 1e-13 * H) << power;
      EXPECT_GT(slope, 0) << power;
      EXPECT_NEAR(law.weight(V) * slope, 1, 1e-8) << power;
    }
    EXPECT_EQ(law.has(-law.V(1)), power == 1);
  }
  EXPECT_THROW(PowerLaw(0), InputError);
  EXPECT_THROW(PowerLaw(std::nan("")), InputError);
}

const Surface triaxial = ellipsoid(1.2, 1, 0.8);

Mesh quadratic_mesh(const Surface& surface, double edge_length) {
  Mesh mesh = lagrange_mesh(generate_mesh(surface, edge_length), 2);
  project_nodes(mesh, surface);
  return mesh;
}

TEST(GeneralisedMeanCurvatureFlow, OfPowerOneIsMeanCurvatureFlow) {
  const Mesh mesh = quadratic_mesh(triaxial, 0.4);
  const SurfaceSpace space(mesh);
  const MeanCurvatureFlow::State start = mean_curvature_state_on(triaxial, mesh.nodes);
  const PowerLaw law(1);
  const UniformSteps steps{2, 0.005, 4, parse_start("cascade")};
  Flow flow(space, law);
  MeanCurvatureFlow mean_curvature_flow(space, {});
  const State end = last_state(
      flow, steps, generalised_mean_curvature_state(law, mesh.nodes, start.u.leftCols(3), start.u.col(3)));
  const MeanCurvatureFlow::State expected = last_state(mean_curvature_flow, steps, start);
  EXPECT_LT((end.x - expected.x).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((end.u - expected.u).cwiseAbs().maxCoeff(), 1e-11);
}

/// The largest error of x in a node of a sphere until the end, from exact starting values.
double error_on_sphere(double power, int q, int steps, double end_time) {
  static const Mesh mesh = [] {
    Mesh mesh = lagrange_mesh(icosphere(2, 3), 2);
    project_nodes(mesh, sphere(2));
    return mesh;
  }();
  const SurfaceSpace space(mesh);
  const PowerLaw law(power);
  const ExactEvolution exact = power_law_sphere(2, law);
  const auto states = exact_state(exact, mesh.nodes);
  Flow flow(space, law);
  double largest = 0;
  integrate(flow, {q, end_time / steps, steps, {}}, {states(0), states}, [&](int, const State& state) {
    largest =
        std::max(largest, (state.x - exact.trajectories(mesh.nodes, state.t)).rowwise().norm().maxCoeff());
  });
  return largest;
}

TEST(GeneralisedMeanCurvatureFlow, HasTheOrderOfTheBdfOnSpheres) {
  for (const auto& [power, end_time] : {std::pair(2.0, 0.4), {3.0, 0.3}, {-1.0, 0.6}, {-2.0, 0.6}})
    for (const int q : {1, 2}) {
      const double order =
          std::log2(error_on_sphere(power, q, 10, end_time) / error_on_sphere(power, q, 20, end_time));
      EXPECT_GT(order, q - 0.35) << "power " << power << ", BDF" << q;
      EXPECT_LT(order, q + 0.5) << "power " << power << ", BDF" << q;
    }
}

TEST(GeneralisedMeanCurvatureFlow, InverseFlowMultipliesTheAreaByTheExponential) {
  const Mesh mesh = quadratic_mesh(triaxial, 0.25);
  const SurfaceSpace space(mesh);
  const MeanCurvatureFlow::State curvature = mean_curvature_state_on(triaxial, mesh.nodes);
  const auto excess = [&](double power) {
    const PowerLaw law(power);
    Flow flow(space, law);
    const State end = last_state(
        flow, {2, 0.025, 8, parse_start("cascade")},
        generalised_mean_curvature_state(law, mesh.nodes, curvature.u.leftCols(3), curvature.u.col(3)));
    return space.area(end.x) / (space.area(mesh.nodes) * std::exp(0.2)) - 1;
  };
  EXPECT_NEAR(excess(-1), 0, 1e-3);
  EXPECT_GT(std::abs(excess(-2)), 0.02) << "another law does not";
}

TEST(GeneralisedMeanCurvatureFlow, StopsWhereTheLawDoesNotReach) {
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);
  project_nodes(mesh, sphere(1));
  const SurfaceSpace space(mesh);
  const PowerLaw law(2);
  Field H = Field::Constant(mesh.nodes.rows(), 1, 2);
  State state = generalised_mean_curvature_state(law, mesh.nodes, mesh.nodes, H);
  state.u(0, 3) = -3;
  Flow flow(space, law);
  EXPECT_THROW(last_state(flow, {1, 0.01, 1, {}}, state), SingularityError);
  H(4, 0) = -1;
  try {
    generalised_mean_curvature_state(law, mesh.nodes, mesh.nodes, H);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node 5"));
  }
}

}  // namespace
}  // namespace esfem::test_generalised_mean_curvature_flow
