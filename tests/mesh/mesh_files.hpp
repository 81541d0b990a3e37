// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files as other programs write them, made from a mesh by hand.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/read.hpp"
#include "tests/mesh/topology.hpp"

namespace esfem {

inline std::string coordinates(const Field& x, int i) {
  return format("%.17g %.17g %.17g", x(i, 0), x(i, 1), x(i, 2));
}

inline std::string corners(const Mesh& mesh, int e, int first) {
  std::ostringstream out;
  for (int i = 0; i < mesh.elements.cols(); ++i) out << (i ? " " : "") << mesh.elements(e, i) + first;
  return out.str();
}

/// The head has 2 lines.
inline std::string off(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.nodes.rows() << " " << mesh.elements.rows() << " 0\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << coordinates(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "3 " << corners(mesh, e, 0) << "\n";
  return out.str();
}

/// The head has 1 line.
inline std::string obj(const Mesh& mesh) {
  std::ostringstream out;
  out << "# a comment\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << "v " << coordinates(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "f " << corners(mesh, e, 1) << "\n";
  return out.str();
}

inline std::string ply_head(const Mesh& mesh, const std::string& kind) {
  std::ostringstream out;
  out << "ply\nformat " << kind << " 1.0\nelement vertex " << mesh.nodes.rows()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.elements.rows()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  return out.str();
}

/// The head has 9 lines.
inline std::string ply(const Mesh& mesh) {
  std::ostringstream out;
  out << ply_head(mesh, "ascii");
  for (int i = 0; i < mesh.nodes.rows(); ++i) out << coordinates(mesh.nodes, i) << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) out << "3 " << corners(mesh, e, 0) << "\n";
  return out.str();
}

/// Appends the bytes of a number; swapped: the highest first (tests run where the lowest comes first).
template <class Value>
void put(std::string& out, Value value, bool swapped = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  out += bytes;
}

inline std::string binary_ply(const Mesh& mesh) {
  std::string out = ply_head(mesh, "binary_little_endian");
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    for (int j = 0; j < 3; ++j) put(out, mesh.nodes(i, j));
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    put(out, std::uint8_t(3));
    for (int i = 0; i < 3; ++i) put(out, mesh.elements(e, i));
  }
  return out;
}

/// Each triangle has 7 lines, after 1 line.
inline std::string stl(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid octahedron\n";
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) out << "vertex " << coordinates(mesh.nodes, mesh.elements(e, i)) << "\n";
    out << "endloop\nendfacet\n";
  }
  return out.str() + "endsolid octahedron\n";
}

inline std::string binary_stl_with_head(const Mesh& mesh, std::string head) {
  head.resize(80, ' ');
  put(head, std::uint32_t(mesh.elements.rows()));
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    for (int j = 0; j < 3; ++j) put(head, 0.0f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) put(head, float(mesh.nodes(mesh.elements(e, i), j)));
    put(head, std::uint16_t(0));
  }
  return head;
}

inline std::string binary_stl(const Mesh& mesh) {
  return binary_stl_with_head(mesh, "");
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

inline std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

inline double corner_area(const Mesh& mesh) {
  double area = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

/// An ellipsoid of 42 nodes and 80 triangles with 6 digits: area and volume computed independently of this
/// program.
inline Mesh small_ellipsoid() {
  Mesh mesh = icosphere(1, 1);
  mesh.nodes *= Vec3(1, 0.8, 0.6).asDiagonal();
  mesh.nodes.rowwise() += Eigen::RowVector3d(0.1, -0.2, 0.3);
  mesh.nodes = (mesh.nodes.array() * 1e6).round() / 1e6;
  return mesh;
}
constexpr double small_ellipsoid_area = 7.4061852042333047, small_ellipsoid_volume = 1.756182145028448;

/// Nodes of its own for each element.
inline Mesh triangle_soup(const Mesh& mesh) {
  Mesh soup;
  soup.nodes = mesh.nodes(std::vector<int>(mesh.elements.data(), mesh.elements.data() + mesh.elements.size()),
                          Eigen::all);
  soup.elements.resize(mesh.elements.rows(), 3);
  for (int i = 0; i < soup.elements.size(); ++i) soup.elements(i / 3, i % 3) = i;
  return soup;
}

/// Both surfaces in one mesh.
inline Mesh together(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  mesh.nodes.conservativeResize(a.nodes.rows() + b.nodes.rows(), 3);
  mesh.nodes.bottomRows(b.nodes.rows()) = b.nodes;
  mesh.elements.conservativeResize(a.elements.rows() + b.elements.rows(), a.elements.cols());
  mesh.elements.bottomRows(b.elements.rows()) = b.elements.array() + int(a.nodes.rows());
  return mesh;
}

/// The complaint of a parser about a text, or about the surface after repairs; "" when all is
/// well.
/// The error that a mesh gives, or "" when it is accepted.
inline std::string check_complaint(Mesh mesh) {
  try {
    check_closed_surface(mesh, "here");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

inline std::string complaint_of(MeshFile (*parse)(const std::string&, const std::string&),
                                const std::string& text) {
  try {
    MeshFile file = parse("a", text);
    repair_and_check(file);
    return "";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
}

/// The text is a small_ellipsoid; `tolerance` is relative. Returns the remark.
inline std::string expect_small_ellipsoid(MeshFile (*parse)(const std::string&, const std::string&),
                                          const std::string& text, double tolerance = 1e-14) {
  try {
    MeshFile file = parse("a", text);
    const std::string remark = repair_and_check(file);
    EXPECT_EQ(file.mesh.nodes.rows(), 42);
    EXPECT_EQ(file.mesh.elements.rows(), 80);
    EXPECT_NEAR(corner_area(file.mesh) / small_ellipsoid_area, 1, tolerance);
    EXPECT_NEAR(enclosed_volume(file.mesh) / small_ellipsoid_volume, 1, tolerance);
    return remark;
  } catch (const InputError& error) {
    ADD_FAILURE() << error.what();
    return error.what();
  }
}

}  // namespace esfem
