// SPDX-License-Identifier: GPL-3.0-or-later
// Files of Gmsh itself (tests/mesh/gmsh), and what is made of volume elements, quadrangles and nodal data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/fe/quadrature.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/read.hpp"

namespace esfem::test_msh_surface {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

std::string sample(const std::string& name) {
  return ESFEM_SOURCE_DIR "/tests/mesh/gmsh/" + name;
}

/// Area, and the enclosed volume by the divergence theorem, of the curved elements.
struct Content {
  double area = 0, volume = 0;
};
Content content_of(const Mesh& mesh) {
  const Quadrature rule = conical_quadrature(8);
  const ShapeTable shape = shape_functions(mesh.degree, rule.points);
  Content content;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Field x = mesh.nodes(mesh.elements.row(e), Eigen::all);
    const Field at = shape.value * x, dxi = shape.dxi * x, deta = shape.deta * x;
    for (int q = 0; q < at.rows(); ++q) {
      const Vec3 normal = Vec3(dxi.row(q)).cross(Vec3(deta.row(q)));
      content.area += rule.weights[q] * normal.norm();
      content.volume += rule.weights[q] * normal.dot(Vec3(at.row(q))) / 3;
    }
  }
  return content;
}

/// How far the element maps leave the sphere of samples, at quadrature points.
double distance_from_ball(const Mesh& mesh) {
  const ShapeTable shape = shape_functions(mesh.degree, conical_quadrature(6).points);
  double distance = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Field x = shape.value * Field(mesh.nodes(mesh.elements.row(e), Eigen::all));
    const Field from_centre = x.rowwise() - Eigen::RowVector3d(0.1, 0.2, 0.3);
    distance = std::max(distance, (from_centre.rowwise().norm().array() - 1).abs().maxCoeff());
  }
  return distance;
}

std::string msh_2(const std::string& nodes, const std::string& elements, const std::string& more = "") {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements +
         "$EndElements\n" + more;
}

/// Two tetrahedra with the face 1 2 3 in common.
const char* five_nodes = "5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n";

std::string complaint(const std::string& text) {
  try {
    parse_msh("a.msh", text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST(OfMeshio, NodalValuesAndCurvedTriangles) {
  const ReadMesh read = read_mesh(sample("of_meshio.msh"));
  EXPECT_EQ(read.mesh.degree, 2);
  ASSERT_EQ(read.fields.size(), 2u);
  for (const NodalField& field : read.fields)
    EXPECT_EQ(field.values, field.name == "nu" ? read.mesh.nodes : Field(Field::Constant(18, 1, 2)));
}

struct Sample {
  const char* name;
  int degree;
  double distance;  ///< from the sphere
  std::string remark;
};
class GmshBall : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(
    All, GmshBall,
    testing::Values(Sample{"binary_2.2.msh", 1, 0.5, ""}, Sample{"binary_4.1.msh", 1, 0.5, ""},
                    Sample{"parametric.msh", 1, 0.5, ""}, Sample{"order_3.msh", 3, 0.02, ""},
                    Sample{"order_4.msh", 4, 0.01, ""}, Sample{"volume_2.msh", 2, 0.05, "dropped"},
                    Sample{"partitions.msh", 1, 0.5, "the boundary of "},
                    Sample{"quadrangles.msh", 1, 0.5, "cut into triangles"}));

TEST_P(GmshBall, IsReadWithItsCurvedElements) {
  const Sample& expected = GetParam();
  const ReadMesh read = read_mesh(sample(expected.name));
  EXPECT_EQ(read.mesh.degree, expected.degree);
  EXPECT_THAT(read.remark, HasSubstr(expected.remark));
  EXPECT_EQ(euler_characteristic(read.mesh), 2);
  EXPECT_LT(distance_from_ball(read.mesh), expected.distance);
  const Field from_centre = read.mesh.nodes.rowwise() - Eigen::RowVector3d(0.1, 0.2, 0.3);
  EXPECT_LT((from_centre.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-7);
}

TEST(GmshOrders, TheNodeOrderInsideOfElementsIsGmshs) {
  const Mesh mesh = read_mesh(sample("order_4.msh")).mesh;
  const double right = distance_from_ball(mesh);
  for (const auto& [a, b] : {std::pair{12, 13}, {13, 14}, {3, 5}, {3, 6}}) {
    Mesh wrong = mesh;
    wrong.elements.col(a).swap(wrong.elements.col(b));
    EXPECT_GT(distance_from_ball(wrong), 5 * right) << a << " and " << b;
  }
}

TEST(GmshVolumes, HexahedraAndPrisms) {
  const Content box = content_of(read_mesh(sample("hexahedra.msh")).mesh);
  EXPECT_NEAR(box.area, 22, 1e-12);
  EXPECT_NEAR(box.volume, 6, 1e-12);
  const Mesh cylinder = read_mesh(sample("prisms.msh")).mesh;
  EXPECT_EQ(euler_characteristic(cylinder), 2);
  EXPECT_NEAR(content_of(cylinder).volume, pi, 0.6);
}

TEST(GmshVolumes, IncompleteElementsAreRefusedByName) {
  try {
    read_mesh(sample("incomplete.msh"));
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("line "), HasSubstr("type 20 (incomplete 9-node triangle)"),
                                    HasSubstr("expected")));
  }
}

TEST(MshVolumes, TheBoundaryIsTakenWhereTrianglesAreMissingOrInside) {
  const std::string tetrahedra = "2 4 2 0 1 1 2 3 4\n3 4 2 0 1 1 3 2 5\n";
  for (const std::string triangles : {"", "1 2 2 0 1 1 2 3\n"}) {
    const std::string count = triangles.empty() ? "2\n" : "3\n";
    MeshFile read = parse_msh("a.msh", msh_2(five_nodes, count + triangles + tetrahedra));
    EXPECT_THAT(read.remarks, ElementsAre("the boundary of 2 volume elements, 6 faces, is the surface"));
    EXPECT_EQ(read.mesh.elements.rows(), 6);
    EXPECT_EQ(read.origin.element(5), triangles.empty() ? "element 3 (line 15)" : "element 3 (line 16)");
    EXPECT_EQ(check_closed_surface(read.mesh, read.origin), "");
    EXPECT_NEAR(content_of(read.mesh).volume, 1.0 / 3, 1e-15);
  }
}

TEST(MshVolumes, FacesAreOutwardWhateverTheNodeOrderOfTheElements) {
  const std::string text = msh_2(five_nodes, "2\n2 4 2 0 1 2 1 3 4\n3 4 2 0 1 1 3 2 5\n");
  MeshFile read = parse_msh("a.msh", text);
  EXPECT_EQ(check_closed_surface(read.mesh, read.origin), "");
  EXPECT_NEAR(content_of(read.mesh).volume, 1.0 / 3, 1e-15);
}

TEST(MshVolumes, TrianglesThatAreTheBoundaryKeepTheirNumbersAndAreTurnedOutward) {
  const std::string text =
      msh_2("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n",
            "5\n11 2 0 1 2 3\n12 2 0 1 2 4\n13 2 0 2 3 4\n14 2 0 4 1 3\n15 4 0 1 2 3 4\n");
  MeshFile read = parse_msh("a.msh", text);
  EXPECT_THAT(read.remarks, IsEmpty());
  EXPECT_EQ(read.origin.element(1), "element 12 (line 14)");
  EXPECT_EQ(check_closed_surface(read.mesh, read.origin), "");
  EXPECT_NEAR(content_of(read.mesh).volume, 1.0 / 6, 1e-15);
}

TEST(MshVolumes, ElementsOfSeveralPhysicalGroupsCountOnce) {
  const std::string twice = "2 4 2 0 1 1 2 3 4\n3 4 2 0 1 1 3 2 5\n4 4 2 7 1 1 2 3 4\n5 4 2 7 1 1 3 2 5\n";
  const MeshFile read = parse_msh("a.msh", msh_2(five_nodes, "4\n" + twice));
  EXPECT_THAT(read.remarks, ElementsAre("2 elements of several physical groups: taken once",
                                        "the boundary of 2 volume elements, 6 faces, is the surface"));
  // A triangle back to back with another one is no copy.
  EXPECT_EQ(parse_msh("a.msh", msh_2(five_nodes, "2\n1 2 0 1 2 3\n2 2 0 2 1 3\n")).mesh.elements.rows(), 2);
}

TEST(MshVolumes, OrdersDoNotMix) {
  EXPECT_THAT(complaint(msh_2(five_nodes, "2\n2 4 0 1 2 3 4\n3 29 0 1 3 2 5\n")),
              AllOf(HasSubstr("line 15"), HasSubstr("type 29 (20-node tetrahedron)")));
  EXPECT_THAT(complaint(msh_2(five_nodes, "2\n7 2 0 1 2 3\n8 9 0 1 2 3 4 5 1\n")),
              HasSubstr("element 8 (line 15): a 6-node triangle after a 3-node triangle"));
}

TEST(MshQuadrangles, AreCutAlongTheDiagonalInside) {
  // An arrow head: the shorter diagonal 1 3 lies outside.
  const std::string arrow = "4\n1 0 0 0\n2 1 1 0\n3 0 0.5 0\n4 -1 1 0\n";
  const MeshFile read = parse_msh("a.msh", msh_2(arrow, "1\n7 3 0 2 3 4 1\n"));
  EXPECT_THAT(read.remarks, ElementsAre("1 polygon cut into triangles"));
  ASSERT_EQ(read.mesh.elements.rows(), 2);
  EXPECT_EQ(read.origin.element(0), "element 7 (line 13)");
  EXPECT_EQ(read.origin.element(1), "element 7 (line 13)");
  EXPECT_NEAR(content_of(read.mesh).area, 0.5, 1e-15);
}

namespace {

const std::string tetrahedron = "4\n2 2 0 1 3 2\n3 2 0 1 2 4\n4 2 0 1 4 3\n5 2 0 2 3 4\n";
const std::string node_data =
    "$NodeData\n1\n\"u of t\"\n1\n0.5\n3\n0\n1\n4\n1 0.25\n2 -1e300\n3 3\n4 nan\n$EndNodeData\n";

}  // namespace

TEST(MshNodeData, AreFieldsByName) {
  const std::string vector = "$NodeData\n1\nv\n0\n4\n0\n3\n1\n0\n2 1 2 3\n$EndNodeData\n";
  const std::string four_nodes = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
  const MeshFile read = parse_msh("a.msh", msh_2(four_nodes, tetrahedron, node_data + vector));
  ASSERT_EQ(read.fields.size(), 2u);
  EXPECT_EQ(read.fields[0].name, "u of t");
  EXPECT_EQ(read.fields[0].values.topRows(3), (Field(3, 1) << 0.25, -1e300, 3).finished());
  EXPECT_TRUE(std::isnan(read.fields[0].values(3, 0)));
  EXPECT_EQ(read.fields[1].name, "v");
  EXPECT_EQ(read.fields[1].values.row(1), Eigen::RowVector3d(1, 2, 3));
  EXPECT_TRUE(std::isnan(read.fields[1].values(0, 2)));
}

TEST(MshNodeData, FollowTheNodesThatAreKept) {
  // Node 5 is in no triangle.
  MeshFile read =
      parse_msh("a.msh", msh_2("5\n5 9 9 9\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", tetrahedron, node_data));
  EXPECT_TRUE(std::isnan(read.fields[0].values(0, 0)));
  EXPECT_THAT(repair_and_check(read), HasSubstr("1 node in no triangle: dropped"));
  EXPECT_EQ(read.fields[0].values.rows(), 4);
  EXPECT_EQ(read.fields[0].values(0, 0), 0.25);
  EXPECT_EQ(read.origin.node_tags, (std::vector<long>{1, 2, 3, 4}));
}

TEST(MshNodeData, Errors) {
  const auto broken = [](const std::string& from, const std::string& to) {
    std::string data = node_data;
    data.replace(data.find(from), from.size(), to);
    return complaint(msh_2(five_nodes, tetrahedron, data));
  };
  EXPECT_EQ(broken("nan", "7"), "");
  EXPECT_THAT(broken("3\n0\n1\n4\n", "2\n0\n1\n"), HasSubstr("2 integer tags, at least 3 expected"));
  EXPECT_THAT(broken("\n1\n4\n", "\n2\n4\n"), HasSubstr("2 components a node, 1, 3 or 9 expected"));
  EXPECT_THAT(broken("3 3\n", "3\n"), HasSubstr("line 30: 1 words found"));
  EXPECT_THAT(broken("3 3\n", "9 3\n"), HasSubstr("$NodeData 'u of t': node 9 is not in $Nodes"));
  EXPECT_THAT(broken("4 nan\n", ""), HasSubstr("'$EndNodeData' found, the values of node 4 of 4 expected"));
}

}  // namespace esfem::test_msh_surface
