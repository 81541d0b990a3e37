// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/mesh.hpp"
#include "tests/mesh/topology.hpp"

namespace esfem::test_structured {

namespace {}  // namespace

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

namespace {

/// Largest relative difference of the two side lengths of a cell of an n x m grid, in its middle.
double largest_distortion(const Mesh& mesh, int n, int m) {
  const auto node = [&](int i, int j) -> Vec3 { return mesh.nodes.row(i % n * m + j % m); };
  double largest = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const Vec3 a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      const double along = ((b - a).norm() + (c - d).norm()) / 2,
                   around = ((d - a).norm() + (c - b).norm()) / 2;
      largest = std::max(largest, std::abs(along / around - 1));
    }
  return largest;
}

}  // namespace

TEST(IsothermalTorusGrid, IsAClosedOutwardTorus) {
  for (const auto& [n, m] : {std::pair{3, 3}, {6, 4}, {7, 5}, {44, 44}}) {
    const Mesh mesh = isothermal_torus_grid(1, std::sqrt(0.5), n, m);
    EXPECT_EQ(mesh.nodes.rows(), n * m);
    EXPECT_EQ(mesh.elements.rows(), 2 * n * m);
    EXPECT_EQ(euler_characteristic(mesh), 0);
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_GT(enclosed_volume(mesh), 0);
    const Surface surface = torus(1, std::sqrt(0.5));
    for (int i = 0; i < mesh.nodes.rows(); ++i) EXPECT_NEAR(surface.level(mesh.nodes.row(i)), 0, 1e-14);
  }
}

TEST(IsothermalTorusGrid, HasSquareCells) {
  const double clifford = std::sqrt(0.5);
  const double coarse = largest_distortion(isothermal_torus_grid(1, clifford, 24, 24), 24, 24);
  const double fine = largest_distortion(isothermal_torus_grid(1, clifford, 48, 48), 48, 48);
  EXPECT_LT(fine, 0.005);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
  // r/sqrt(R² - r²) = 3/4 on the torus with r/R = 3/5.
  EXPECT_LT(largest_distortion(isothermal_torus_grid(2, 1.2, 80, 60), 80, 60), 0.005);
  EXPECT_GT(largest_distortion(isothermal_torus_grid(2, 1.2, 80, 80), 80, 80), 0.2);
  EXPECT_GT(largest_distortion(torus_grid(1, clifford, 48, 48), 48, 48), 0.5);
}

TEST(IsothermalTorusGrid, GoesOnceAroundTheTube) {
  const int m = 40;
  const double major = 1, minor = std::sqrt(0.5);
  const Mesh mesh = isothermal_torus_grid(major, minor, 3, m);
  double isothermal_step = 0;
  for (int j = 0; j < m; ++j) {
    const auto angle = [&](int k) {
      const Vec3 y = mesh.nodes.row(k % m);
      return std::atan2(y[2], std::hypot(y[0], y[1]) - major);
    };
    const double step = std::remainder(angle(j + 1) - angle(j), 2 * pi);
    // Simpson's rule for the integral of r d theta/(R + r cos theta) over one step.
    const auto density = [&](double theta) { return minor / (major + minor * std::cos(theta)); };
    const double psi =
        step / 6 * (density(angle(j)) + 4 * density(angle(j) + step / 2) + density(angle(j) + step));
    EXPECT_NEAR(psi, 2 * pi / m, 2e-5);
    isothermal_step += psi;
  }
  EXPECT_NEAR(isothermal_step, 2 * pi, 1e-4);
}

TEST(TorusEdgeLength, IsTheLargestOutsideAndResolvesTheHole) {
  const double minor = std::sqrt(0.5);
  const auto size = torus_edge_length(1, minor, 0.5);
  EXPECT_NEAR(size(Vec3(0, -1 - minor, 0)), 0.5, 1e-15);
  EXPECT_NEAR(size(Vec3(1 - minor, 0, 0)) / 0.5, (1 - minor) / minor, 1e-14);
  EXPECT_NEAR(torus_edge_length(1, 0.4, 0.3)(Vec3(0.6, 0, 0)), 0.3, 1e-15);
  const Mesh mesh = generate_mesh(torus(1, minor), torus_edge_length(1, minor, minor));
  EXPECT_EQ(euler_characteristic(mesh), 0);
  // A uniform mesh that resolves the hole has more than twice as many vertices.
  EXPECT_LT(2 * mesh.nodes.rows(), generate_mesh(torus(1, minor), 1 - minor).nodes.rows());
}

TEST(RadialEdgeLength, IsLinearInTheDistanceFromTheAxis) {
  const auto size = radial_edge_length(0.5, 0.1, 1.5, 0.3);
  EXPECT_NEAR(size(Vec3(0.6, -0.8, 7)), 0.2, 1e-15);
  EXPECT_NEAR(size(Vec3(0.3, 0, -1)), 0.1, 1e-15);
  EXPECT_NEAR(size(Vec3(0, 2, 0)), 0.3, 1e-15);
}

TEST(RadialEdgeLength, ResolvesADeeplyPerturbedTorusWithFewerVertices) {
  const Surface surface = perturbed_torus(1, 0.6, 0.1, 4);
  EXPECT_THROW(generate_mesh(surface, 0.12), InputError);
  const Mesh mesh = generate_mesh(surface, radial_edge_length(0.3, 0.25 * 0.2654, 1.7, 0.2654));
  EXPECT_EQ(euler_characteristic(mesh), 0);
  EXPECT_NEAR(mesh.nodes.rows(), 2252, 200);
}

TEST(StructuredMeshes, RefuseWrongParameters) {
  EXPECT_THROW(icosphere(0, 1), InputError);
  EXPECT_THROW(icosphere(NAN, 1), InputError);
  EXPECT_THROW(octasphere(1, -1), InputError);
  EXPECT_THROW(octasphere(1, 11), InputError);
  EXPECT_THROW(torus_grid(1, 1, 6, 6), InputError);
  EXPECT_THROW(torus_grid(2, 1, 2, 6), InputError);
  EXPECT_THROW(isothermal_torus_grid(1, 1, 6, 6), InputError);
  EXPECT_THROW(isothermal_torus_grid(2, 1, 6, 2), InputError);
  EXPECT_THROW(torus_edge_length(1, 1.5, 0.1), InputError);
  EXPECT_THROW(radial_edge_length(2, 0.1, 1, 0.2), InputError);
}

}  // namespace esfem::test_structured
