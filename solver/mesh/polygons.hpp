// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/mesh/mesh_file.hpp"

namespace esfem {

/// What OFF, OBJ, PLY and STL files hold: points and polygons between them.
struct Polygons {
  std::vector<Vec3> points;   ///< in the order of the file
  std::vector<long> corners;  ///< of all polygons, one after the other: the file's numbers of its points
  std::vector<int> sizes;     ///< how many corners each polygon has
  long first = 0;             ///< the file's number of its first point
  MeshOrigin origin;          ///< source, lines and, where they are not positions, numbers
  NodalFields fields = {};    ///< values of the points
};

/// The triangles of the polygons, degree 1, in their order; quadrangles are cut along the diagonal that gives
/// the better triangles, larger polygons by the constrained Delaunay triangulation of their projection onto
/// the plane of their mean normal. Corners of one polygon in one place make triangles with two equal corners.
/// Triangles have the number of their polygon in errors. Throws InputError for a corner that does not exist,
/// fewer than 3 corners, and a polygon that crosses or touches itself.
MeshFile triangulated(Polygons&& polygons);

}  // namespace esfem
