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
#include "tests/mesh/mesh_files.hpp"

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

/// As Gmsh 2.2 writes them: points and lines first, tags that are no positions.
std::string msh2(const Mesh& mesh) {
  const int type = mesh.degree == 1 ? 2 : 9;
  std::ostringstream out;
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"a "
         "surface\"\n$EndPhysicalNames\n$Nodes\n"
      << mesh.nodes.rows() << "\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << i + 11 << " " << coordinates(mesh.nodes, i) << "\n";
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
      << coordinates(mesh.nodes, 0) << "\n2 1 0 " << n - 1 << "\n";
  for (int i = 1; i < n; ++i) out << i + 11 << "\n";
  for (int i = 1; i < n; ++i) out << coordinates(mesh.nodes, i) << "\n";
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

TEST_P(ReadFormat, TurnsElements) {
  const auto [extension, write] = GetParam();
  Mesh mesh = octahedron();
  std::swap(mesh.elements(5, 0), mesh.elements(5, 1));
  const ReadMesh read = read_mesh(file_with(write(mesh), extension));
  EXPECT_EQ(read.remark, "1 element oriented against the others: turned");
  EXPECT_TRUE(closed_and_oriented(read.mesh));
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
  EXPECT_THAT(complaint(off(mesh), "off"),
              AllOf(HasSubstr("between node 4 (line 6) at (0, -1, 0) and node 7 (line 9) at (1, 0, 0)"),
                    HasSubstr("(before: 2 nodes in no triangle: dropped)")));
}

TEST(ReadMesh, SaysWhereASurfaceIsOpen) {
  // Without two opposite triangles; one of the holes is the larger one.
  Mesh mesh = octahedron();
  for (double& x : mesh.nodes.reshaped())
    if (x > 0.5) x = 2;
  std::vector<int> kept;
  for (int e = 0; e < 8; ++e) {
    Vec3 sum = Vec3::Zero();
    for (int i : mesh.elements.row(e)) sum += mesh.nodes.row(i);
    if (std::abs(sum.array().sign().sum()) != 3) kept.push_back(e);
  }
  mesh.elements = mesh.elements(kept, Eigen::all).eval();
  EXPECT_THAT(complaint(obj(mesh), "obj"),
              AllOf(HasSubstr(": not closed, 2 boundary loops; the longest has 3 edges, length 8.48528"),
                    HasSubstr("node 2 (line 3) at (0, 2, 0)"), HasSubstr("a closed surface expected")));
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

TEST(WriteMsh, RefusesBadPlaces) {
  EXPECT_THROW(write_msh(octahedron(), "/nowhere/a.msh"), InputError);
}

}  // namespace esfem::test_read
