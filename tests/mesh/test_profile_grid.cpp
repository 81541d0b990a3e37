// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem::test_profile_grid {
namespace {

/// The smallest cosine between an element's normal and that of the surface at its first node.
double smallest_agreement(const Mesh& mesh, const Surface& surface) {
  double smallest = 1;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    smallest = std::min(smallest, (b - a).cross(c - a).normalized().dot(surface.normal(a)));
  }
  return smallest;
}

TEST(AngenentTorusGrid, LiesOnTheTorusWithItsNormalsOutward) {
  const Surface surface = angenent_torus();
  const Mesh mesh = angenent_torus_grid(48, 24);
  EXPECT_EQ(mesh.nodes.rows(), 48 * 24);
  EXPECT_EQ(euler_characteristic(mesh), 0);
  for (int i = 0; i < mesh.nodes.rows(); ++i) EXPECT_NEAR(surface.level(mesh.nodes.row(i)), 0, 1e-12);
  EXPECT_GT(smallest_agreement(mesh, surface), 0.8);
  Mesh inside_out = mesh;
  inside_out.elements.col(0).swap(inside_out.elements.col(1));
  EXPECT_LT(smallest_agreement(inside_out, surface), -0.8);
}

TEST(AngenentTorusGrid, ItsUnstructuredMeshesAreFinerWhereTheTorusCurvesMore) {
  const auto length = angenent_torus_edge_length(0.66);
  const AngenentProfile& profile = angenent_profile();
  const Eigen::Vector2d inner = profile.at(0).position, outer = profile.at(profile.length() / 2).position;
  EXPECT_NEAR(length(Vec3(inner[0], 0, 0)), 0.33, 1e-12);
  EXPECT_NEAR(length(Vec3(0, outer[0], 0)), 0.66, 1e-12);
  const Mesh mesh = generate_mesh(angenent_torus(), length);
  EXPECT_EQ(euler_characteristic(mesh), 0);
  EXPECT_LT(mesh_quality(mesh.elements, mesh.nodes).h, 0.83);
}

TEST(ProfileGrid, RefusesLessThanThreeByThreeCells) {
  EXPECT_THROW(angenent_torus_grid(2, 5), InputError);
  EXPECT_THROW(angenent_torus_grid(5, 2), InputError);
  EXPECT_THROW(angenent_torus_grid(5, -1), InputError);
}

}  // namespace
}  // namespace esfem::test_profile_grid
