// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Where a mesh comes from, so that errors can name its nodes and elements as their author knows them.
struct MeshOrigin {
  std::string source;  ///< file name
  /// The file's own numbers and lines; empty when the file has none: then the 1-based position is the number.
  std::vector<long> node_tags, element_tags;
  std::vector<int> node_lines, element_lines;

  /// "node 7 (line 12)", or "node 7 (counted from 1)" when the lines are not known.
  std::string node(int i) const;
  std::string element(int e) const;
};

/// A mesh as its file has it, before any check of the surface.
struct MeshFile {
  Mesh mesh;
  MeshOrigin origin;
};

/// Reads the text of a Gmsh file, MSH 2.2 or 4.1 (ASCII).
MeshFile parse_msh(const std::string& file, const std::string& text);

/// Reads the content of an OFF, OBJ, PLY or STL file by CGAL; extension is one of off, obj, ply, stl.
MeshFile parse_polygon_soup(const std::string& file, const std::string& content,
                            const std::string& extension);

/// Throws InputError unless the mesh is one closed, manifold, consistently oriented surface of sound
/// elements. Turns an inward orientation; returns whether it did.
bool check_closed_surface(Mesh& mesh, const MeshOrigin& origin);

}  // namespace esfem
