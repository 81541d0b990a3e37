// SPDX-License-Identifier: GPL-3.0-or-later
// Linear stability of the sphere: sign, factor and law of three flows, from formulas that no code shares.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/time/last_state.hpp"

namespace esfem::test_sphere_modes {
namespace {

/// A unit sphere with r = 1 + amplitude (3 cos² - 1)/2 to first order: the mode l = 2.
struct NearlyRound {
  static constexpr double amplitude = 1e-3;
  Surface surface = ellipsoid(1 - amplitude / 2, 1 - amplitude / 2, 1 + amplitude);
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  SurfaceSpace space;

  NearlyRound() : space(projected()) {}
  const Mesh& projected() {
    project_nodes(mesh, surface);
    return mesh;
  }
};

/// The coefficient of (3 cos² - 1)/2 in |x|, by least squares in the nodes.
double mode(const Field& x) {
  const Eigen::ArrayXd r = x.rowwise().norm();
  Eigen::ArrayXd P = 1.5 * (x.col(2).array() / r).square() - 0.5;
  P -= P.mean();
  return (r * P).sum() / P.square().sum();
}

double willmore_rate(const WillmoreLaw& law) {
  const NearlyRound on;
  WillmoreFlow::Variant variant;
  variant.law = law;
  WillmoreFlow flow(on.space, variant);
  const WillmoreStart start = willmore_start_on(on.space, on.surface, on.mesh.nodes, law, false);
  const auto at = [&](int steps) {
    return mode(last_state(flow, {2, 5e-4, steps, parse_start("substeps:16")}, start.state).x);
  };
  return std::log(at(20) / at(100)) / 0.04;
}

// r = 1 + a Y_l: V = Lap H + Q gives a' = -(l-1) l (l+1) (l+2) a, with Q and without.
TEST(SphereModes, DecayAtTheRate24UnderWillmoreFlowAndSurfaceDiffusion) {
  EXPECT_NEAR(mode(NearlyRound().mesh.nodes), NearlyRound::amplitude, 1e-5);
  EXPECT_NEAR(willmore_rate(willmore_law()), 24, 0.15);
  EXPECT_NEAR(willmore_rate(surface_diffusion_law()), 24, 0.15);
}

// R² = 1 - 4t, and a' = (2 - l (l + 1)) a/R²: the mode l = 2 decays like 1 - 4t.
TEST(SphereModes, DecayLikeOneMinusFourTUnderMeanCurvatureFlow) {
  const NearlyRound on;
  MeanCurvatureFlow flow(on.space, {});
  const auto start = mean_curvature_state_on(on.surface, on.mesh.nodes);
  const double left = mode(last_state(flow, {3, 1e-3, 100, parse_start("substeps:16")}, start).x);
  EXPECT_NEAR(left / mode(on.mesh.nodes), 0.6, 0.002);
}

}  // namespace
}  // namespace esfem::test_sphere_modes
