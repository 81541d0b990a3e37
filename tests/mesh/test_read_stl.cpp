// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of STL files: what is read, and what is refused with its line or byte.
#include <gmock/gmock.h>

#include <cctype>
#include <random>

#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_read_stl {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

const Mesh ellipsoid = small_ellipsoid();
const std::string plain = stl(ellipsoid);

std::string complaint(const std::string& text) {
  return complaint_of(parse_stl, text);
}

std::string named(const std::string& name) {
  return replaced_all(plain, "solid octahedron", "solid" + name);
}

}  // namespace

TEST(ReadStl, Keywords) {
  EXPECT_EQ(expect_small_ellipsoid(parse_stl, plain), "");
  std::string capitals = plain;
  for (char& c : capitals) c = char(std::toupper(static_cast<unsigned char>(c)));
  expect_small_ellipsoid(parse_stl, capitals);
  expect_small_ellipsoid(parse_stl, replaced_all(plain, "facet normal", "Facet NORMAL"));
  expect_small_ellipsoid(parse_stl, replaced_all(plain, "normal 0 0 0", "normal -nan(ind) nan nan"));
  EXPECT_THAT(complaint(replaced(plain, "endloop", "vertex 0 0 0")),
              StartsWith("a: line 7: 'vertex' found, endloop expected"));
  EXPECT_THAT(complaint(replaced(plain, "outer", "inner")),
              StartsWith("a: line 3: 'inner' found, outer expected"));
}

TEST(ReadStl, Names) {
  for (const char* name :
       {"", " ", "\tm", " my solid part", " facet 7", " facet normal part", " endsolid", " 1 2 3"})
    expect_small_ellipsoid(parse_stl, named(name));
}

TEST(ReadStl, Blanks) {
  expect_small_ellipsoid(parse_stl, replaced_all(plain, "\n", "\r\n\n"));
  expect_small_ellipsoid(parse_stl, replaced_all(plain, "\n", "\t"));
  expect_small_ellipsoid(parse_stl, replaced_all(plain, " ", " \t "));
  expect_small_ellipsoid(parse_stl, "\n  " + plain + "\n\n");
}

TEST(ReadStl, SeveralSolids) {
  // Cut in two after facet 30: both halves are open, together they are closed.
  std::size_t at = 0;
  for (int i = 0; i < 30; ++i) at = plain.find("endfacet\n", at) + 9;
  for (const std::string between :
       {"endsolid a\nsolid b\n", "endsolid solid a\n\nsolid\n", "endsolid\nSOLID facet\n"}) {
    const std::string text = plain.substr(0, at) + between + plain.substr(at);
    expect_small_ellipsoid(parse_stl, text);
    expect_small_ellipsoid(parse_stl, replaced_all(text, "\n", " "));
  }
  EXPECT_THAT(complaint(plain.substr(0, at) + "endsolid\n" + plain.substr(at)),
              StartsWith("a: line 213: 'facet' found, solid expected"));
}

TEST(ReadStl, CutOff) {
  EXPECT_THAT(complaint(replaced(plain, "endsolid octahedron", "")),
              HasSubstr("the file ends here, endsolid expected"));
  EXPECT_THAT(complaint(plain.substr(0, plain.find("endloop"))),
              HasSubstr("the file ends here, endloop expected"));
  EXPECT_THAT(complaint("solid\nendsolid\n"), HasSubstr("no triangle"));
  EXPECT_THAT(complaint("stl\n"), StartsWith("a: line 1: no STL file, the keyword solid"));
}

TEST(ReadStl, BinaryHeads) {
  for (const char* head : {"", "solid a endsolid a exported", "solid", "facet normal", "\xff\xfe"})
    EXPECT_EQ(expect_small_ellipsoid(parse_stl, binary_stl_with_head(ellipsoid, head), 1e-7), "");
}

TEST(ReadStl, BinarySizes) {
  for (const char* head : {"", "solid"}) {
    const std::string binary = binary_stl_with_head(ellipsoid, head);
    EXPECT_EQ(expect_small_ellipsoid(parse_stl, binary + "a newline\r\n", 1e-7),
              "11 bytes after the last triangle: skipped");
    EXPECT_THAT(complaint(binary.substr(0, 3000)),
                StartsWith("a: byte 85: 80 triangles announced, but the file holds 58 of"));
    EXPECT_THAT(complaint(binary + binary), HasSubstr("80 triangles announced, but the file holds 161"));
    std::string huge = binary;
    for (int i = 80; i < 84; ++i) huge[i] = '\xff';
    EXPECT_THAT(complaint(huge), HasSubstr("4294967295 triangles announced"));
  }
  std::string bad = binary_stl(ellipsoid);
  const float infinite = INFINITY;
  std::memcpy(&bad[84 + 50 + 12], &infinite, sizeof infinite);
  EXPECT_THAT(complaint(bad), HasSubstr("element 2 (counted from 1): coordinate inf, a finite"));
}

TEST(ReadStl, RoundedCorners) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> rounding(-1e-7, 1e-7);
  Mesh soup = triangle_soup(ellipsoid);
  for (double& x : soup.nodes.reshaped()) x += rounding(random);
  const std::string remark = expect_small_ellipsoid(parse_stl, stl(soup), 1e-6);
  EXPECT_THAT(remark, AllOf(StartsWith("240 nodes in 42 places, corners within 1e-06 of the size"),
                            HasSubstr("joined")));
}

}  // namespace esfem::test_read_stl
