// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Meshes that would have more are refused.
constexpr double most_nodes = 1e8;

/// About how many nodes a mesh of degree 1 has with edges of this length, or fewer.
double nodes_at_most(const Surface& surface, double edge_length);

/// Unstructured quasi-uniform triangulation (degree 1, outward) of a surface whose largest edge is
/// edge_length within 15%: a Delaunay surface mesh by CGAL, then the force relaxation of DistMesh (Persson &
/// Strang, SIAM Review 46, 2004) with edge flips and projection onto the surface. Deterministic to the bit.
/// Every angle >= 25 degrees, mean radius ratio >= 0.94; vertices along a Hilbert curve. Throws InputError
/// when edge_length is not positive or does not resolve the surface (edge_length >
/// smallest_curvature_radius), NumericsError when the promised quality is missed.
Mesh generate_mesh(const Surface& surface, double edge_length);

/// The same with a size function (edge length wanted near a point of the surface; the largest edges there get
/// it), for graded meshes. It must be positive, vary smoothly (a jump costs quality), and resolve the surface
/// where it is evaluated: at most the local radius of curvature. Every angle >= 20 degrees, no edge more
/// than 1.25 times the one asked for.
Mesh generate_mesh(const Surface& surface, const std::function<double(const Vec3&)>& edge_length);

/// The same, graded by curvature: edges of length h, 1/h² = 1/edge_length² + (kappa_1² + kappa_2²)/grading²,
/// which is edge_length where the surface is flat, and at most grading times the radius of curvature; and
/// that grows by at most a quarter of the distance on the surface. Throws InputError unless 0 < grading <= 1.
Mesh generate_mesh(const Surface& surface, double edge_length, double grading);

}  // namespace esfem
