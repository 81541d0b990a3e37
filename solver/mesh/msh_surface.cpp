// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/msh_elements.hpp"
#include "solver/mesh/polygons.hpp"

namespace esfem {

namespace {

/// A triangle with curved edges or a plane quadrangle, by nodes counted from 0.
struct Piece {
  std::vector<int> nodes;
  int corners, order;
  const char* type;  ///< name of the element type that it comes from
  long tag;
  int line;
};

std::string place(const Msh& msh, long tag, int line) {
  return msh.file + format(": element %ld", tag) + (line > 0 ? format(" (line %d)", line) : "");
}

std::vector<int> nodes_of(const Msh& msh, const MshElement& element) {
  std::vector<int> nodes;
  for (int i = 0; i < element.type->nodes; ++i) {
    const long tag = msh.element_nodes[element.first + i];
    const auto node = msh.node_of_tag.find(tag);
    if (node == msh.node_of_tag.end())
      throw InputError(place(msh, element.tag, element.line) +
                       format(": node %ld is not in $Nodes, a node of the file expected", tag));
    nodes.push_back(node->second);
  }
  return nodes;
}

Vec3 position(const Msh& msh, int node) {
  return Eigen::Map<const Vec3>(msh.coordinates.data() + 3 * node);
}

/// The corners as they are, whatever the first one and the direction.
using FaceKey = std::array<int, 4>;

FaceKey key_of(const Piece& piece) {
  FaceKey key = {-1, -1, -1, -1};
  std::copy_n(piece.nodes.begin(), piece.corners, key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

void reverse(Piece& face) {
  const std::vector<int> old = face.nodes;
  const std::vector<int> from = face.corners == 4 ? std::vector<int>{0, 3, 2, 1}
                                : face.order == 2 ? std::vector<int>{0, 2, 1, 5, 4, 3}
                                                  : std::vector<int>{0, 2, 1};
  for (std::size_t i = 0; i < from.size(); ++i) face.nodes[i] = old[from[i]];
}

/// The faces of a volume element, outward.
std::vector<Piece> faces_of(const Msh& msh, const MshElement& element) {
  const std::vector<int> nodes = nodes_of(msh, element);
  const MshElementType& type = *element.type;
  std::vector<Piece> faces;
  double volume = 0;  // its sign says how the file orders the nodes
  const Vec3 origin = position(msh, nodes[0]);
  for (const std::vector<int>& local : type.faces) {
    Piece face{{}, local.size() == 4 ? 4 : 3, type.order, type.name, element.tag, element.line};
    for (int i : local) face.nodes.push_back(nodes[i]);
    const Vec3 a = position(msh, face.nodes[0]) - origin;
    for (int i = 2; i < face.corners; ++i)
      volume +=
          a.dot((position(msh, face.nodes[i - 1]) - origin).cross(position(msh, face.nodes[i]) - origin));
    faces.push_back(std::move(face));
  }
  if (volume < 0)
    for (Piece& face : faces) reverse(face);
  return faces;
}

/// The faces that belong to one volume element only, in the order of these elements.
std::vector<Piece> boundary_faces(const Msh& msh) {
  std::vector<Piece> faces;
  for (const MshElement& element : msh.elements)
    if (element.type->dimension == 3)
      for (Piece& face : faces_of(msh, element)) faces.push_back(std::move(face));
  std::map<FaceKey, int> seen;
  for (const Piece& face : faces) ++seen[key_of(face)];
  std::vector<Piece> boundary;
  for (Piece& face : faces)
    if (seen[key_of(face)] == 1) boundary.push_back(std::move(face));
  return boundary;
}

std::vector<Piece> surface_elements(const Msh& msh) {
  std::vector<Piece> pieces;
  for (const MshElement& element : msh.elements) {
    const MshElementType& type = *element.type;
    if (type.dimension == 2)
      pieces.push_back(
          {nodes_of(msh, element), type.corners(), type.order, type.name, element.tag, element.line});
  }
  return pieces;
}

/// Gives the faces the order and the numbers of the file's surface elements. False, and nothing is changed,
/// unless these are the same.
bool take_numbers(std::vector<Piece>& faces, const std::vector<Piece>& surface) {
  if (faces.size() != surface.size()) return false;
  std::map<FaceKey, int> face_of;
  for (std::size_t i = 0; i < faces.size(); ++i) face_of[key_of(faces[i])] = int(i);
  std::vector<Piece> numbered;
  for (const Piece& piece : surface) {
    const auto found = face_of.find(key_of(piece));
    if (found == face_of.end()) return false;
    numbered.push_back(faces[found->second]);
    numbered.back().tag = piece.tag;
    numbered.back().line = piece.line;
    face_of.erase(found);
  }
  faces = std::move(numbered);
  return true;
}

/// MSH 2.2 has an element of several physical groups once for each. Keeps the first; returns how many were
/// dropped.
int drop_repeated_elements(Msh& msh) {
  std::map<std::vector<long>, long> group_of;
  std::vector<MshElement> kept;
  for (const MshElement& element : msh.elements) {
    const auto first = msh.element_nodes.begin() + std::ptrdiff_t(element.first);
    const auto [known, is_new] = group_of.try_emplace({first, first + element.type->nodes}, element.group);
    if (is_new || known->second == element.group) kept.push_back(element);
  }
  const int dropped = int(msh.elements.size() - kept.size());
  msh.elements = std::move(kept);
  return dropped;
}

/// The surface's elements, and what was made of the file's.
std::vector<Piece> pieces_of(const Msh& msh, std::vector<std::string>& remarks) {
  std::vector<Piece> surface = surface_elements(msh);
  const auto volumes = std::count_if(msh.elements.begin(), msh.elements.end(),
                                     [](const MshElement& element) { return element.type->dimension == 3; });
  if (volumes == 0) return surface;
  std::vector<Piece> boundary = boundary_faces(msh);
  if (!take_numbers(boundary, surface))
    remarks.push_back(
        format("the boundary of %td volume elements, %zu faces, is the surface", volumes, boundary.size()));
  return boundary;
}

/// Triangles and quadrangles of order 1.
MeshFile plane_surface(const Msh& msh, const std::vector<Piece>& pieces) {
  Polygons polygons;
  polygons.origin.source = msh.file;
  for (int i = 0; i < int(msh.node_tags.size()); ++i) polygons.points.push_back(position(msh, i));
  for (const Piece& piece : pieces) {
    polygons.corners.insert(polygons.corners.end(), piece.nodes.begin(), piece.nodes.end());
    polygons.sizes.push_back(piece.corners);
    polygons.origin.element_tags.push_back(piece.tag);
    if (piece.line > 0) polygons.origin.element_lines.push_back(piece.line);
  }
  return triangulated(std::move(polygons));
}

/// Triangles of a higher order.
MeshFile curved_surface(const Msh& msh, const std::vector<Piece>& pieces) {
  MeshFile result;
  result.origin.source = msh.file;
  result.mesh.degree = pieces.front().order;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  result.mesh.nodes = Eigen::Map<const Rows>(msh.coordinates.data(), msh.coordinates.size() / 3, 3);
  result.mesh.elements.resize(pieces.size(), nodes_per_element(result.mesh.degree));
  for (std::size_t e = 0; e < pieces.size(); ++e) {
    const Piece& piece = pieces[e];
    for (std::size_t i = 0; i < piece.nodes.size(); ++i) result.mesh.elements(e, i) = piece.nodes[i];
    result.origin.element_tags.push_back(piece.tag);
    if (piece.line > 0) result.origin.element_lines.push_back(piece.line);
  }
  return result;
}

/// The scalars and vectors of the sections $NodeData; nan at nodes that have no value there.
NodalFields fields_of(const Msh& msh) {
  const Eigen::Index n = Eigen::Index(msh.node_tags.size());
  NodalFields fields;
  for (const MshNodeData& data : msh.node_data) {
    if (data.components != 1 && data.components != 3) continue;
    Field values = Field::Constant(n, data.components, NAN);
    for (std::size_t i = 0; i < data.nodes.size(); ++i) {
      const auto node = msh.node_of_tag.find(data.nodes[i]);
      if (node == msh.node_of_tag.end())
        throw InputError(format("%s: $NodeData '%s': node %ld is not in $Nodes, a node of the file expected",
                                msh.file.c_str(), data.name.c_str(), data.nodes[i]));
      for (int j = 0; j < data.components; ++j)
        values(node->second, j) = data.values[i * data.components + j];
    }
    const auto same_name = [&](const NodalField& field) { return field.name == data.name; };
    // A section for each time step: the last one counts.
    fields.erase(std::remove_if(fields.begin(), fields.end(), same_name), fields.end());
    fields.push_back({data.name, std::move(values)});
  }
  return fields;
}

}  // namespace

MeshFile msh_surface(Msh&& msh) {
  std::vector<std::string> remarks;
  if (const int dropped = drop_repeated_elements(msh))
    remarks.push_back(
        format("%d element%s of several physical groups: taken once", dropped, dropped > 1 ? "s" : ""));
  const std::vector<Piece> pieces = pieces_of(msh, remarks);
  if (pieces.empty())
    throw InputError(msh.file +
                     ": no triangle, 4-node quadrangle or volume element in the file, at least one expected");
  const Piece& first = pieces.front();
  for (const Piece& piece : pieces)
    if (piece.order != first.order)
      throw InputError(place(msh, piece.tag, piece.line) +
                       format(": a %s after a %s, elements of one order expected", piece.type, first.type));

  MeshFile result = first.order == 1 ? plane_surface(msh, pieces) : curved_surface(msh, pieces);
  result.remarks.insert(result.remarks.begin(), remarks.begin(), remarks.end());
  result.fields = fields_of(msh);
  result.origin.node_tags = msh.node_tags;
  result.origin.node_lines = msh.node_lines;
  result.origin.own_numbers = true;
  return result;
}

}  // namespace esfem
