// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Grid on the surface that a closed profile sweeps around the x3 axis: the points (distance from the axis,
/// x3) of `profile`, counterclockwise, at n_around angles. Every cell is cut into two triangles along
/// alternating diagonals where that is possible. Throws InputError unless there are at least 3 x 3 cells.
Mesh profile_grid(const Eigen::Matrix2Xd& profile, int n_around);

/// The self-shrinking torus (surfaces/angenent_torus.hpp) with n_profile points at equal distances of
/// arclength.
Mesh angenent_torus_grid(int n_around, int n_profile);
/// A size function for its unstructured meshes: `largest` at the outer equator, half of it at the inner. It
/// resolves the surface whenever largest <= 0.7.
std::function<double(const Vec3&)> angenent_torus_edge_length(double largest);

}  // namespace esfem
