// SPDX-License-Identifier: GPL-3.0-or-later
// Flows with steps that follow the solution.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/problems/growing_sphere.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_adaptive {
namespace {

struct Shrinking {
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  Shrinking() { project_nodes(mesh, sphere(1)); }

  /// The largest error of the mean radius of the unit sphere, R = sqrt(1 - 4t), until `end`.
  template <class Flow>
  std::pair<double, StepCount> run(Flow flow, const typename Flow::State& initial,
                                   const AdaptiveSteps& grid) const {
    double error = 0;
    const StepCount run = integrate(flow, grid, initial, [&](int, const typename Flow::State& state) {
      const double R = std::sqrt(1 - 4 * state.t);
      error = std::max(error, std::abs(state.x.rowwise().norm().mean() - R));
    });
    return {error, run};
  }
};

TEST(AdaptiveFlows, MeanCurvatureFlowFollowsTheShrinkingSphere) {
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  const auto run = [&](double tolerance, double first = 1e-5) {
    return problem.run(MeanCurvatureFlow(space, {}), mean_curvature_state_on(sphere(1), problem.mesh.nodes),
                       {"x", 2, 0.24, tolerance, first, 0});
  };
  const auto [coarse, coarse_run] = run(1e-3);
  const auto [fine, fine_run] = run(1e-4);
  EXPECT_LT(coarse, 0.01);
  EXPECT_LT(fine, coarse / 4);
  EXPECT_LT(fine_run.steps, 150);
  const auto [rejecting, rejecting_run] = run(1e-4, 0.02);
  EXPECT_GT(rejecting_run.rejected, 0);
  EXPECT_LT(rejecting, 0.01);
}

TEST(AdaptiveFlows, DziuksSchemeFollowsTheShrinkingSphere) {
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  const auto run = [&](double tolerance) {
    return problem.run(DziukFlow(space), dziuk_state_on(space, problem.mesh.nodes),
                       {"x", 2, 0.24, tolerance, 1e-5, 0});
  };
  EXPECT_LT(run(1e-3).first, 0.03);
}

TEST(AdaptiveFlows, GrowthCoupledToDiffusionFollowsTheTolerance) {
  using Flow = CoupledDiffusion<GrowingSphereProblem>;
  using State = CoupledDiffusionState;
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  const State initial = exact_growing_sphere_state(space, growing_sphere(), problem.mesh.nodes, 0);
  const CoupledDiffusionParameters parameters;
  Flow flow(space, GrowingSphereProblem(parameters, CoupledDiffusionVariant::regularised), parameters, {});
  State fine, last;
  integrate(flow, {4, 1.0 / 200, 200, parse_start("substeps:32")}, initial,
            [&](int, const State& state) { fine = state; });
  const auto error = [&](double tolerance) {
    integrate(flow, AdaptiveSteps{"x", 2, 1, tolerance, 1e-5, 0}, initial,
              [&](int, const State& state) { last = state; });
    return (last.x - fine.x).norm() / fine.x.norm();
  };
  const double coarse = error(3e-3);
  EXPECT_LT(coarse, 3e-3);
  EXPECT_NEAR(std::log10(coarse / error(3e-4)), 1, 0.2);
}

TEST(AdaptiveFlows, StepsGetSmallTowardsASingularity) {
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  MeanCurvatureFlow flow(space, {});
  double last = 0, step = 0, largest = 0;
  const AdaptiveSteps grid = {"x", 2, 1, 1e-3, 1e-4, 0};
  EXPECT_THROW(integrate(flow, grid, mean_curvature_state_on(sphere(1), problem.mesh.nodes),
                         [&](int, const MeanCurvatureFlow::State& state) {
                           step = state.t - last;
                           last = state.t;
                           largest = std::max(largest, step);
                         }),
               SingularityError);
  EXPECT_NEAR(last, 0.25, 5e-3);
  EXPECT_LT(step, largest / 100);
}

}  // namespace
}  // namespace esfem::test_adaptive
