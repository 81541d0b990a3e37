// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of OBJ files: what is read, and what is refused with its line.
#include <gmock/gmock.h>

#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_read_obj {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

const Mesh ellipsoid = small_ellipsoid();
const std::string plain = obj(ellipsoid);  // nodes on lines 2 to 43, elements on 44 to 123

std::string complaint(const std::string& text) {
  return complaint_of(parse_obj, text);
}

std::string element(int e, const std::string& between = " ", const std::string& behind = "") {
  std::string text = "f";
  for (int i = 0; i < 3; ++i) text += between + std::to_string(ellipsoid.elements(e, i) + 1) + behind;
  return text + "\n";
}

/// The file with its elements written in another way.
std::string with_elements(const std::string& between, const std::string& behind) {
  std::string text = plain.substr(0, plain.find("f "));
  for (int e = 0; e < 80; ++e) text += element(e, between, behind);
  return text;
}

}  // namespace

TEST(ReadObj, IgnoresOtherStatements) {
  EXPECT_EQ(expect_small_ellipsoid(parse_obj, plain), "");
  for (const char* statement : {"l 1 2 3",
                                "p 1",
                                "mg 1 0.5",
                                "g part#1",
                                "s off",
                                "o an object",
                                "usemtl f",
                                "mtllib a b.mtl",
                                "call other.obj 1",
                                "csh -ls",
                                "vt 0 nan",
                                "vn 0 0 nan",
                                "vp 1 2",
                                "curv 0 1 1 2 \\\n 3 4",
                                "lod 3",
                                "bevel on",
                                "# f 1 2 3 \\",
                                "usemtl C:\\",
                                "  ",
                                "\t# a comment"})
    expect_small_ellipsoid(parse_obj, replaced(plain, "f ", std::string(statement) + "\nf "));
}

TEST(ReadObj, BlanksAndContinuation) {
  expect_small_ellipsoid(parse_obj, replaced_all(plain, " ", "\t"));
  expect_small_ellipsoid(parse_obj, replaced_all(plain, "\n", " \r\n"));
  expect_small_ellipsoid(parse_obj, replaced_all(plain, "\n", "\r"));
  expect_small_ellipsoid(parse_obj, with_elements(" \\\n ", ""));
  expect_small_ellipsoid(parse_obj, with_elements(" ", "\\\n"));
  expect_small_ellipsoid(parse_obj, replaced_all(plain, "\nv ", "\nv \\\n"));
  expect_small_ellipsoid(parse_obj, replaced_all(plain, "\n", " # a comment \\\n"));
}

TEST(ReadObj, Corners) {
  expect_small_ellipsoid(parse_obj, with_elements(" ", "/1"));
  expect_small_ellipsoid(parse_obj, with_elements(" ", "//7"));
  expect_small_ellipsoid(parse_obj, with_elements(" ", "/-1/7"));
  for (const char* empty : {"/", "//", "/1/"}) expect_small_ellipsoid(parse_obj, with_elements(" ", empty));
  expect_small_ellipsoid(parse_obj, replaced_all(plain, "\nf ", "\nfo "));
  std::string relative = plain.substr(0, plain.find("f "));
  for (int e = 0; e < 80; ++e) {
    relative += "f";
    for (int i = 0; i < 3; ++i) relative += " " + std::to_string(ellipsoid.elements(e, i) - 42);
    relative += "\n";
  }
  expect_small_ellipsoid(parse_obj, relative);
  for (const char* bad : {"1 2 3 x", "1 2 3.5", "1 2 3/1/2/3", "1 2 /3", "1 2 3/x", "1 2 3/1/x"})
    EXPECT_THAT(complaint(plain + "f " + bad),
                AllOf(StartsWith("a: line 124: corner '"), HasSubstr("integers")));
  EXPECT_THAT(complaint(plain + "f 1 2 0"), StartsWith("a: line 124: corner 0, out of range: 1 to 42"));
  EXPECT_THAT(complaint(plain + "f 1 2 -43"), StartsWith("a: line 124: corner -43, out of range"));
  EXPECT_THAT(complaint(plain + "f 1 2 43"),
              StartsWith("a: element 81 (line 124): node 43, out of range: 1 to 42"));
  EXPECT_THAT(complaint(plain + "f 1 2"), StartsWith("a: element 81 (line 124): 2 corners, at least 3"));
}

TEST(ReadObj, Vertices) {
  for (const char* more : {" 1.0", " 0.5", " 0.1 0.2 0.3", " 1 0.1 0.2 0.3", " # a comment"}) {
    std::string text = "# a comment\n";
    for (int i = 0; i < 42; ++i) text += "v " + coordinates(ellipsoid.nodes, i) + more + "\n";
    for (int e = 0; e < 80; ++e) text += element(e);
    expect_small_ellipsoid(parse_obj, text);
  }
  const std::string x = "v " + coordinates(ellipsoid.nodes, 1);
  EXPECT_THAT(complaint(replaced(plain, x, "v 1 2")), StartsWith("a: line 3: v with 2 numbers, 3 expected"));
  EXPECT_THAT(complaint(replaced(plain, x, "v 1 2 3 4 5")), StartsWith("a: line 3: v with 5 numbers"));
  EXPECT_THAT(complaint(replaced(plain, x, "v 1 2 3 w")), StartsWith("a: line 3: 'w' found"));
  EXPECT_THAT(complaint(replaced(plain, x, "v 1 2 0,5")), StartsWith("a: line 3: '0,5' found"));
  EXPECT_THAT(complaint(replaced(plain, x, "v 1 2 inf")), StartsWith("a: line 3: coordinate 'inf'"));
  EXPECT_THAT(complaint("hello\n"), StartsWith("a: no triangle"));
}

TEST(ReadObj, NodesOfTheirOwnForEachElement) {
  EXPECT_EQ(expect_small_ellipsoid(parse_obj, obj(triangle_soup(ellipsoid))),
            "equal nodes, 240 nodes in 42 places: joined");
}

}  // namespace esfem::test_read_obj
