// SPDX-License-Identifier: GPL-3.0-or-later
// What is repaired in a mesh, and what is left unchanged.
#include <gmock/gmock.h>

#include <random>

#include "solver/mesh/repair.hpp"
#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_repair {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

namespace {

MeshFile repaired(const Mesh& mesh) {
  MeshFile file;
  file.mesh = mesh;
  file.origin.source = "here";
  repair(file);
  return file;
}

std::string complaint(const Mesh& mesh) {
  MeshFile file;
  file.mesh = mesh;
  file.origin.source = "here";
  try {
    repair_and_check(file);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Shifts every coordinate by at most that much.
Mesh rounded(Mesh mesh, double by) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> rounding(-by, by);
  for (double& x : mesh.nodes.reshaped()) x += rounding(random);
  return mesh;
}

Mesh shifted(Mesh mesh, double x) {
  mesh.nodes.col(0).array() += x;
  return mesh;
}

Mesh scaled(Mesh mesh, double by) {
  mesh.nodes *= by;
  return mesh;
}

}  // namespace

TEST(Repair, LeavesAClosedMeshAlone) {
  for (int degree : {1, 2, 3}) {
    Mesh mesh = lagrange_mesh(small_ellipsoid(), degree);
    const MeshFile file = repaired(mesh);
    EXPECT_THAT(file.remarks, IsEmpty());
    EXPECT_EQ(file.mesh.nodes, mesh.nodes);
    EXPECT_EQ(file.mesh.elements, mesh.elements);
  }
}

TEST(Repair, LeavesClosedComponentsThatTouch) {
  // Their nodes at (1, 0, 0) are equal.
  const Mesh octahedron = octasphere(1, 0);
  EXPECT_THAT(repaired(together(octahedron, shifted(octahedron, 2))).remarks, IsEmpty());
  EXPECT_EQ(complaint(together(octahedron, shifted(octahedron, 2))), "");
}

TEST(Repair, JoinsEqualNodes) {
  const Mesh ellipsoid = small_ellipsoid();
  const MeshFile file = repaired(triangle_soup(ellipsoid));
  EXPECT_THAT(file.remarks, ElementsAre("equal nodes, 240 nodes in 42 places: joined"));
  for (int e = 0; e < 80; ++e)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(file.mesh.nodes.row(file.mesh.elements(e, i)), ellipsoid.nodes.row(ellipsoid.elements(e, i)));
}

TEST(Repair, JoinsEqualNodesOfCurvedElements) {
  const Mesh curved = lagrange_mesh(small_ellipsoid(), 2);
  Mesh soup;
  soup.degree = 2;
  soup.nodes = curved.nodes(
      std::vector<int>(curved.elements.data(), curved.elements.data() + curved.elements.size()), Eigen::all);
  soup.elements.resize(80, 6);
  for (int i = 0; i < soup.elements.size(); ++i) soup.elements(i / 6, i % 6) = i;
  const MeshFile file = repaired(soup);
  EXPECT_EQ(file.mesh.nodes.rows(), curved.nodes.rows());
  EXPECT_EQ(complaint(soup), "");
}

TEST(Repair, JoinsNodesThatDifferByRounding) {
  for (double size : {1e-9, 1., 1e9}) {
    const Mesh soup = scaled(rounded(triangle_soup(small_ellipsoid()), 1e-7), size);
    const MeshFile file = repaired(soup);
    EXPECT_EQ(file.mesh.nodes.rows(), 42);
    ASSERT_EQ(file.remarks.size(), 1u);
    EXPECT_THAT(file.remarks[0],
                StartsWith("240 nodes in 42 places, corners within 1e-06 of the size (at most "));
    EXPECT_EQ(complaint(soup), "");
  }
}

TEST(Repair, LeavesNodesFurtherApart) {
  // The diagonal is 3.2: some pairs are nearer than 1e-6 of it, some are not.
  const std::string text = complaint(rounded(triangle_soup(small_ellipsoid()), 1e-5));
  EXPECT_THAT(text, HasSubstr("not closed"));
}

TEST(Repair, NeverTakesEdgesForRounding) {
  // Beside a body of size 1 one whose edges are shorter than what is joined, open: nothing may collapse.
  Mesh small = scaled(icosphere(1, 2), 3e-7);
  const int elements = int(small.elements.rows());
  const Mesh closed = together(small_ellipsoid(), shifted(small, 3));
  EXPECT_EQ(complaint(closed), "");
  small.elements.conservativeResize(elements - 1, 3);
  const Mesh open = together(small_ellipsoid(), shifted(small, 3));
  EXPECT_THAT(repaired(open).remarks, IsEmpty());
  EXPECT_THAT(complaint(open),
              AllOf(HasSubstr("1 boundary loop"), HasSubstr("3 edges"), Not(HasSubstr("joined"))));
  // Its own rounding is smaller than its edges.
  MeshFile file = repaired(
      together(small_ellipsoid(), rounded(triangle_soup(shifted(scaled(icosphere(1, 2), 3e-7), 3)), 1e-10)));
  EXPECT_EQ(file.mesh.nodes.rows(), 42 + 162);
  EXPECT_EQ(file.mesh.elements.rows(), 80 + elements);
}

TEST(Repair, DropsUnusedNodesAndKeepsNumbers) {
  Mesh mesh = octasphere(1, 0);
  mesh.nodes.conservativeResize(7, 3);
  mesh.nodes.row(6) = mesh.nodes.row(0);
  mesh.nodes.row(0) << 9, 9, 9;
  for (int& i : mesh.elements.reshaped())
    if (i == 0) i = 6;
  const MeshFile file = repaired(mesh);
  EXPECT_THAT(file.remarks, ElementsAre("1 node in no triangle: dropped"));
  EXPECT_EQ(file.mesh.nodes.rows(), 6);
  EXPECT_EQ(file.origin.node(5), "node 7 (counted from 1)");
}

TEST(Repair, DropsCollapsedElements) {
  // An edge that is split open, with an element of no area in between.
  Mesh mesh = octasphere(1, 0);
  mesh.elements.conservativeResize(9, 3);
  const int a = mesh.elements(0, 0), b = mesh.elements(0, 1);
  mesh.elements.row(8) << b, a, a;
  MeshFile file = repaired(mesh);
  EXPECT_THAT(
      file.remarks,
      ElementsAre(
          "1 degenerate element with two equal corners (the first is element 9 (counted from 1)): dropped"));
  EXPECT_EQ(file.mesh.elements, octasphere(1, 0).elements);
  // What is not closed without it is refused, and it is named.
  mesh = octasphere(1, 0);
  mesh.elements(3, 1) = mesh.elements(3, 0);
  EXPECT_THAT(complaint(mesh), AllOf(HasSubstr("not closed"), HasSubstr("(before: 1 degenerate element"),
                                     HasSubstr("element 4 (")));
}

TEST(Repair, FlipsElementsWithCornersOnALine) {
  // A cube whose lower front edge has three more corners, which its bottom has not: flat elements fill the
  // gap, one behind the other.
  Mesh mesh;
  mesh.nodes.resize(11, 3);
  mesh.nodes << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1,  // the cube
      0.25, 0, 0, 0.5, 0, 0, 0.7, 0, 0;
  mesh.elements.resize(18, 3);
  mesh.elements << 2, 1, 0, 3, 2, 0, 4, 5, 6, 4, 6, 7, 1, 2, 6, 1, 6, 5,  // bottom, top, right
      2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7,                                 // back, left
      0, 8, 4, 8, 9, 4, 9, 10, 4, 10, 1, 4, 1, 5, 4,                      // front
      0, 1, 10, 0, 10, 9, 0, 9, 8;
  MeshFile file = repaired(mesh);
  const char* remark = "3 elements with three corners on a line: flipped with the neighbour";
  EXPECT_THAT(file.remarks, ElementsAre(remark));
  EXPECT_EQ(repair_and_check(file), remark);
  EXPECT_EQ(file.mesh.nodes, mesh.nodes);
  EXPECT_NEAR(corner_area(file.mesh), 6, 1e-14);
  EXPECT_NEAR(enclosed_volume(file.mesh), 1, 1e-14);
}

TEST(Repair, DoublesNodesWhereTheSurfaceTouchesItself) {
  // Two octahedra with one node in common.
  Mesh mesh = together(octasphere(1, 0), shifted(octasphere(1, 0), 2));
  int common = -1;
  for (int& i : mesh.elements.reshaped()) {
    if (mesh.nodes.row(i) != Eigen::RowVector3d(1, 0, 0)) continue;
    if (common < 0) common = i;
    i = common;
  }
  MeshFile file = repaired(mesh);
  EXPECT_THAT(file.remarks, ElementsAre("1 node in no triangle: dropped",
                                        "1 node where the surface touches itself: added"));
  EXPECT_EQ(file.mesh.nodes.rows(), 12);
  EXPECT_EQ(file.origin.node(11), file.origin.node(common)) << "the file's number";
  EXPECT_THAT(repair_and_check(file), HasSubstr("2 components"));
  EXPECT_NEAR(enclosed_volume(file.mesh), 8. / 3, 1e-14);
}

TEST(Repair, WorksOnSizesThatOverflow) {
  EXPECT_NE(complaint(scaled(triangle_soup(octasphere(1, 0)), 1e300)), "x");
  EXPECT_NE(complaint(scaled(triangle_soup(octasphere(1, 0)), 1e-300)), "x");
  Mesh point = triangle_soup(octasphere(1, 0));
  point.nodes.setOnes();
  EXPECT_THAT(complaint(point), HasSubstr("no triangle"));
}

}  // namespace esfem::test_repair
