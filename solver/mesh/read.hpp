// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "solver/mesh/mesh.hpp"

namespace esfem {

struct ReadMesh {
  Mesh mesh;           ///< degree 1, or 2 when the file has 6-node triangles; the file's node order
  std::string remark;  ///< empty, or what was changed ("orientation was inward: turned")
};

/// Reads a closed triangulated surface: Gmsh MSH 2.2 and 4.1 (.msh; 3- and 6-node triangles, curved nodes
/// kept), OFF, OBJ, PLY, STL. Throws InputError, one line that names the file, the line or element, and what
/// was expected, for a file that is missing, cut off, not closed, not connected, non-manifold, inconsistently
/// oriented, with NaN, with degenerate or duplicate triangles, or with other elements. Nodes and elements
/// have the file's own numbers in errors (MSH) or are counted from 1. Points and lines of MSH files are
/// skipped; nodes in no triangle are dropped, and the remark says so.
ReadMesh read_mesh(const std::string& file);

/// The checks of `read_mesh` on a mesh of any degree that comes from elsewhere; `source` names it in errors.
/// Turns an inward orientation and returns the remark, "" when nothing was changed. A node in no element is
/// an error here.
std::string check_closed_surface(Mesh& mesh, const std::string& source);

/// Writes a mesh of degree 1 or 2 as Gmsh MSH 4.1 (ASCII, 17 digits: reading it gives the same bits).
/// Throws InputError for a higher degree or when the file cannot be written.
void write_msh(const Mesh& mesh, const std::string& file);

}  // namespace esfem
