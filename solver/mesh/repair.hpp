// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh_file.hpp"

namespace esfem {

/// Repairs common defects of scans and CAD parts, and adds a remark for each repair:
/// - Nodes that no element uses are dropped.
/// - Nodes on open sides (of one element only) are joined when they are equal; if sides are open after that,
///   when they are within 1e-6 of the diagonal of the bounding box, and within a quarter of the shortest edge
///   at either of them: so no triangle loses an edge, however fine the mesh is, and nothing changes where the
///   surface is closed.
/// - Elements with two equal corners are dropped.
/// - Elements with three corners on a line are flipped with their neighbour (`flip_flat_elements`).
/// - Nodes where the surface touches itself are doubled (`split_touching_nodes`).
/// The result is checked by `check_closed_surface`.
void repair(MeshFile& file);

}  // namespace esfem
