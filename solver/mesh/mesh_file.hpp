// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/mesh/mesh.hpp"
#include "solver/mesh/origin.hpp"
#include "solver/mesh/write_vtu.hpp"

namespace esfem {

/// Gives n nodes or elements without numbers their positions as numbers: before one is dropped or added.
void number_by_position(std::vector<long>& tags, long n);

/// A mesh as its file has it, before any check of the surface; elements name nodes that exist.
struct MeshFile {
  Mesh mesh;                              ///< not checked, not oriented yet
  MeshOrigin origin;                      ///< names its nodes and elements
  std::vector<std::string> remarks = {};  ///< what the reader changed
  NodalFields fields = {};                ///< nodal values that the file has; nan where it has none
  std::optional<double> t = {};           ///< the time, where the file says it
};

/// Reads the content of a Gmsh file, MSH 2.2 or 4.1, ASCII or binary.
MeshFile parse_msh(const std::string& file, const std::string& text);

/// Reads the content of a VTU file of write_vtu.
MeshFile parse_vtu(const std::string& file, const std::string& content);

/// Read the content of a file: OFF of Geomview (ASCII and binary), Wavefront OBJ, PLY (ASCII and binary), STL
/// (ASCII and binary). Polygons are cut into triangles. Throw InputError that names the file, and the line,
/// byte or element.
/// @{
MeshFile parse_off(const std::string& file, const std::string& content);
MeshFile parse_obj(const std::string& file, const std::string& content);
MeshFile parse_ply(const std::string& file, const std::string& content);
MeshFile parse_stl(const std::string& file, const std::string& content);
/// @}

/// `repair`, then `check_closed_surface`; returns all remarks in one line. What was changed before an error
/// is said there, too.
std::string repair_and_check(MeshFile& file);

/// Throws InputError unless the mesh is a closed, manifold surface of sound elements, with one or several
/// components. Turns elements as `orient` does; returns the remark on it.
std::string check_closed_surface(Mesh& mesh, const MeshOrigin& origin);

}  // namespace esfem
