// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "solver/error.hpp"
#include "solver/mesh/read.hpp"
#include "solver/mesh/remesh.hpp"
#include "tests/mesh/test_folder.hpp"
#include "tests/mesh/topology.hpp"

namespace esfem::test_remesh {
namespace {

using testing::HasSubstr;

/// The mesh with one element cut into three at a point of it, moved to the unit sphere.
Mesh cut_at(const Mesh& mesh, int element, const Vec3& weights) {
  Mesh result = mesh;
  const int n = int(mesh.nodes.rows()), elements = int(mesh.elements.rows());
  const Eigen::RowVector3i corners = mesh.elements.row(element);
  result.nodes.conservativeResize(n + 1, 3);
  result.nodes.row(n) = (weights.transpose() * mesh.nodes(corners, Eigen::all)).normalized();
  result.elements.conservativeResize(elements + 2, 3);
  result.elements.row(element) << corners[0], corners[1], n;
  result.elements.row(elements) << corners[1], corners[2], n;
  result.elements.row(elements + 1) << corners[2], corners[0], n;
  return result;
}

/// A sphere with three needles and a cap.
Mesh sphere_with_thin_triangles() {
  return cut_at(cut_at(icosphere(1, 3), 7, {0.998, 0.001, 0.001}), 100, {0.5, 0.499, 0.001});
}

Mesh cube() {
  Mesh mesh;
  mesh.nodes.resize(8, 3);
  for (int i = 0; i < 8; ++i) mesh.nodes.row(i) << (i & 1), (i >> 1 & 1), (i >> 2 & 1);
  mesh.elements.resize(12, 3);
  mesh.elements << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
      1, 3, 5, 3, 7, 5;
  return mesh;
}

double worst_ratio(const Mesh& mesh) {
  return mesh_quality(mesh.elements, mesh.nodes).min_radius_ratio;
}

/// Largest distance of a node from the point of the given mesh on which it should lie.
double distance_from_input(const RemeshedSurface& found, const Mesh& input) {
  double largest = 0;
  for (int i = 0; i < found.mesh.nodes.rows(); ++i) {
    const auto& [element, weights] = found.on_input[i];
    const Vec3 x = input.nodes(input.elements.row(element), Eigen::all).transpose() * weights;
    largest = std::max(largest, (x - found.mesh.nodes.row(i).transpose()).norm());
  }
  return largest;
}

TEST(Remesh, MakesThinTrianglesGoodAndKeepsTheSurface) {
  const Mesh thin = sphere_with_thin_triangles();
  ASSERT_LT(worst_ratio(thin), 0.01);
  for (double edge_length : {0.1, 0.15, 0.25}) {
    RemeshedSurface found = remesh(thin, edge_length);
    EXPECT_GT(worst_ratio(found.mesh), 0.5);
    EXPECT_EQ(check_closed_surface(found.mesh, "remeshed"), "");
    EXPECT_EQ(euler_characteristic(found.mesh), 2);
    EXPECT_EQ(found.sharp_edges, 0) << "a cap on a sphere is no feature";
    EXPECT_LT(distance_from_input(found, thin), 1e-9);
    EXPECT_NEAR(enclosed_volume(found.mesh) / enclosed_volume(thin) - 1, found.relative_volume_change, 1e-12);
    EXPECT_LT(std::abs(found.relative_volume_change), edge_length > 0.2 ? 0.03 : 0.01);
    const double h = mesh_quality(found.mesh.elements, found.mesh.nodes).h;
    EXPECT_GT(h, edge_length);
    EXPECT_LT(h, 1.7 * edge_length);
  }
}

TEST(Remesh, KeepsFeatures) {
  const RemeshedSurface found = remesh(cube(), 0.15);
  EXPECT_EQ(found.sharp_edges, 12);
  EXPECT_EQ(found.kept, 12);
  EXPECT_LT(std::abs(found.relative_volume_change), 1e-12);
  EXPECT_GT(worst_ratio(found.mesh), 0.3);
  int corners = 0;
  for (const auto& x : found.mesh.nodes.rowwise()) corners += (x.array() == 0 || x.array() == 1).all();
  EXPECT_EQ(corners, 8);
  EXPECT_GT(std::abs(remesh(cube(), 0.15, 100).relative_volume_change), 1e-3)
      << "unless they are no features";
}

TEST(Remesh, GivesUpFeaturesCloserThanTheEdgeLengthButNoVolume) {
  Mesh dent = icosphere(1, 3);
  dent.nodes.row(100) *= 0.9;
  const RemeshedSurface sphere = remesh(dent, 0.4, 15);
  EXPECT_GT(sphere.sharp_edges, 0);
  EXPECT_GE(worst_ratio(sphere.mesh), 0.05);
  Mesh plate = cube();
  plate.nodes.col(2) *= 1e-3;
  const RemeshedSurface thin = remesh(plate, 0.2);
  EXPECT_EQ(thin.kept, 12);
  EXPECT_LT(std::abs(thin.relative_volume_change), 1e-9);
}

TEST(Remesh, IsDeterministicAndDoesNotDependOnUnits) {
  const Mesh thin = sphere_with_thin_triangles();
  const RemeshedSurface some = remesh(thin, 0.2), others = remesh(thin, 0.2);
  EXPECT_EQ(some.mesh.nodes, others.mesh.nodes);
  EXPECT_EQ(some.mesh.elements, others.mesh.elements);
  Mesh small = thin;
  small.nodes = std::ldexp(1.0, -30) * thin.nodes;
  const RemeshedSurface scaled = remesh(small, std::ldexp(0.2, -30));
  EXPECT_EQ(scaled.mesh.elements, some.mesh.elements);
  EXPECT_EQ(std::ldexp(1.0, 30) * scaled.mesh.nodes, some.mesh.nodes);
}

TEST(Remesh, RefusesEdgeLengthsThatMakeNoSense) {
  const Mesh mesh = icosphere(1, 1);
  for (double edge_length : {0.0, -1.0, 1e-5, 2.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(complaint<InputError>([&] { remesh(mesh, edge_length); }), HasSubstr("a quarter of"))
        << edge_length;
}

}  // namespace
}  // namespace esfem::test_remesh
