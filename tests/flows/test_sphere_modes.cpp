// SPDX-License-Identifier: GPL-3.0-or-later
// Linear stability of the sphere: sign, factor and law of three flows, from the formulas that
// nearly_round_sphere.hpp derives.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/nearly_round_sphere.hpp"
#include "solver/time/last_state.hpp"

namespace esfem::test_sphere_modes {
namespace {

struct NearlyRound {
  Surface surface = nearly_round_sphere();
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  SurfaceSpace space;

  NearlyRound() : space(projected()) {}
  const Mesh& projected() {
    project_nodes(mesh, surface);
    return mesh;
  }
};

double willmore_rate(const WillmoreLaw& law) {
  const NearlyRound on;
  WillmoreFlow::Variant variant;
  variant.law = law;
  WillmoreFlow flow(on.space, variant);
  const WillmoreStart start = willmore_start_on(on.space, on.surface, on.mesh.nodes, law, false);
  const auto at = [&](int steps) {
    return mode_amplitude(last_state(flow, {2, 5e-4, steps, parse_start("substeps:16")}, start.state).x);
  };
  return std::log(at(20) / at(100)) / 0.04;
}

TEST(SphereModes, DecayAtTheRate24UnderWillmoreFlowAndSurfaceDiffusion) {
  EXPECT_NEAR(mode_amplitude(NearlyRound().mesh.nodes), 1e-3, 1e-5);
  EXPECT_NEAR(willmore_rate(willmore_law()), 24, 0.15);
  EXPECT_NEAR(willmore_rate(surface_diffusion_law()), 24, 0.15);
  // The rate sees a law in which |A|² is missing: Q = -H³/2.
  EXPECT_GT(
      std::abs(willmore_rate([](const WillmorePoint& at, Pack& Q) { Q = -0.5 * at.H * at.H * at.H; }) - 24),
      5);
}

TEST(SphereModes, DecayLikeOneMinusFourTUnderMeanCurvatureFlow) {
  const NearlyRound on;
  MeanCurvatureFlow flow(on.space, {});
  const auto start = mean_curvature_state_on(on.surface, on.mesh.nodes);
  const double left = mode_amplitude(last_state(flow, {3, 1e-3, 100, parse_start("substeps:16")}, start).x);
  EXPECT_NEAR(left / mode_amplitude(on.mesh.nodes), 0.6, 0.002);
}

}  // namespace
}  // namespace esfem::test_sphere_modes
