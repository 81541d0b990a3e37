// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/problems/exact_states.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_mean_curvature_flow {
namespace {

using State = MeanCurvatureFlow::State;
using Variant = MeanCurvatureFlow::Variant;

State run_sphere(const Mesh& mesh, const Quadrature& rule, const UniformSteps& grid, Variant variant = {}) {
  const ExactEvolution exact = shrinking_sphere(2);
  const std::function<State(double)> state = [&](double t) {
    return exact_mean_curvature_state(exact, mesh.nodes, t);
  };
  const SurfaceSpace space(mesh, rule);
  MeanCurvatureFlow flow(space, variant);
  return last_state(flow, grid, {state(0), state});
}

State run_dumbbell(const Mesh& mesh, const Quadrature& rule, const UniformSteps& grid) {
  const SurfaceSpace space(mesh, rule);
  MeanCurvatureFlow flow(space, {});
  return last_state(flow, grid, mean_curvature_state_on(dumbbell(), mesh.nodes));
}

TEST(MeanCurvatureFlow, AgreesWithTheIndependentImplementation) {
  for (const std::string name : {"mcf_kll_bdf3", "mcf_kll_bdf3_cascade"}) {
    const ReferenceCase reference(name);
    const auto deviation = [&](int points, Variant variant = {}) {
      return reference.deviation(
          run_sphere(reference.mesh, conical_quadrature(points), reference.grid, variant));
    };
    EXPECT_LT(deviation(12), 1e-11) << name;
    // A rule that is too weak, or another variant of the scheme, is seen.
    EXPECT_GT(deviation(4), 1e-8) << name;
    Variant interpolation;
    interpolation.velocity = Variant::interpolation;
    Variant normalise;
    normalise.normalise = true;
    Variant stabilise;
    stabilise.stabilise = 1;
    for (const Variant& variant : {interpolation, normalise, stabilise}) {
      EXPECT_GT(deviation(12, variant), 1e-7) << name;
      EXPECT_LT(deviation(12, variant), 0.02) << name;
    }
  }
}

TEST(MeanCurvatureFlow, AgreesWithTheIndependentImplementationOnTheDumbbell) {
  const ReferenceCase reference("mcf_dumbbell_kll_bdf2");
  const auto deviation = [&](int points, const UniformSteps& grid) {
    return reference.deviation(run_dumbbell(reference.mesh, conical_quadrature(points), grid));
  };
  EXPECT_LT(deviation(12, reference.grid), 1e-11);
  EXPECT_LT(deviation(8, reference.grid), 1e-6);
  EXPECT_GT(deviation(4, reference.grid), 1e-5);
  UniformSteps substeps = reference.grid;
  substeps.start = parse_start("substeps:16");
  EXPECT_GT(deviation(12, substeps), 1e-3);
}

TEST(MeanCurvatureFlow, NormalisedNormalsHaveUnitLength) {
  Variant normalise;
  normalise.normalise = true;
  const Mesh mesh = lagrange_mesh(icosphere(2, 2), 2);
  const State end = run_sphere(mesh, default_quadrature(2), {2, 0.02, 5, {}}, normalise);
  EXPECT_LT((end.u.leftCols(3).rowwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
  const State plain = run_sphere(mesh, default_quadrature(2), {2, 0.02, 5, {}});
  EXPECT_GT((plain.u.leftCols(3).rowwise().norm().array() - 1).abs().maxCoeff(), 1e-7);
}

TEST(MeanCurvatureFlow, StabilisingTermPullsTheNormalToTheSurfaceNormal) {
  // One step from normals that are too long: with alpha the length comes back towards 1.
  const ExactEvolution exact = shrinking_sphere(2);
  Mesh mesh = lagrange_mesh(icosphere(2, 2), 2);
  project_nodes(mesh, sphere(2));
  const SurfaceSpace space(mesh);
  State start = exact_mean_curvature_state(exact, mesh.nodes, 0);
  start.u.leftCols(3) *= 1.1;
  double length[2];
  for (int i : {0, 1}) {
    Variant variant;
    variant.stabilise = 10.0 * i;
    MeanCurvatureFlow flow(space, variant);
    State end;
    integrate(flow, {1, 0.01, 1, {}}, start, [&](int, const State& now) { end = now; });
    length[i] = end.u.leftCols(3).rowwise().norm().mean();
  }
  EXPECT_NEAR(length[0], 1.1, 2e-3);
  EXPECT_NEAR(length[0] - length[1], 10 * 0.01 * 0.1, 1e-3);  // alpha tau (|nu| - 1)
}

TEST(MeanCurvatureFlow, DiscreteStartApproachesTheExactOne) {
  // A surface known by its nodes alone: normal and mean curvature get better with the mesh.
  double previous_nu = 1, previous_H = 1;
  for (int subdivisions : {1, 2, 3}) {
    Mesh mesh = lagrange_mesh(icosphere(2, subdivisions), 2);
    project_nodes(mesh, sphere(2));
    const SurfaceSpace space(mesh);
    const State exact = mean_curvature_state_on(sphere(2), mesh.nodes);
    const State found = discrete_mean_curvature_state(space, mesh.nodes);
    const double error_nu = (found.u - exact.u).leftCols(3).cwiseAbs().maxCoeff();
    const double error_H = (found.u - exact.u).col(3).cwiseAbs().maxCoeff();
    EXPECT_LT(error_nu, previous_nu / 4);
    EXPECT_LT(error_H, previous_H / 2);
    previous_nu = error_nu;
    previous_H = error_H;
  }
  EXPECT_LT(previous_nu, 1e-3);
  EXPECT_LT(previous_H, 1e-2);
}

TEST(MeanCurvatureFlow, StepsInATimeAfterTheCollapseAreAnError) {
  const Mesh mesh = lagrange_mesh(icosphere(2, 1), 2);
  EXPECT_THROW(run_sphere(mesh, default_quadrature(2), {3, 0.6, 3, {}}), InputError);
}

}  // namespace
}  // namespace esfem::test_mean_curvature_flow
