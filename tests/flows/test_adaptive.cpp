// SPDX-License-Identifier: GPL-3.0-or-later
// Flows with steps that follow the solution.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/time/adaptive.hpp"

namespace esfem {
namespace {

struct Shrinking {
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  Shrinking() { project_nodes(mesh, sphere(1)); }

  /// The largest error of the mean radius of the unit sphere, R = sqrt(1 - 4t), until `end`.
  template <class Flow>
  std::pair<double, AdaptiveRun> run(Flow flow, const typename Flow::State& initial,
                                     const AdaptiveGrid& grid) const {
    double error = 0;
    const AdaptiveRun run =
        integrate_adaptive(flow, grid, initial, &Flow::State::x, [&](int, const typename Flow::State& state) {
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
                       {2, 0.24, tolerance, first, 0});
  };
  const auto [coarse, coarse_run] = run(1e-3);
  const auto [fine, fine_run] = run(1e-4);
  EXPECT_LT(coarse, 0.03);
  EXPECT_LT(fine, coarse / 4);
  EXPECT_LT(fine_run.steps, 200);
  EXPECT_GT(run(1e-4, 0.1).second.rejected, 2);
}

TEST(AdaptiveFlows, DziuksSchemeFollowsTheShrinkingSphere) {
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  const auto run = [&](double tolerance) {
    return problem.run(DziukFlow(space), dziuk_state_on(space, problem.mesh.nodes),
                       {2, 0.24, tolerance, 1e-5, 0});
  };
  EXPECT_LT(run(1e-3).first, 0.03);
}

/// The time of a sphere's vanishing, by a run that goes on until the flow refuses.
TEST(AdaptiveFlows, StepsGetSmallTowardsASingularity) {
  const Shrinking problem;
  const SurfaceSpace space(problem.mesh);
  MeanCurvatureFlow flow(space, {});
  double last = 0, step = 0, largest = 0;
  const AdaptiveGrid grid = {2, 1, 1e-3, 1e-4, 0};
  EXPECT_THROW(integrate_adaptive(flow, grid, mean_curvature_state_on(sphere(1), problem.mesh.nodes),
                                  &MeanCurvatureFlow::State::x,
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
}  // namespace esfem
