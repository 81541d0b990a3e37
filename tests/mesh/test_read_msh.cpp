// SPDX-License-Identifier: GPL-3.0-or-later
// What the parser of Gmsh files refuses, and where it says the fault is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/read.hpp"

namespace esfem::test_read_msh {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

const char* tetrahedron_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
$EndNodes
$Elements
5
1 15 2 0 1 10
2 2 2 0 1 10 30 20
3 2 2 0 1 10 20 40
4 2 2 0 1 10 40 30
5 2 2 0 1 20 30 40
$EndElements
)";

const char* tetrahedron_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 4 10 40
2 1 0 4
10
20
30
40
0 0 0
1 0 0
0 1 0
0 0 1
$EndNodes
$Elements
2 5 1 5
0 1 15 1
1 10
2 1 2 4
2 10 30 20
3 10 20 40
4 10 40 30
5 20 30 40
$EndElements
)";

/// The complaint about a file whose line of that number is replaced; without text, the line is dropped.
std::string complaint(const std::string& file, int line, const std::string& text) {
  std::istringstream in(file);
  std::string changed, old;
  for (int number = 1; std::getline(in, old); ++number)
    if (number != line)
      changed += old + "\n";
    else if (!text.empty())
      changed += text + "\n";
  try {
    parse_msh("a.msh", changed);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST(ParseMsh, AcceptsBothVersions) {
  EXPECT_EQ(complaint(tetrahedron_2, 0, ""), "");
  EXPECT_EQ(complaint(tetrahedron_4, 0, ""), "");
}

TEST(ParseMsh, KnowsTagsAndLines) {
  for (const auto& [text, node, element] :
       {std::tuple{tetrahedron_2, "node 20 (line 7)", "element 3 (line 15)"},
        {tetrahedron_4, "node 20 (line 12)", "element 3 (line 22)"}}) {
    const MeshFile read = parse_msh("a.msh", text);
    EXPECT_EQ(read.origin.node(1), node);
    EXPECT_EQ(read.origin.element(1), element);
    EXPECT_EQ(read.mesh.elements.row(1), (Eigen::RowVectorXi(3) << 0, 1, 3).finished());
  }
}

TEST(ParseMsh, Format) {
  EXPECT_THAT(complaint(tetrahedron_2, 1, "OFF"),
              StartsWith("a.msh: line 1: no Gmsh file, $MeshFormat expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 2, "4 0 8"),
              AllOf(StartsWith("a.msh: line 2: "), HasSubstr("2.2 or 4.1 expected")));
  EXPECT_THAT(
      complaint(tetrahedron_4, 2, "4.1 1 8"),
      AllOf(StartsWith("a.msh: line 2: binary"), HasSubstr("ASCII expected"), HasSubstr("Mesh.Binary = 0")));
}

TEST(ParseMsh, OtherElements) {
  EXPECT_THAT(
      complaint(tetrahedron_2, 15, "3 3 2 0 1 10 20 40 30"),
      AllOf(StartsWith("a.msh: line 15: "), HasSubstr("type 3 (4-node quadrangle)"), HasSubstr("expected")));
  EXPECT_THAT(complaint(tetrahedron_2, 15, "3 4 2 0 1 10 20 40 30"), HasSubstr("4-node tetrahedron"));
  EXPECT_THAT(complaint(tetrahedron_4, 20, "2 1 21 4"), HasSubstr("type 21 (10-node triangle)"));
  EXPECT_THAT(complaint(tetrahedron_2, 15, "3 9 2 0 1 10 20 40 30 30 30"),
              AllOf(StartsWith("a.msh: line 15: "), HasSubstr("a 6-node triangle after 3-node triangles")));
}

TEST(ParseMsh, Numbers) {
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 nan 0"),
              StartsWith("a.msh: line 7: coordinate 'nan', a finite"));
  EXPECT_THAT(complaint(tetrahedron_4, 12, "1 inf 0"),
              StartsWith("a.msh: line 12: coordinate 'inf', a finite"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 zero 0"), StartsWith("a.msh: line 7: 'zero' found"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 0,5 0"), StartsWith("a.msh: line 7: '0,5' found"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 0"), StartsWith("a.msh: line 7: 3 words found"));
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 2 0 1 10 30"),
              StartsWith("a.msh: line 14: 7 words found, 8 expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 99999999999 0 1 10 30 20"),
              StartsWith("a.msh: line 14: 99999999999 tags"));
  EXPECT_THAT(complaint(tetrahedron_2, 5, "-4"), StartsWith("a.msh: line 5: -4 found"));
}

TEST(ParseMsh, Nodes) {
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 2 0 1 10 30 50"),
              StartsWith("a.msh: element 2 (line 14): node 50 is not in $Nodes"));
  EXPECT_THAT(complaint(tetrahedron_2, 8, "20 0 1 0"), StartsWith("a.msh: line 8: node 20 a second time"));
  EXPECT_THAT(complaint(tetrahedron_4, 9, "20"), StartsWith("a.msh: line 9: node 20 a second time"));
}

TEST(ParseMsh, Counts) {
  EXPECT_THAT(complaint(tetrahedron_2, 5, "5"),
              StartsWith("a.msh: line 10: '$EndNodes' found, node 5 of 5 expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 5, "3"), StartsWith("a.msh: line 9: '40' found, $EndNodes expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 12, "6"),
              HasSubstr("line 18: '$EndElements' found, element 6 of 6 expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 12, "4"), HasSubstr("line 17: '5' found, $EndElements expected"));
  EXPECT_THAT(complaint(tetrahedron_4, 5, "1 5 10 40"), HasSubstr("4 nodes in the blocks, 5 expected"));
  EXPECT_THAT(complaint(tetrahedron_4, 17, "2 6 1 5"), HasSubstr("5 elements in the blocks, 6 expected"));
  EXPECT_THAT(complaint(tetrahedron_4, 6, "2 1 0 3"), StartsWith("a.msh: line 10: "));
}

TEST(ParseMsh, Sections) {
  const std::string text = tetrahedron_2;
  EXPECT_THAT(complaint(text.substr(0, text.find("$Nodes")), 0, ""),
              HasSubstr("the file ends here, $Nodes expected"));
  EXPECT_THAT(complaint(text.substr(0, text.find("$Elements")), 0, ""),
              HasSubstr("line 10: the file ends here, $Elements expected"));
  EXPECT_THAT(complaint(text.substr(0, text.find("4 2 2 0")), 0, ""),
              StartsWith("a.msh: line 15: the file ends here, element 4 of 5 expected"));
  EXPECT_THAT(complaint(text + "$NodeData\n1\n", 0, ""), HasSubstr("$EndNodeData expected"));
  EXPECT_EQ(complaint(text + "$NodeData\n1\n$EndNodeData\n", 0, ""), "");
  const std::string no_triangle = "$Elements\n1\n1 15 2 0 1 10\n$EndElements\n";
  EXPECT_THAT(complaint(text.substr(0, text.find("$Elements")) + no_triangle, 0, ""),
              HasSubstr("no triangle"));
}

class IndependentMesh : public testing::TestWithParam<std::pair<const char*, double>> {};
INSTANTIATE_TEST_SUITE_P(All, IndependentMesh,
                         testing::Values(std::pair{"sphere_radius2_642.msh", 0.96437269434518},
                                         std::pair{"sphere_radius2_1442.msh", 0.6679805881476549},
                                         std::pair{"sphere_radius2_2562.msh", 0.4933017592840227}));

TEST_P(IndependentMesh, IsCurvedAndHasTheEdgeLengthOfItsTable) {
  const auto [name, h] = GetParam();
  const ReadMesh read = read_mesh(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/" + name);
  EXPECT_EQ(read.mesh.degree, 2);
  EXPECT_EQ(read.remark, "");
  EXPECT_LT((read.mesh.nodes.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-14);
  EXPECT_NEAR(mesh_quality(read.mesh.elements, read.mesh.nodes).h, h, 1e-14);
  EXPECT_EQ(euler_characteristic(read.mesh), 2);
}

}  // namespace esfem::test_read_msh
