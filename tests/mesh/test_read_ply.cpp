// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of PLY files: what is read, and what is refused with its line or byte.
#include <gmock/gmock.h>

#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_read_ply {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

const Mesh ellipsoid = small_ellipsoid();
const std::string plain = ply(ellipsoid);  // nodes on lines 10 to 51, elements on 52 to 131

std::string complaint(const std::string& text) {
  return complaint_of(parse_ply, text);
}

/// Appends a number as the type says.
void put_as(std::string& out, const std::string& type, double value, bool swapped) {
  if (type == "char" || type == "int8") return put(out, std::int8_t(value), swapped);
  if (type == "uchar" || type == "uint8") return put(out, std::uint8_t(value), swapped);
  if (type == "short" || type == "int16") return put(out, std::int16_t(value), swapped);
  if (type == "ushort" || type == "uint16") return put(out, std::uint16_t(value), swapped);
  if (type == "int" || type == "int32") return put(out, std::int32_t(value), swapped);
  if (type == "uint" || type == "uint32") return put(out, std::uint32_t(value), swapped);
  if (type == "float" || type == "float32") return put(out, float(value), swapped);
  put(out, value, swapped);
}

const char* types[] = {"char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
                       "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};

/// An octahedron with corners at 0, 10 and 20, in one type for all numbers; format is ascii, or one of the
/// binary ones.
std::string octahedron_in(const std::string& format, const std::string& type) {
  Mesh mesh = octasphere(1, 0);
  mesh.nodes = (mesh.nodes.array() + 1) * 10;
  std::string text = "ply\nformat " + format + " 1.0\nelement vertex 6\n";
  for (const char* name : {"x", "y", "z"}) text += "property " + type + " " + name + "\n";
  text += "element face 8\nproperty list " + type + " " + type + " vertex_index\nend_header\n";
  const bool binary = format != "ascii", swapped = format == "binary_big_endian";
  const auto add = [&](double value) {
    if (binary)
      put_as(text, type, value, swapped);
    else
      text += std::to_string(int(value)) + " ";
  };
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 3; ++j) add(mesh.nodes(i, j));
    if (!binary) text += "\n";
  }
  for (int e = 0; e < 8; ++e) {
    add(3);
    for (int i = 0; i < 3; ++i) add(mesh.elements(e, i));
    if (!binary) text += "\n";
  }
  return text;
}

}  // namespace

TEST(ReadPly, AllTypesAndFormats) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* type : types) {
      // The numbers of elements are floats, too: unusual, but whole numbers.
      MeshFile file = parse_ply("a", octahedron_in(format, type));
      EXPECT_EQ(repair_and_check(file), "");
      EXPECT_NEAR(enclosed_volume(file.mesh), 4000. / 3, 1e-10) << format << " " << type;
    }
}

TEST(ReadPly, Heads) {
  EXPECT_EQ(expect_small_ellipsoid(parse_ply, plain), "");
  EXPECT_EQ(expect_small_ellipsoid(parse_ply, binary_ply(ellipsoid)), "");
  expect_small_ellipsoid(parse_ply, replaced_all(plain, "\n", "\r\n"));
  expect_small_ellipsoid(parse_ply,
                         replaced(plain, "format", "comment made by end_header\nobj_info element 7\nformat"));
  expect_small_ellipsoid(parse_ply, replaced(plain, "end_header", "comment property\nend_header"));
  expect_small_ellipsoid(parse_ply, replaced_all(binary_ply(ellipsoid), "end_header\n", "end_header\r\n"));
}

TEST(ReadPly, SkipsWhatItDoesNotNeed) {
  std::string head =
      "ply\nformat ascii 1.0\nelement material 2\nproperty list uchar float values\nproperty int id\n"
      "element vertex 42\nproperty float nx\nproperty double z\nproperty double y\nproperty list int int l\n"
      "property double x\nelement nothing 1000000000000\nelement face 80\nproperty uchar red\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "element edge 1\nproperty int a\nend_header\n";
  std::string text = head + "2 nan inf 7\n0 8\n";
  const Field& x = ellipsoid.nodes;
  for (int i = 0; i < 42; ++i)
    text += format("nan %.17g %.17g %d%s %.17g\n", x(i, 2), x(i, 1), i % 2, i % 2 ? " 5" : "", x(i, 0));
  for (int e = 0; e < 80; ++e) text += "255 3 " + corners(ellipsoid, e, 0) + " 2 0.5 -nan\n";
  expect_small_ellipsoid(parse_ply, text + "0\n");
  EXPECT_THAT(complaint(text), HasSubstr("line 143: the file ends here, edge 1 of 1 expected"));

  std::string binary = replaced(head, "ascii", "binary_big_endian");
  const auto add = [&binary](const char* type, double value) { put_as(binary, type, value, true); };
  add("uchar", 2), add("float", NAN), add("float", INFINITY), add("int", 7), add("uchar", 0), add("int", 8);
  for (int i = 0; i < 42; ++i) {
    add("float", NAN), add("double", x(i, 2)), add("double", x(i, 1)), add("int", i % 2);
    if (i % 2) add("int", 5);
    add("double", x(i, 0));
  }
  for (int e = 0; e < 80; ++e) {
    add("uchar", 255), add("uchar", 3);
    for (int i = 0; i < 3; ++i) add("int", ellipsoid.elements(e, i));
    add("uchar", 1), add("float", NAN);
  }
  add("int", 0);
  expect_small_ellipsoid(parse_ply, binary);
  expect_small_ellipsoid(parse_ply, binary + "\r\n");
  EXPECT_THAT(complaint(binary + "more"), HasSubstr("4 bytes after the last element"));
}

TEST(ReadPly, RealPropertiesOfVerticesAreNodalValues) {
  const std::string names[] = {"nu_x", "x", "u", "nu_z", "y", "nx", "a_y", "z", "nu_y"};
  std::string text = "ply\nformat ascii 1.0\nelement vertex 43\n";
  for (const std::string& name : names) text += "property double " + name + "\n";
  text += "element face 80\nproperty list uchar int vertex_index\nend_header\n";
  const Field& x = ellipsoid.nodes;
  for (int i = 0; i < 43; ++i) {  // the last one is in no face
    const int j = std::min(i, 41);
    text +=
        format("%d %.17g %d.5 %d %.17g 7 3 %.17g %d\n", i, x(j, 0), i, i + 200, x(j, 1), x(j, 2), i + 100);
  }
  for (int e = 0; e < 80; ++e) text += "3 " + corners(ellipsoid, e, 0) + "\n";
  MeshFile read = parse_ply("input", text);
  repair_and_check(read);
  ASSERT_EQ(read.fields.size(), 3u);
  const Field &nu = *find(read.fields, "nu"), &u = *find(read.fields, "u"), &a_y = *find(read.fields, "a_y");
  ASSERT_EQ(nu.rows(), 42);
  ASSERT_EQ(nu.cols(), 3);
  ASSERT_EQ(u.rows(), 42);
  for (int i = 0; i < 42; ++i) {
    EXPECT_EQ(nu.row(i), Eigen::RowVector3d(i, i + 100, i + 200));
    EXPECT_EQ(u(i, 0), i + 0.5);
    EXPECT_EQ(a_y(i, 0), 3);
  }
}

TEST(ReadPly, RefusesHeads) {
  const auto head = [](const std::string& from, const std::string& to) {
    return complaint(replaced(plain, from, to));
  };
  EXPECT_THAT(head("property double z\n", ""),
              AllOf(StartsWith("a: line 8: "), HasSubstr("no property z in the element vertex")));
  EXPECT_THAT(head("double z", "double w"), HasSubstr("no property z"));
  EXPECT_THAT(head("property double z", "property list uchar double z"),
              HasSubstr("property z of the element vertex is a list"));
  EXPECT_THAT(head("element vertex", "property uchar flag\nelement vertex"),
              StartsWith("a: line 3: property before the first element"));
  EXPECT_THAT(head("element vertex", "element point"), HasSubstr("no element vertex"));
  EXPECT_THAT(head("element face", "element tristrips"), HasSubstr("strips of triangles"));
  EXPECT_THAT(head("element face", "element faces"), HasSubstr("no element face"));
  EXPECT_THAT(head("vertex_indices", "indices"), HasSubstr("0 lists vertex_indices or vertex_index"));
  EXPECT_THAT(head("double y", "double x"), StartsWith("a: line 5: property x a second time"));
  EXPECT_THAT(head("double y", "real y"), StartsWith("a: line 5: 'real' found as type"));
  EXPECT_THAT(head("ascii", "text"), StartsWith("a: line 2: format text 1.0"));
  EXPECT_THAT(head("1.0", "2.0"), StartsWith("a: line 2: format ascii 2.0"));
  EXPECT_THAT(head("format ascii 1.0\n", ""), HasSubstr("no format in the head"));
  EXPECT_THAT(head("end_header", "end"), HasSubstr("'end' found in the head"));
  EXPECT_THAT(head("ply", "PLY"), StartsWith("a: line 1: no PLY file"));
}

TEST(ReadPly, NamesTheLine) {
  const std::string x = coordinates(ellipsoid.nodes, 1), element = "\n3 " + corners(ellipsoid, 1, 0);
  const auto body = [](const std::string& from, const std::string& to) {
    return complaint(replaced(plain, from, to));
  };
  EXPECT_THAT(body(x, "0 1"), StartsWith("a: line 11: 2 words found, a coordinate expected next"));
  EXPECT_THAT(body(x, "0 1 2 3"), StartsWith("a: line 11: 4 words found, 3 expected"));
  EXPECT_THAT(body(x, "0 1 0.3x"), StartsWith("a: line 11: '0.3x' found"));
  EXPECT_THAT(body(x, "0 1 nan"), StartsWith("a: line 11: coordinate 'nan', a finite"));
  EXPECT_THAT(body(element, "\n3 1 2"), StartsWith("a: line 53: 3 words found, a corner"));
  EXPECT_THAT(body(element, "\n3 1 2 7.7"), StartsWith("a: line 53: '7.7' found"));
  EXPECT_THAT(body(element, "\n-3 1 2 7"), StartsWith("a: line 53: -3 found as length"));
  EXPECT_THAT(body(element, "\n3 1 2 42"),
              StartsWith("a: element 2 (line 53): node 42, out of range: 0 to 41"));
  EXPECT_THAT(body("vertex 42", "vertex 43"), StartsWith("a: line 52: 4 words found, 3 expected"));
  EXPECT_THAT(body("face 80", "face 81"), StartsWith("a: line 131: the file ends here, face 81 of 81"));
  EXPECT_THAT(body("face 80", "face 79"), StartsWith("a: line 131: a line after the last element"));
  EXPECT_THAT(body("face 80", "face -1"), StartsWith("a: line 7: -1 found"));
  const std::string whole = octahedron_in("ascii", "int");
  EXPECT_THAT(complaint(replaced(whole, "\n20 ", "\n7.5 ")), HasSubstr("'7.5' found"));
}

TEST(ReadPly, NamesTheByte) {
  const std::string binary = binary_ply(ellipsoid);
  EXPECT_THAT(complaint(replaced(binary, "vertex 42", "vertex 42000000000")), StartsWith("a: byte "));
  std::string list = replaced(binary, "list uchar", "list uint");
  EXPECT_THAT(complaint(list), StartsWith("a: byte "));
  std::string bad = binary;
  const double nan = NAN;
  std::memcpy(&bad[binary.find("end_header") + 11 + 24], &nan, sizeof nan);
  EXPECT_THAT(complaint(bad), HasSubstr("vertex 2 of 42: coordinate 'nan', a finite"));
}

}  // namespace esfem::test_read_ply
