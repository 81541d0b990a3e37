// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/delaunay.hpp"

namespace esfem {

/// Moves the nodes of a closed triangulation along the surface until its edges are in equilibrium, and flips
/// edges so that it stays Delaunay: DistMesh (Persson & Strang, SIAM Review 46, 2004). Edges become
/// proportional to `size`; the number of nodes decides their length. Afterwards the nodes lie on the surface
/// to round-off.
void relax(Mesh& mesh, const Surface& surface, const SizeFunction& size);

}  // namespace esfem
