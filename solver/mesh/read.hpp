// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/mesh/mesh.hpp"
#include "solver/mesh/origin.hpp"
#include "solver/mesh/write_vtu.hpp"

namespace esfem {

/// What read_mesh finds in a file.
struct ReadMesh {
  Mesh mesh;                       ///< of the degree of the file's elements; the file's node order
  std::string remark;              ///< empty, or what was changed ("orientation was inward: turned")
  NodalFields fields;              ///< nodal values that the file has; nan where it has none
  std::vector<long> node_numbers;  ///< the file's own (tags, or counted from 1); empty when they are 1, 2, ..
  MeshOrigin origin;               ///< names its elements
  std::optional<double> t;         ///< the time of a snapshot of write_vtu
};

/// Reads a closed triangulated surface of one or several components: Gmsh MSH 2.2 and 4.1, ASCII
/// and binary (.msh; triangles of degree 1 to 4, curved nodes kept, 4-node quadrangles, or the boundary of
/// volume elements), the snapshots of write_vtu (.vtu), OFF, OBJ, PLY, STL. Defects with an unambiguous
/// repair are repaired, and the remark lists them: polygons are cut into triangles, nodes in no triangle are
/// dropped, nodes in one place along open sides are joined, elements with two equal corners are dropped,
/// those with corners on a line are flipped, nodes where the surface touches itself are doubled (`repair`),
/// elements are oriented alike and outward (`orient`). Throws InputError, one line that names the file, the
/// line or element, and what was expected, for a file that is missing, cut off or not of its format, and for
/// a surface that is not closed, non-manifold, not orientable, pressed flat, or has NaN, degenerate or
/// duplicate triangles, or other elements. Nodes and elements have the file's own numbers in errors (MSH) or
/// are counted from 1. Points and lines of MSH files are skipped.
ReadMesh read_mesh(const std::string& file);

/// The checks of `read_mesh` on a mesh of any degree that comes from elsewhere, without its repairs; `source`
/// names it in errors. Turns elements as `orient` does and returns the remark, "" when nothing was changed. A
/// node in no element is an error here.
std::string check_closed_surface(Mesh& mesh, const std::string& source);

/// Writes a mesh of degree 1..4 as Gmsh MSH 4.1 (ASCII, 17 digits: reading it gives the same bits). Throws
/// InputError when the file cannot be written.
void write_msh(const Mesh& mesh, const std::string& file);

}  // namespace esfem
