// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh_file.hpp"

namespace esfem {

/// Whether the corner triangle of an element is too thin to compute with: area <= 1e-10 (longest edge)².
/// Round-off of three corners on a line is near 1e-16.
bool has_no_area(const Mesh& mesh, int element);

/// Gives an element of degree 1 whose corners lie on a line its share of the neighbour along its longest
/// edge: the two exchange their common edge for the other diagonal, which does not change the surface. CAD
/// programs write such elements where a corner lies on an edge. Adds a remark when it did.
void flip_flat_elements(MeshFile& file);

/// Where a closed surface touches itself at a node, every fan of elements gets a node of its own there. Does
/// nothing when an edge has not two elements. Adds a remark when it did.
void split_touching_nodes(MeshFile& file);

}  // namespace esfem
