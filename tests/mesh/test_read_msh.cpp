// SPDX-License-Identifier: GPL-3.0-or-later
// What the parser of Gmsh files refuses, and where it locates the error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
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
  EXPECT_THAT(complaint(tetrahedron_2, 1, "$NOD"),
              AllOf(StartsWith("a.msh: line 1: MSH version 1, "), HasSubstr("MshFileVersion = 4.1")));
  EXPECT_THAT(complaint(tetrahedron_2, 4, "$ParametricNodes"),
              AllOf(StartsWith("a.msh: line 4: "), HasSubstr("SaveParametric = 0")));
  EXPECT_THAT(complaint(tetrahedron_4, 2, "4.1 1 8"), HasSubstr("byte 25: "));
  EXPECT_THAT(complaint(tetrahedron_4, 2, "4.1 1 4"), StartsWith("a.msh: line 2: data size 4, 8 expected"));
  EXPECT_THAT(complaint(tetrahedron_4, 2, "4.1 2 8"), StartsWith("a.msh: line 2: file type 2, 0 or 1"));
}

TEST(ParseMsh, OtherElements) {
  EXPECT_THAT(
      complaint(tetrahedron_2, 15, "3 16 2 0 1 10 20 40 30 1 2 3 4"),
      AllOf(StartsWith("a.msh: line 15: "), HasSubstr("type 16 (8-node quadrangle)"), HasSubstr("expected")));
  EXPECT_THAT(complaint(tetrahedron_4, 20, "2 1 25 4"), HasSubstr("type 25 (21-node triangle of order 5)"));
  EXPECT_THAT(complaint(tetrahedron_4, 20, "2 1 99 4"), HasSubstr("type 99 (unknown)"));
  EXPECT_THAT(complaint(tetrahedron_2, 15, "3 9 2 0 1 10 20 40 30 30 30"),
              StartsWith("a.msh: element 3 (line 15): a 6-node triangle after a 3-node triangle"));
}

TEST(ParseMsh, Numbers) {
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 nan 0"),
              StartsWith("a.msh: line 7: coordinate 'nan', a finite"));
  EXPECT_THAT(complaint(tetrahedron_4, 12, "1 inf 0"),
              StartsWith("a.msh: line 12: coordinate 'inf', a finite"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 zero 0"), StartsWith("a.msh: line 7: 'zero' found"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 0,5 0"), StartsWith("a.msh: line 7: '0,5' found"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 0"), StartsWith("a.msh: line 7: 3 words found"));
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 2 0 1 10 30"), StartsWith("a.msh: line 14: 7 words found"));
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 2 0 1 10 30 20 40"),
              StartsWith("a.msh: line 14: 9 words found, 8 expected"));
  EXPECT_THAT(complaint(tetrahedron_2, 7, "20 1 0 0 0"), StartsWith("a.msh: line 7: 5 words found, 4"));
  EXPECT_THAT(complaint(tetrahedron_2, 14, "2 2 99999999999 0 1 10 30 20"),
              StartsWith("a.msh: line 14: 8 words found"));
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
  EXPECT_THAT(complaint(text + "$ElementData\n1\n", 0, ""), HasSubstr("$EndElementData expected"));
  EXPECT_EQ(complaint(text + "$ElementData\n1\n$EndElementData\n", 0, ""), "");
  const std::string no_triangle = "$Elements\n1\n1 15 2 0 1 10\n$EndElements\n";
  EXPECT_THAT(complaint(text.substr(0, text.find("$Elements")) + no_triangle, 0, ""),
              HasSubstr("no triangle"));
}

namespace {

/// The numbers of a binary file; swapped: in the byte order that this machine does not have.
struct Binary {
  bool swapped;
  std::string bytes = {};

  template <class Value>
  Binary& put(std::initializer_list<Value> values) {
    for (Value value : values) {
      char c[sizeof(Value)];
      std::memcpy(c, &value, sizeof c);
      if (swapped) std::reverse(c, c + sizeof c);
      bytes.append(c, sizeof c);
    }
    return *this;
  }
  Binary& text(const std::string& lines) {
    bytes += lines;
    return *this;
  }
};

using Int = std::int32_t;
using Size = std::uint64_t;

/// The tetrahedron with a value at its node 30.
std::string binary_2(bool swapped) {
  Binary out{swapped};
  out.text("$MeshFormat\n2.2 1 8\n").put<Int>({1}).text("\n$EndMeshFormat\n$Nodes\n4\n");
  out.put<Int>({10}).put<double>({0, 0, 0}).put<Int>({20}).put<double>({1, 0, 0});
  out.put<Int>({30}).put<double>({0, 1, 0}).put<Int>({40}).put<double>({0, 0, 1});
  out.text("$EndNodes\n$Elements\n5\n").put<Int>({15, 1, 2, 1, 0, 1, 10});
  out.put<Int>({2, 4, 1, 2, 7, 10, 30, 20, 3, 7, 10, 20, 40, 4, 7, 10, 40, 30, 5, 7, 20, 30, 40});
  out.text("\n$EndElements\n$NodeData\n1\n\"u\"\n1\n0\n3\n0\n1\n1\n").put<Int>({30}).put<double>({0.1});
  return out.text("\n$EndNodeData\n").bytes;
}

std::string binary_4(bool swapped) {
  Binary out{swapped};
  out.text("$MeshFormat\n4.1 1 8\n").put<Int>({1}).text("\n$EndMeshFormat\n$Nodes\n");
  out.put<Size>({1, 4, 10, 40}).put<Int>({2, 1, 0}).put<Size>({4, 10, 20, 30, 40});
  out.put<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  out.text("\n$EndNodes\n$Elements\n").put<Size>({2, 5, 1, 5}).put<Int>({0, 1, 15}).put<Size>({1, 1, 10});
  out.put<Int>({2, 1, 2}).put<Size>({4, 2, 10, 30, 20, 3, 10, 20, 40, 4, 10, 40, 30, 5, 20, 30, 40});
  out.text("\n$EndElements\n$NodeData\n1\n\"u\"\n1\n0\n3\n0\n1\n1\n").put<Int>({30}).put<double>({0.1});
  return out.text("\n$EndNodeData\n").bytes;
}

}  // namespace

TEST(ParseBinaryMsh, BothVersionsInBothByteOrders) {
  const Mesh expected = parse_msh("a.msh", tetrahedron_2).mesh;
  for (const bool swapped : {false, true})
    for (const std::string& content : {binary_2(swapped), binary_4(swapped)}) {
      const MeshFile read = parse_msh("a.msh", content);
      EXPECT_EQ(read.mesh.nodes, expected.nodes);
      EXPECT_EQ(read.mesh.elements, expected.elements);
      EXPECT_EQ(read.origin.element(1), "element 3");
      ASSERT_EQ(read.fields.size(), 1u);
      EXPECT_EQ(read.fields[0].values(2, 0), 0.1);
    }
}

TEST(ParseBinaryMsh, CutOffAnywhereIsAnError) {
  for (const std::string& whole : {binary_2(false), binary_4(false)}) {
    const std::size_t end_of_elements = whole.find("$EndElements") + 12;
    for (std::size_t length = 0; length < whole.size() - 1; ++length) {
      if (length >= end_of_elements && length <= end_of_elements + 1) continue;
      EXPECT_THROW(parse_msh("a.msh", whole.substr(0, length)), InputError) << length;
    }
  }
}

TEST(ParseBinaryMsh, ErrorsNameTheByte) {
  const std::string two = binary_2(false), four = binary_4(false);
  EXPECT_THAT(complaint(two.substr(0, two.find("$EndNodes") - 4), 0, ""),
              StartsWith("a.msh: byte 154: the file ends here, coordinate expected"));
  std::string changed = four;
  changed[changed.find("$EndNodes") - 2] = '\x7f';
  changed[changed.find("$EndNodes") - 3] = '\xf0';
  EXPECT_THAT(complaint(changed, 0, ""), HasSubstr("coordinate inf, a finite number expected"));
  changed = four;
  changed[changed.find("$Nodes") + 7 + 8] = 5;
  EXPECT_THAT(complaint(changed, 0, ""), HasSubstr("4 nodes in the blocks, 5 expected"));
  changed = two;
  changed[changed.find("$Elements\n5\n") + 12] = 16;
  EXPECT_THAT(complaint(changed, 0, ""), HasSubstr("type 16 (8-node quadrangle)"));
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
