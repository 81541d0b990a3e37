// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/time/integrate.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_reinitialisation {
namespace {

const double always = 1e-12, never = 0;

/// The nodes at the end of a run of mean curvature flow of an ellipsoid.
Field nodes_at_the_end(double reinitialise, int q, int steps) {
  const Mesh mesh = ellipsoid_mesh({1, 1.1, 1.3}, 2, 1);
  const SurfaceSpace space(mesh);
  MeanCurvatureFlow::Variant variant;
  variant.reinitialise = reinitialise;
  MeanCurvatureFlow flow(space, variant);
  MeanCurvatureFlow::State initial = discrete_mean_curvature_state(space, mesh.nodes);
  flow.reinitialise(initial);
  Field x;
  integrate(flow, {q, 0.08 / steps, steps, parse_start("substeps:16")}, initial,
            [&](int, const MeanCurvatureFlow::State& state) { x = state.x; });
  return x;
}

// If the newest state alone were replaced, BDF2 would not converge. (The noise of the discrete curvature
// relaxes at a rate of 1/h², so that on these steps orders are not seen: the differences of BDF2 fall by 1.3
// to 1.6.)
TEST(Reinitialisation, IsConsistentWithTheBdfMethod) {
  const Field limit = nodes_at_the_end(always, 2, 64);
  const auto error = [&](int q, int steps) { return (nodes_at_the_end(always, q, steps) - limit).norm(); };
  EXPECT_GT(std::log2(error(1, 8) / error(1, 16)), 0.75);
  for (int steps : {8, 16}) EXPECT_LT(error(2, steps), 0.25 * error(1, steps)) << steps;
}

TEST(Reinitialisation, StaysNearTheFlowThatEvolvesNuAndH) {
  const Field without = nodes_at_the_end(never, 2, 16), with = nodes_at_the_end(always, 2, 16);
  EXPECT_GT((with - without).norm(), 0);
  EXPECT_LT((with - without).cwiseAbs().maxCoeff(), 0.02);
}

TEST(Reinitialisation, BringsFieldsBackToTheSurface) {
  const Mesh mesh = sphere_mesh(1, 2, 1);
  const SurfaceSpace space(mesh);
  WillmoreFlow::Variant variant;
  variant.reinitialise = 0.2;
  WillmoreFlow flow(space, variant);
  WillmoreFlow::State state = discrete_willmore_start(space, mesh.nodes, variant.law).state;
  const WillmoreFlow::State near = state;
  flow.reinitialise(state);
  EXPECT_EQ(state.u, near.u) << "within the tolerance";
  state.t = 0.7;
  state.u.col(0) *= 1.5;
  flow.reinitialise(state);
  EXPECT_EQ(state.t, 0.7);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  EXPECT_EQ(state.u.col(0), curvature.H());
  EXPECT_EQ(state.u.rightCols(3), curvature.nu());
  EXPECT_NE(state.w, near.w) << "belongs to u";
}

}  // namespace
}  // namespace esfem::test_reinitialisation
