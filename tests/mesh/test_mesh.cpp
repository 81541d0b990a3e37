// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem::test_mesh {

namespace {

/// The nodes of the edge from local corner `edge` to the next one, with both corners.
std::vector<int> edge_nodes(const Mesh& mesh, int e, int edge) {
  std::vector<int> nodes{mesh.elements(e, edge)};
  for (int i = 0; i < mesh.degree - 1; ++i)
    nodes.push_back(mesh.elements(e, 3 + edge * (mesh.degree - 1) + i));
  nodes.push_back(mesh.elements(e, (edge + 1) % 3));
  return nodes;
}

/// Number of edges whose two elements do not list the same nodes in opposite order.
int mismatched_edges(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> seen;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int edge = 0; edge < 3; ++edge) {
      const std::vector<int> nodes = edge_nodes(mesh, e, edge);
      seen[{nodes.front(), nodes.back()}] = nodes;
    }
  int mismatched = 0;
  for (const auto& [corners, nodes] : seen) {
    const auto other = seen.find({corners.second, corners.first});
    mismatched += other == seen.end() || !std::equal(nodes.begin(), nodes.end(), other->second.rbegin());
  }
  return mismatched;
}

/// Largest distance between the element maps of two meshes at a few points of each element.
double distance_of_maps(const Mesh& a, const Mesh& b) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> points(4, 2);
  points << 0.2, 0.3, 0.7, 0.1, 0.05, 0.9, 0.5, 0.0;
  const Eigen::MatrixXd at_a = shape_functions(a.degree, points).value;
  const Eigen::MatrixXd at_b = shape_functions(b.degree, points).value;
  double distance = 0;
  for (int e = 0; e < a.elements.rows(); ++e) {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(4, 3);
    for (int i = 0; i < a.elements.cols(); ++i) difference += at_a.col(i) * a.nodes.row(a.elements(e, i));
    for (int i = 0; i < b.elements.cols(); ++i) difference -= at_b.col(i) * b.nodes.row(b.elements(e, i));
    distance = std::max(distance, difference.cwiseAbs().maxCoeff());
  }
  return distance;
}

}  // namespace

class LagrangeMesh : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, LagrangeMesh, testing::Values(1, 2, 3, 4));

TEST_P(LagrangeMesh, NumbersSharedNodesOnce) {
  const int k = GetParam();
  for (const Mesh& corners : {icosphere(1, 1), torus_grid(2, 1, 5, 4)}) {
    const Mesh mesh = lagrange_mesh(corners, k);
    const int elements = int(corners.elements.rows()), edges = elements * 3 / 2;
    EXPECT_EQ(mesh.degree, k);
    EXPECT_EQ(mesh.nodes.rows(), corners.nodes.rows() + edges * (k - 1) + elements * (k - 1) * (k - 2) / 2);
    EXPECT_EQ(mismatched_edges(mesh), 0);
    EXPECT_EQ(euler_characteristic(mesh), euler_characteristic(corners));
  }
}

TEST_P(LagrangeMesh, KeepsTheElementMaps) {
  const Mesh corners = icosphere(1, 1);
  EXPECT_LT(distance_of_maps(corners, lagrange_mesh(corners, GetParam())), 1e-15);
  Mesh curved = lagrange_mesh(corners, 2);
  curved.nodes.rowwise().normalize();
  const double distance = distance_of_maps(curved, lagrange_mesh(curved, GetParam()));
  if (GetParam() == 1) {
    EXPECT_GT(distance, 1e-2);
  } else {
    EXPECT_LT(distance, 1e-15);
  }
}

TEST_P(LagrangeMesh, OfTheSameDegreeIsUnchanged) {
  Mesh mesh = lagrange_mesh(octasphere(1, 1), GetParam());
  // An order of nodes that no numbering would come up with.
  mesh.nodes = mesh.nodes.colwise().reverse().eval();
  mesh.elements.array() = int(mesh.nodes.rows()) - 1 - mesh.elements.array();
  const Mesh same = lagrange_mesh(mesh, GetParam());
  EXPECT_EQ(same.nodes, mesh.nodes);
  EXPECT_EQ(same.elements, mesh.elements);
}

namespace {

/// The sphere of flat triangles with nodes of some degree, under random numbers of its nodes.
Mesh shuffled(int degree) {
  Mesh mesh = lagrange_mesh(icosphere(1, 1), degree);
  std::vector<int> number(mesh.nodes.rows());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(1));
  const Field nodes = mesh.nodes;
  for (std::size_t i = 0; i < number.size(); ++i) mesh.nodes.row(number[i]) = nodes.row(i);
  for (int& i : mesh.elements.reshaped()) i = number[i];
  return mesh;
}

}  // namespace

TEST_P(LagrangeMesh, KeepsTheOrderOfTheGivenNodes) {
  const Mesh corners = shuffled(1), mesh = lagrange_mesh(corners, GetParam());
  EXPECT_EQ(mesh.nodes.topRows(corners.nodes.rows()), corners.nodes);
  EXPECT_EQ(mesh.elements.leftCols(3), corners.elements);
  EXPECT_EQ(mismatched_edges(mesh), 0);
  EXPECT_LT(distance_of_maps(corners, mesh), 1e-15);
}

TEST_P(LagrangeMesh, KeepsTheOrderOfTheNodesThatBothHave) {
  const Mesh curved = shuffled(2), mesh = lagrange_mesh(curved, GetParam());
  if (GetParam() == 4) {
    EXPECT_EQ(mesh.nodes.topRows(curved.nodes.rows()), curved.nodes);
    EXPECT_EQ(mesh.elements.leftCols(3), curved.elements.leftCols(3));
    EXPECT_EQ(mesh.elements.col(4), curved.elements.col(3));
  }
  // The corners are those of the given mesh, in its order.
  std::map<int, int> number;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) number[curved.elements(e, i)] = mesh.elements(e, i);
  int last = -1;
  for (const auto& [given, mine] : number) {
    EXPECT_EQ(mesh.nodes.row(mine), curved.nodes.row(given));
    EXPECT_GT(mine, last);
    last = mine;
  }
}

TEST_P(LagrangeMesh, TakesNodalValuesAlong) {
  const Mesh given = shuffled(2), mesh = lagrange_mesh(given, GetParam());
  const auto linear = [](const Field& x) -> Field { return 2 * x.col(0) - x.col(1) + x.col(2); };
  const Field values = lagrange_values(given, linear(given.nodes), mesh);
  EXPECT_LT((values - linear(mesh.nodes)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(LagrangeMeshErrors, DegreeMustBeKnown) {
  EXPECT_THROW(lagrange_mesh(octasphere(1, 0), 5), InputError);
  EXPECT_THROW(lagrange_mesh(octasphere(1, 0), 0), InputError);
}

TEST(LagrangeMeshCheck, SeesUnreversedEdges) {
  Mesh mesh = lagrange_mesh(octasphere(1, 0), 3);
  std::swap(mesh.elements(0, 3), mesh.elements(0, 4));
  EXPECT_EQ(mismatched_edges(mesh), 2);
}

TEST(CornerMesh, IsTheInverseOfLagrangeMesh) {
  const Mesh corners = icosphere(1, 1);
  const Mesh back = corner_mesh(lagrange_mesh(corners, 4));
  EXPECT_EQ(back.degree, 1);
  EXPECT_EQ(back.nodes.rows(), corners.nodes.rows());
  for (int e = 0; e < corners.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(back.nodes.row(back.elements(e, i)), corners.nodes.row(corners.elements(e, i)));
}

TEST(CornerMesh, KeepsTheOrderOfCorners) {
  Mesh mesh;
  mesh.degree = 2;
  mesh.nodes = Field::Random(6, 3);
  mesh.elements.resize(1, 6);
  mesh.elements << 4, 0, 2, 1, 3, 5;
  const Mesh corners = corner_mesh(mesh);
  EXPECT_EQ(corners.elements, (Connectivity(1, 3) << 2, 0, 1).finished());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(corners.nodes.row(i), mesh.nodes.row(2 * i));
}

TEST(MeshQuality, OfAnEquilateralTriangle) {
  Field x(3, 3);
  x << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const MeshQuality q = mesh_quality((Connectivity(1, 3) << 0, 1, 2).finished(), x);
  EXPECT_NEAR(q.mean_radius_ratio, 1, 1e-15);
  EXPECT_NEAR(q.min_radius_ratio, 1, 1e-15);
  EXPECT_NEAR(q.min_angle, 60, 1e-12);
  EXPECT_NEAR(q.h, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(q.h_min, std::sqrt(2.0), 1e-15);
}

TEST(MeshQuality, OfARightTriangleBesideAnEquilateralOne) {
  Field x(6, 3);
  x << 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 4, 0;
  const MeshQuality q = mesh_quality((Connectivity(2, 3) << 0, 1, 2, 3, 4, 5).finished(), x);
  // Sides 3, 4, 5: inradius 1, circumradius 5/2.
  EXPECT_NEAR(q.min_radius_ratio, 0.8, 1e-15);
  EXPECT_NEAR(q.mean_radius_ratio, 0.9, 1e-15);
  EXPECT_NEAR(q.min_angle, std::atan(0.75) * 180 / pi, 1e-12);
  EXPECT_EQ(q.h, 5);
  EXPECT_NEAR(q.h_min, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(q.worst_element, 1);
}

TEST(MeshQuality, FindsTheSmallestAngleAtEachCorner) {
  // Angles 20, 70, 90 degrees; each corner in turn has the smallest.
  const double opposite = std::tan(20 * pi / 180);
  const Field triangle = (Field(3, 3) << 0, 0, 0, 1, 0, 0, 1, 0, opposite).finished();
  for (int turn = 0; turn < 3; ++turn) {
    const Connectivity element = (Connectivity(1, 3) << turn, (turn + 1) % 3, (turn + 2) % 3).finished();
    EXPECT_NEAR(mesh_quality(element, triangle).min_angle, 20, 1e-12) << turn;
  }
  // Two equal angles of 15 degrees: together with the obtuse one they make 180.
  const Field obtuse = (Field(3, 3) << -1, 0, 0, 1, 0, 0, 0, std::tan(pi / 12), 0).finished();
  EXPECT_NEAR(mesh_quality((Connectivity(1, 3) << 0, 1, 2).finished(), obtuse).min_angle, 15, 1e-12);
}

TEST(MeshQuality, OfADegenerateTriangleIsZero) {
  Field x(3, 3);
  x << 0, 0, 0, 1, 0, 0, 1, 0, 0;
  const MeshQuality q = mesh_quality((Connectivity(1, 3) << 0, 1, 2).finished(), x);
  EXPECT_EQ(q.min_radius_ratio, 0);
  EXPECT_EQ(q.h_min, 0);
}

TEST(MeshQuality, SeesOnlyTheCorners) {
  Mesh mesh = lagrange_mesh(octasphere(1, 0), 2);
  mesh.nodes.rowwise().normalize();
  const MeshQuality q = mesh_quality(mesh.elements, mesh.nodes);
  EXPECT_NEAR(q.h, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(q.min_radius_ratio, 1, 1e-15);
}

TEST(MeshQuality, NeedsAnElement) {
  EXPECT_THROW(mesh_quality(Connectivity(0, 3), Field(0, 3)), InputError);
}

TEST(ProjectNodes, PutsEveryNodeOnTheSurface) {
  for (int k = 1; k <= 4; ++k) {
    Mesh ball = lagrange_mesh(octasphere(2, 2), k);
    project_nodes(ball, sphere(2));
    EXPECT_LT((ball.nodes.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-15 * 2) << k;
    const Surface surface = torus(2, 0.8);
    Mesh ring = lagrange_mesh(torus_grid(2, 0.8, 24, 16), k);
    project_nodes(ring, surface);
    for (int i = 0; i < ring.nodes.rows(); ++i) EXPECT_LT(std::abs(surface.level(ring.nodes.row(i))), 1e-13);
  }
}

TEST(ProjectNodes, TakesNodesPrintedWithFewDigits) {
  Mesh mesh = icosphere(1, 3);
  const Field exact = mesh.nodes;
  mesh.nodes = (mesh.nodes * 1e4).array().round() / 1e4;
  EXPECT_GT((mesh.nodes.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-5);
  project_nodes(mesh, sphere(1));
  EXPECT_LT((mesh.nodes.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
  EXPECT_LT((mesh.nodes - exact).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(ProjectNodes, MovesAlongTheNormalOnly) {
  const Surface surface = ellipsoid(1, 1.2, 0.9);
  Mesh mesh = octasphere(1, 2);
  project_nodes(mesh, surface);
  const Field on_surface = mesh.nodes;
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    mesh.nodes.row(i) += 0.05 * surface.normal(mesh.nodes.row(i)).transpose();
  project_nodes(mesh, surface);
  EXPECT_LT((mesh.nodes - on_surface).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ProjectNodes, RefusesFarNodesByNumber) {
  for (const Vec3& far : {Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(NAN, 0, 0)}) {
    Mesh mesh = icosphere(1, 1);
    mesh.nodes.row(6) = far.transpose();
    try {
      project_nodes(mesh, sphere(1));
      ADD_FAILURE() << "projected " << far.transpose();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("node 7"), 0u) << error.what();
    }
  }
}

}  // namespace esfem::test_mesh
