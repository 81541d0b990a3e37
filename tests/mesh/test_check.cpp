// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solver/error.hpp"
#include "solver/mesh/read.hpp"
#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_check {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

Mesh octahedron() {
  return octasphere(1, 0);
}

/// The octahedron with its curved edges, P_k.
Mesh curved_octahedron(int degree) {
  Mesh mesh = lagrange_mesh(octahedron(), degree);
  mesh.nodes.rowwise().normalize();
  return mesh;
}

void add_element(Mesh& mesh, int a, int b, int c) {
  mesh.elements.conservativeResize(mesh.elements.rows() + 1, 3);
  mesh.elements.bottomRows(1) << a, b, c;
}

}  // namespace

TEST(CheckClosedSurface, AcceptsGoodMeshes) {
  EXPECT_EQ(check_complaint(octahedron()), "");
  EXPECT_EQ(check_complaint(torus_grid(2, 1, 5, 4)), "");
  for (int k = 1; k <= 4; ++k) EXPECT_EQ(check_complaint(curved_octahedron(k)), "");
}

TEST(CheckClosedSurface, AHole) {
  Mesh mesh = octahedron();
  mesh.elements.conservativeResize(7, 3);
  EXPECT_THAT(check_complaint(mesh),
              AllOf(HasSubstr("here: element"), HasSubstr("not closed"), HasSubstr("node 1 ")));
}

TEST(CheckClosedSurface, AnEdgeWithThreeTriangles) {
  Mesh mesh = octahedron();
  mesh.nodes.conservativeResize(7, 3);
  mesh.nodes.row(6) << 2, 2, 2;
  add_element(mesh, 0, 1, 6);
  EXPECT_THAT(check_complaint(mesh),
              AllOf(HasSubstr("element 9 "), HasSubstr("not a manifold, 1 edge has more than 2 triangles"),
                    HasSubstr("between node 1 (counted from 1) at ("), HasSubstr(" and node 2 "),
                    HasSubstr("has 3 (")));
}

TEST(CheckClosedSurface, TwoFansAtAVertex) {
  Mesh other = octahedron();
  other.nodes.col(0).array() += 2;
  Mesh mesh = together(octahedron(), other);
  // Node 3 of the second, (1, 0, 0), is node 1 of the first.
  for (int& i : mesh.elements.reshaped())
    if (i == 8) i = 0;
  for (int& i : mesh.elements.reshaped())
    if (i > 8) --i;
  Field nodes(11, 3);
  nodes << mesh.nodes.topRows(8), mesh.nodes.bottomRows(3);
  mesh.nodes = nodes;
  EXPECT_THAT(check_complaint(mesh),
              AllOf(HasSubstr("node 1 "), HasSubstr("not a manifold"), HasSubstr("only 4 of the 8")));
}

TEST(CheckClosedSurface, NotANumber) {
  for (double bad : {double(NAN), double(INFINITY)}) {
    Mesh mesh = octahedron();
    mesh.nodes(3, 1) = bad;
    EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("node 4 "), HasSubstr("finite")));
  }
}

TEST(CheckClosedSurface, ARepeatedNode) {
  Mesh mesh = octahedron();
  mesh.elements(2, 1) = mesh.elements(2, 0);
  EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("element 3 "), HasSubstr("twice")));
}

TEST(CheckClosedSurface, ATriangleWithoutArea) {
  Mesh mesh = octahedron();
  mesh.nodes *= 1e-8;
  EXPECT_EQ(check_complaint(mesh), "") << "small is not degenerate";
  mesh.nodes.row(0) = 0.5 * (mesh.nodes.row(1) + mesh.nodes.row(4));
  EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("element 1 "), HasSubstr("degenerate")));
}

TEST(CheckClosedSurface, ADuplicateTriangle) {
  Mesh mesh = octahedron();
  add_element(mesh, mesh.elements(3, 1), mesh.elements(3, 2), mesh.elements(3, 0));
  EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("element 9 "), HasSubstr("corners of element 4 ")));
  // Back to back they are closed, but enclose nothing.
  mesh.elements.bottomRows(1).swap(mesh.elements.topRows(1));
  mesh.elements.conservativeResize(1, 3);
  add_element(mesh, mesh.elements(0, 1), mesh.elements(0, 0), mesh.elements(0, 2));
  mesh.nodes.row(0).swap(mesh.nodes.row(4));
  EXPECT_THAT(check_complaint(corner_mesh(mesh)), HasSubstr("duplicate"));
}

TEST(CheckClosedSurface, AnUnusedNode) {
  Mesh mesh = octahedron();
  mesh.nodes.conservativeResize(7, 3);
  mesh.nodes.row(6).setOnes();
  EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("node 7 "), HasSubstr("in no element")));
}

TEST(CheckClosedSurface, ANodeNumberOutOfRange) {
  for (int bad : {-1, 6}) {
    Mesh mesh = octahedron();
    mesh.elements(4, 2) = bad;
    EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("element 5 "), HasSubstr("out of range, 1 to 6")));
  }
}

TEST(CheckClosedSurface, NoElementsOrAWrongNumberOfNodes) {
  Mesh mesh = octahedron();
  mesh.degree = 2;
  EXPECT_THAT(check_complaint(mesh), HasSubstr("3 nodes an element, 3 and 6 expected"));
  mesh.elements.resize(0, 6);
  EXPECT_THAT(check_complaint(mesh), HasSubstr("here: no triangle"));
}

TEST(CheckClosedSurface, NeighboursWithDifferentEdgeNodes) {
  // P2: a second node at an edge's midpoint.
  Mesh mesh = curved_octahedron(2);
  const int shared = mesh.elements(4, 3);
  mesh.nodes.conservativeResize(mesh.nodes.rows() + 1, 3);
  mesh.nodes.bottomRows(1) = mesh.nodes.row(shared);
  mesh.elements(4, 3) = int(mesh.nodes.rows()) - 1;
  EXPECT_THAT(check_complaint(mesh), AllOf(HasSubstr("here: element"), HasSubstr("the same node expected")));
  // P3: the right nodes in the wrong order.
  mesh = curved_octahedron(3);
  std::swap(mesh.elements(0, 3), mesh.elements(0, 4));
  EXPECT_THAT(check_complaint(mesh), HasSubstr("the same node expected"));
}

TEST(CheckClosedSurface, AnEdgeNodeOfTwoEdges) {
  Mesh mesh = curved_octahedron(2);
  const int kept = mesh.elements(0, 3), lost = mesh.elements(6, 4), last = int(mesh.nodes.rows()) - 1;
  for (int& i : mesh.elements.reshaped()) i = i == lost ? kept : i == last ? lost : i;
  const Field nodes = mesh.nodes.topRows(last);
  mesh.nodes.row(lost).swap(mesh.nodes.row(last));
  mesh.nodes = nodes;
  EXPECT_THAT(check_complaint(mesh), HasSubstr("belongs to two edges"));
}

class InwardMesh : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, InwardMesh, testing::Values(1, 2, 3, 4));

TEST_P(InwardMesh, IsTurned) {
  // A reflection turns the orientation; far from the origin, the sign must not depend on where the surface
  // lies.
  const Mesh outward = curved_octahedron(GetParam());
  Mesh mesh = outward;
  mesh.nodes.col(2) *= -1;
  mesh.nodes.array() += 50;
  const Mesh inward = mesh;
  EXPECT_EQ(check_closed_surface(mesh, "here"), "orientation was inward: turned");
  EXPECT_EQ(mesh.nodes, inward.nodes);
  mesh.nodes.array() -= 50;
  EXPECT_GT(enclosed_volume(mesh), 1);
  EXPECT_EQ(check_closed_surface(mesh, "here"), "");
  // The element maps are the old ones with the reference coordinates swapped: so refining commutes with
  // turning.
  const Mesh fine = lagrange_mesh(mesh, 4);
  const double off_sphere = (lagrange_mesh(outward, 4).nodes.rowwise().norm().array() - 1).abs().maxCoeff();
  EXPECT_NEAR((fine.nodes.rowwise().norm().array() - 1).abs().maxCoeff(), off_sphere, 1e-12);
}

}  // namespace esfem::test_check
