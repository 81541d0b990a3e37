// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/error.hpp"
#include "solver/mesh/read.hpp"

namespace esfem::test_read {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/// Writes a file of its own for the running test; returns its path.
std::string file_with(const std::string& text, const std::string& extension) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "_" + test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const std::string folder = ESFEM_BINARY_DIR "/test_meshes/", path = folder + name + "." + extension;
  std::filesystem::create_directories(folder);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// The error that a file gives, without the path but with the name; "" when it is read.
std::string complaint(const std::string& text, const std::string& extension) {
  const std::string path = file_with(text, extension);
  try {
    read_mesh(path);
    return "";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(path + ": "), 0u) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    return message.substr(path.size() + 2);
  }
}

Mesh octahedron() {
  return octasphere(1, 0);
}

std::string row(const Field& x, int i) {
  return format("%.17g %.17g %.17g", x(i, 0), x(i, 1), x(i, 2));
}

std::string corners(const Mesh& mesh, int e, int first) {
  std::ostringstream out;
  for (int i = 0; i < mesh.elements.cols(); ++i) out << (i ? " " : "") << mesh.elements(e, i) + first;
  return out.str();
}

/// The files of a mesh, by hand. Head of OFF: 2 lines; of OBJ: 1; of PLY: 9.
std::string off(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.nodes.rows() << " " << mesh.elements.rows() << " 0\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << row(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "3 " << corners(mesh, e, 0) << "\n";
  return out.str();
}

std::string obj(const Mesh& mesh) {
  std::ostringstream out;
  out << "# a comment\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << "v " << row(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "f " << corners(mesh, e, 1) << "\n";
  return out.str();
}

std::string ply_head(const Mesh& mesh, const std::string& kind) {
  std::ostringstream out;
  out << "ply\nformat " << kind << " 1.0\nelement vertex " << mesh.nodes.rows()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.elements.rows()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  return out.str();
}

std::string ply(const Mesh& mesh) {
  std::ostringstream out;
  out << ply_head(mesh, "ascii");
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << row(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "3 " << corners(mesh, e, 0) << "\n";
  return out.str();
}

template <class Value>
void put(std::string& out, Value value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply(const Mesh& mesh) {
  std::string out = ply_head(mesh, "binary_little_endian");
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    for (int j = 0; j < 3; ++j) put(out, mesh.nodes(i, j));
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    put(out, (unsigned char)3);
    for (int i = 0; i < 3; ++i) put(out, mesh.elements(e, i));
  }
  return out;
}

std::string stl(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid octahedron\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) out << "vertex " << row(mesh.nodes, mesh.elements(e, i)) << "\n";
    out << "endloop\nendfacet\n";
  }
  return out.str() + "endsolid octahedron\n";
}

std::string binary_stl(const Mesh& mesh) {
  std::string out(80, ' ');
  put(out, std::uint32_t(mesh.elements.rows()));
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    for (int j = 0; j < 3; ++j) put(out, 0.0f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) put(out, float(mesh.nodes(mesh.elements(e, i), j)));
    put(out, std::uint16_t(0));
  }
  return out;
}

/// As Gmsh 2.2 writes them: points and lines first, tags that are no positions.
std::string msh2(const Mesh& mesh) {
  const int type = mesh.degree == 1 ? 2 : 9;
  std::ostringstream out;
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"a "
         "surface\"\n$EndPhysicalNames\n$Nodes\n"
      << mesh.nodes.rows() << "\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << i + 11 << " " << row(mesh.nodes, i) << "\n";
  out << "$EndNodes\n$Elements\n" << mesh.elements.rows() + 2 << "\n1 15 2 0 1 11\n2 1 2 0 1 11 12\n";
  for (int e = 0; e < mesh.elements.rows(); ++e)
    out << e + 3 << " " << type << " 2 0 1 " << corners(mesh, e, 11) << "\n";
  return out.str() + "$EndElements\n";
}

/// As Gmsh 4.1 writes them: nodes in two blocks, points and lines first.
std::string msh4(const Mesh& mesh) {
  const int type = mesh.degree == 1 ? 2 : 9, n = int(mesh.nodes.rows());
  std::ostringstream out;
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 " << n << " 11 " << n + 10 << "\n0 1 0 1\n11\n"
      << row(mesh.nodes, 0) << "\n2 1 0 " << n - 1 << "\n";
  for (int i = 1; i < n; ++i) out << i + 11 << "\n";
  for (int i = 1; i < n; ++i) out << row(mesh.nodes, i) << "\n";
  const int count = int(mesh.elements.rows());
  out << "$EndNodes\n$Elements\n3 " << count + 2 << " 1 " << count + 2
      << "\n0 1 15 1\n1 11\n1 1 1 1\n2 11 12\n2 1 " << type << " " << count << "\n";
  for (int e = 0; e < count; ++e) out << e + 3 << " " << corners(mesh, e, 11) << "\n";
  return out.str() + "$EndElements\n";
}

struct Format {
  std::string extension;
  std::string (*write)(const Mesh&);
};
void PrintTo(const Format& format, std::ostream* out) {
  *out << format.extension;
}
const Format formats[] = {{"off", off}, {"obj", obj},        {"ply", ply},  {"ply", binary_ply},
                          {"stl", stl}, {"stl", binary_stl}, {"msh", msh2}, {"msh", msh4}};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

/// A curved mesh with numbers that need all digits.
Mesh curved_mesh(int degree) {
  Mesh mesh = lagrange_mesh(icosphere(1.0 / 3, 1), degree);
  mesh.nodes.rowwise().normalize();
  return mesh;
}

}  // namespace

class ReadFormat : public testing::TestWithParam<Format> {};
INSTANTIATE_TEST_SUITE_P(All, ReadFormat, testing::ValuesIn(formats),
                         [](const auto& info) { return info.param.extension + std::to_string(info.index); });

TEST_P(ReadFormat, GivesTheMeshBack) {
  const auto [extension, write] = GetParam();
  for (const Mesh& mesh : {octahedron(), icosphere(2, 1), torus_grid(2, 1, 6, 4)}) {
    const ReadMesh read = read_mesh(file_with(write(mesh), extension));
    EXPECT_EQ(read.remark, "");
    EXPECT_EQ(read.mesh.degree, 1);
    ASSERT_EQ(read.mesh.nodes.rows(), mesh.nodes.rows());
    ASSERT_EQ(read.mesh.elements.rows(), mesh.elements.rows());
    // STL has no nodes, only corners: its order is free; its binary form has single precision.
    if (extension != "stl") {
      EXPECT_EQ(read.mesh.nodes, mesh.nodes);
      EXPECT_EQ(read.mesh.elements, mesh.elements);
    }
    for (int e = 0; e < mesh.elements.rows(); ++e)
      for (int i = 0; i < 3; ++i)
        EXPECT_LT(
            (read.mesh.nodes.row(read.mesh.elements(e, i)) - mesh.nodes.row(mesh.elements(e, i))).norm(),
            1e-6);
  }
}

TEST_P(ReadFormat, SaysWhereTheSurfaceIsNotSound) {
  const auto [extension, write] = GetParam();
  const int first = extension == "msh" ? 3 : 1;  // number of the first triangle in the file
  const auto element = [&](int e) { return format("element %d (", e + first); };

  Mesh mesh = octahedron();
  mesh.elements.conservativeResize(7, 3);
  EXPECT_THAT(complaint(write(mesh), extension), AllOf(HasSubstr("element "), HasSubstr("not closed")));
  mesh = octahedron();
  std::swap(mesh.elements(5, 0), mesh.elements(5, 1));
  EXPECT_THAT(complaint(write(mesh), extension), AllOf(HasSubstr(element(5)), HasSubstr("oriented against")));
  mesh = octahedron();
  mesh.elements(3, 1) = mesh.elements(3, 0);
  EXPECT_THAT(complaint(write(mesh), extension), AllOf(HasSubstr(element(3)), HasSubstr("degenerate")));
  mesh = octahedron();
  mesh.elements.conservativeResize(9, 3);
  mesh.elements.row(8) = mesh.elements.row(2);
  EXPECT_THAT(complaint(write(mesh), extension),
              AllOf(HasSubstr(element(8)), HasSubstr("duplicate"), HasSubstr(element(2))));
  mesh = octahedron();
  mesh.nodes(4, 0) = NAN;
  EXPECT_THAT(complaint(write(mesh), extension), AllOf(HasSubstr("nan"), HasSubstr("finite")));
  mesh.nodes(4, 0) = INFINITY;
  EXPECT_THAT(complaint(write(mesh), extension), AllOf(HasSubstr("inf"), HasSubstr("finite")));
}

TEST_P(ReadFormat, TurnsAnInwardSurface) {
  const auto [extension, write] = GetParam();
  Mesh mesh = octahedron();
  mesh.nodes.col(2) *= -1;
  const ReadMesh read = read_mesh(file_with(write(mesh), extension));
  EXPECT_EQ(read.remark, "orientation was inward: turned");
  Mesh again = read.mesh;
  EXPECT_EQ(check_closed_surface(again, "again"), "");
}

TEST_P(ReadFormat, NoticesThatTheFileIsCutOff) {
  const auto [extension, write] = GetParam();
  const std::string text = write(octahedron());
  // The last newline may be missing, and in STL the name after endsolid.
  const std::size_t needed = std::min(text.size() - 1, text.find(" octahedron\n", 20));
  for (std::size_t size = 0; size < needed; ++size)
    EXPECT_NE(complaint(text.substr(0, size), extension), "") << "cut after " << size << " bytes";
}

TEST_P(ReadFormat, RefusesWhatIsNoMesh) {
  const std::string extension = GetParam().extension;
  EXPECT_THAT(complaint("", extension), HasSubstr("missing, empty"));
  EXPECT_NE(complaint("\n", extension), "");
  EXPECT_NE(complaint("<html>\nnot a mesh\n</html>\n", extension), "");
  EXPECT_NE(complaint(std::string(1000, '\0'), extension), "");
  EXPECT_NE(complaint(std::string(1000, '\xff'), extension), "");
}

TEST(ReadMesh, MissingFileOrUnknownFormat) {
  const auto message = [](const std::string& file) {
    try {
      read_mesh(file);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message("/nowhere/a.msh"), AllOf(HasSubstr("/nowhere/a.msh: "), HasSubstr("missing")));
  EXPECT_THAT(message("/nowhere/a.vtk"), AllOf(HasSubstr("a.vtk: "), HasSubstr("'vtk', .msh, .off, .obj")));
  EXPECT_THAT(message("/some.off/a"), HasSubstr("unknown mesh format ''"));
}

TEST(ReadMesh, ExtensionInCapitals) {
  EXPECT_EQ(complaint(off(octahedron()), "OFF"), "");
}

TEST(ReadMesh, WindowsLineEnds) {
  for (const Format& f : {formats[0], formats[1], formats[2], formats[4], formats[6], formats[7]}) {
    std::string text;
    for (char c : f.write(octahedron())) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(complaint(text, f.extension), "");
  }
}

TEST(ReadMesh, DropsNodesThatNoTriangleUses) {
  Mesh mesh = octahedron();
  mesh.nodes.conservativeResize(8, 3);
  mesh.nodes.row(6) = mesh.nodes.row(0);
  mesh.nodes.row(7) << 9, 9, 9;
  mesh.nodes.row(0).setZero();
  for (int& i : mesh.elements.reshaped())
    if (i == 0) i = 6;
  for (const auto& write : {off, obj, ply, msh2, msh4}) {
    const std::string extension = write == off ? "off" : write == obj ? "obj" : write == ply ? "ply" : "msh";
    const ReadMesh read = read_mesh(file_with(write(mesh), extension));
    EXPECT_EQ(read.remark, "2 nodes in no triangle: dropped");
    EXPECT_EQ(read.mesh.nodes, mesh.nodes.middleRows(1, 6));
  }
  // Errors have the file's numbers, not those after dropping.
  mesh.elements.conservativeResize(7, 3);
  EXPECT_THAT(complaint(off(mesh), "off"), HasSubstr("between node 4 (counted from 1) and node 6 "));
}

TEST(ReadObj, NamesLines) {
  Mesh mesh = octahedron();
  std::swap(mesh.elements(5, 0), mesh.elements(5, 1));
  EXPECT_THAT(complaint(obj(mesh), "obj"), HasSubstr("element 6 (line 13)"));
  EXPECT_THAT(complaint(replaced(obj(octahedron()), "v 0 1 0", "v 0 1"), "obj"), HasSubstr("near line 3"));
  EXPECT_THAT(complaint(replaced(obj(octahedron()), "f 2 3 5", "f 2/1/1 3/1/1 5/1/1"), "obj"), "");
  EXPECT_THAT(complaint(replaced(obj(octahedron()), "f 2 3 5", "f 2 3 0"), "obj"), HasSubstr("out of range"));
}

TEST(ReadPolygons, OtherThanTriangles) {
  EXPECT_THAT(complaint(replaced(off(octahedron()), "3 1 2 4", "4 1 2 4 5"), "off"),
              AllOf(HasSubstr("element 2 "), HasSubstr("4 corners, a triangle expected")));
  EXPECT_THAT(complaint(replaced(obj(octahedron()), "f 2 3 5", "f 2 3 5 6"), "obj"),
              AllOf(HasSubstr("element 2 (line 9)"), HasSubstr("4 corners, a triangle expected")));
  EXPECT_THAT(complaint(replaced(ply(octahedron()), "3 1 2 4", "4 1 2 4 5"), "ply"),
              AllOf(HasSubstr("element 2 "), HasSubstr("4 corners, a triangle expected")));
}

TEST(ReadPolygons, NameTheLineOfABadNumber) {
  EXPECT_THAT(complaint(replaced(off(octahedron()), "3 1 2 4", "999999999999999 1 2 4"), "off"),
              HasSubstr("near line 10"));
  EXPECT_THAT(complaint(replaced(off(octahedron()), "0 1 0", "0 nan 0"), "off"),
              HasSubstr("line 4: coordinate 'nan'"));
  EXPECT_THAT(complaint(replaced(stl(octahedron()), "1 0 0", "inf 0 0"), "stl"),
              HasSubstr("line 4: coordinate 'inf'"));
  EXPECT_THAT(complaint(replaced(off(octahedron()), "0 1 0", "0 one 0"), "off"), HasSubstr("near line 4"));
  EXPECT_THAT(complaint(replaced(off(octahedron()), "3 1 2 4", "3 1 2 6"), "off"), HasSubstr("near line 10"));
  EXPECT_THAT(complaint(replaced(off(octahedron()), "6 8 0", "600000000 8 0"), "off"),
              HasSubstr("line 2: 600000000"));
}

class ReadMsh : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, ReadMsh, testing::Values(1, 2));

TEST_P(ReadMsh, KeepsCurvedNodesAndTheirOrder) {
  const Mesh mesh = curved_mesh(GetParam());
  for (const auto& write : {msh2, msh4}) {
    const ReadMesh read = read_mesh(file_with(write(mesh), "msh"));
    EXPECT_EQ(read.mesh.degree, GetParam());
    EXPECT_EQ(read.mesh.nodes, mesh.nodes);
    EXPECT_EQ(read.mesh.elements, mesh.elements);
  }
}

TEST_P(ReadMsh, ReadsWhatIsWritten) {
  const Mesh mesh = curved_mesh(GetParam());
  const std::string path = file_with("", "msh");
  write_msh(mesh, path);
  const ReadMesh read = read_mesh(path);
  EXPECT_EQ(read.remark, "");
  EXPECT_EQ(read.mesh.degree, GetParam());
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.elements, mesh.elements);
}

TEST(WriteMsh, RefusesHighDegreesAndBadPlaces) {
  EXPECT_THROW(write_msh(curved_mesh(3), file_with("", "msh")), InputError);
  EXPECT_THROW(write_msh(octahedron(), "/nowhere/a.msh"), InputError);
}

}  // namespace esfem::test_read
