// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Edge length wanted at a point (near the surface).
using SizeFunction = std::function<double(const Vec3&)>;

/// Restricted Delaunay triangulation of the surface by CGAL's Delaunay refinement (Boissonnat & Oudot,
/// Graphical Models 67, 2005), so dense that after a relaxation the largest edges have the length `size`.
/// Nodes lie on the surface, triangles are oriented outward; whether it is closed and has the right topology
/// is left to the caller. The same arguments give the same bits, in every process and after any calls.
Mesh delaunay_surface_mesh(const Surface& surface, const SizeFunction& size);

/// The number of the node that is closest to a point.
std::function<int(const Vec3&)> closest_node(const Field& nodes);

/// The nodes' numbers in the order of a Hilbert curve: neighbours in space become neighbours in memory.
std::vector<std::size_t> hilbert_order(const Field& nodes);

}  // namespace esfem
