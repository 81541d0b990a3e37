// SPDX-License-Identifier: GPL-3.0-or-later
// Results in other units, where the space has the length of the surface, and where it has not.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/phase_separation.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/problems/disturbed_mixture.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_units {
namespace {

Mesh scaled(double length) {
  Mesh mesh = ellipsoid_mesh({1, 1.2, 0.8}, 2, 1);
  mesh.nodes *= length;
  return mesh;
}

/// Largest deviation of a run on nodes of size `length` from the one on nodes of size one, relative; infinite
/// when it fails. run(space, x, length) -> a field of the last state, without unit. The length of the space
/// is that of `space_length`.
template <class Run>
double deviation(const Run& run, double length, double space_length) {
  const Mesh mesh = scaled(length);
  const SurfaceSpace one(scaled(1)), space(scaled(space_length));
  const Field expected = run(one, scaled(1).nodes, 1.0);
  try {
    return (run(space, mesh.nodes, length) - expected).norm() / expected.norm();
  } catch (const NumericsError&) {
    return INFINITY;
  }
}

template <class Run>
void expect_the_length_to_count(const Run& run, double largest_false = 1e-6) {
  for (const double length : {1e-9, 1e-3, 1e9}) {
    EXPECT_LT(deviation(run, length, length), 1e-10) << length;
    EXPECT_GT(deviation(run, length, 1), largest_false) << length << " with L = 1";
  }
}

TEST(Units, RitzVelocityIsRelativeToTheLength) {
  expect_the_length_to_count([](const SurfaceSpace& space, const Field& x, double length) -> Field {
    MeanCurvatureFlow flow(space, {});
    const UniformSteps grid{2, 1e-2 * length * length, 3, parse_start("cascade")};
    return last_state(flow, grid, discrete_mean_curvature_state(space, x)).x / length;
  });
}

TEST(Units, DisturbancesAreRelativeToTheLength) {
  expect_the_length_to_count([](const SurfaceSpace& space, const Field& x, double length) {
    return disturbed_mixture(space, x, 0.2 * length, 0, 1, 1).u;
  });
}

TEST(Units, SpaceHasThePowerOfTenNextToTheRadius) {
  for (const double radius : {0.33, 1.0, 3.1}) EXPECT_EQ(SurfaceSpace(sphere_mesh(radius, 2, 2)).length(), 1);
  EXPECT_EQ(SurfaceSpace(sphere_mesh(3.3, 2, 2)).length(), 10);
  EXPECT_EQ(SurfaceSpace(sphere_mesh(2e-9, 1, 2)).length(), 1e-9);
  EXPECT_EQ(SurfaceSpace(torus_mesh(1e5, 0.4e5, 2, 16, 8)).length(), 1e5);
}

}  // namespace
}  // namespace esfem::test_units
