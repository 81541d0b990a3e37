// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/error.hpp"
#include "solver/mesh/mesh.hpp"
#include "tests/mesh/topology.hpp"

using namespace esfem;

namespace {

const double pi = std::acos(-1.0);

}  // namespace

TEST(Icosphere, IsAClosedOutwardSphere) {
  for (int s = 0, power = 1; s <= 4; ++s, power *= 4) {
    const Mesh mesh = icosphere(2, s);
    EXPECT_EQ(mesh.nodes.rows(), 10 * power + 2);
    EXPECT_EQ(mesh.elements.rows(), 20 * power);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_LT((mesh.nodes.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-15);
  }
  EXPECT_NEAR(enclosed_volume(icosphere(2, 4)), 32 * pi / 3, 0.15);
  EXPECT_GT(mesh_quality(icosphere(2, 4).elements, icosphere(2, 4).nodes).min_angle, 50);
}

TEST(Octasphere, IsAClosedOutwardSphere) {
  for (int s = 0, power = 1; s <= 4; ++s, power *= 4) {
    const Mesh mesh = octasphere(2, s);
    EXPECT_EQ(mesh.nodes.rows(), 4 * power + 2);
    EXPECT_EQ(mesh.elements.rows(), 8 * power);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_LT((mesh.nodes.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-15);
  }
  EXPECT_NEAR(enclosed_volume(octasphere(2, 4)), 32 * pi / 3, 0.4);
}

TEST(Octasphere, WithoutSubdivisionIsTheRegularOctahedron) {
  const Mesh mesh = octasphere(3, 0);
  EXPECT_NEAR(enclosed_volume(mesh), 4.0 / 3 * 27, 1e-12);
  const MeshQuality q = mesh_quality(mesh.elements, mesh.nodes);
  EXPECT_NEAR(q.min_radius_ratio, 1, 1e-14);
  EXPECT_NEAR(q.h, 3 * std::sqrt(2.0), 1e-14);
}

TEST(TorusGrid, IsAClosedOutwardTorus) {
  for (const auto& [n, m] : {std::pair{3, 3}, {6, 4}, {7, 5}, {4, 3}}) {
    const Mesh mesh = torus_grid(2, 0.7, n, m);
    EXPECT_EQ(mesh.nodes.rows(), n * m);
    EXPECT_EQ(mesh.elements.rows(), 2 * n * m);
    EXPECT_EQ(euler_characteristic(mesh), 0);
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_GT(enclosed_volume(mesh), 0);
  }
  EXPECT_NEAR(enclosed_volume(torus_grid(2, 0.7, 64, 32)), 2 * pi * pi * 2 * 0.49, 0.3);
}

TEST(TorusGrid, AlternatesItsDiagonals) {
  const Mesh mesh = torus_grid(2, 1, 6, 4);
  std::vector<int> triangles(mesh.nodes.rows(), 0);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) ++triangles[mesh.elements(e, i)];
  for (int count : triangles) EXPECT_TRUE(count == 4 || count == 8) << count;
}

TEST(StructuredMeshes, RefuseWrongParameters) {
  EXPECT_THROW(icosphere(0, 1), InputError);
  EXPECT_THROW(icosphere(NAN, 1), InputError);
  EXPECT_THROW(octasphere(1, -1), InputError);
  EXPECT_THROW(octasphere(1, 11), InputError);
  EXPECT_THROW(torus_grid(1, 1, 6, 6), InputError);
  EXPECT_THROW(torus_grid(2, 1, 2, 6), InputError);
}
