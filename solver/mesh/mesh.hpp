// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "solver/surfaces/surface.hpp"
#include "solver/types.hpp"

namespace esfem {

/// A closed triangulated surface whose elements are images of the reference triangle under P_k maps.
struct Mesh {
  int degree = 1;         ///< k of the element maps, 1..4
  Field nodes;            ///< N x 3
  Connectivity elements;  ///< E x (k+1)(k+2)/2, node order of fe/lagrange.hpp, outward orientation
};

/// The P_k mesh with the same element maps as the given one (nodes at the reference nodes of degree k, not
/// projected onto any surface). Nodes that both have come first, in the order of the given mesh: the corners,
/// and all nodes from degree 2 to 4. The others follow where an element first touches them. The same degree
/// gives the mesh unchanged. A lower degree keeps the positions of its nodes, not the maps. Throws InputError
/// unless 1 <= degree <= 4.
Mesh lagrange_mesh(const Mesh& mesh, int degree);

/// Nodal values (N x m) on a mesh as nodal values on `refined`, its lagrange_mesh of any degree.
Field lagrange_values(const Mesh& mesh, const Field& values, const Mesh& refined);

/// The corner triangles as a P1 mesh; keeps the corners' order, drops the other nodes.
Mesh corner_mesh(const Mesh& mesh);

/// The P1 mesh with every triangle cut into four through the middle nodes of its edges (of the P2 mesh with
/// the same element maps). The four stay together in the element order.
Mesh subdivide(const Mesh& mesh);

/// Moves every node to its closest point on the surface: afterwards |d| is at round-off. Throws InputError
/// with the node's number (from 1) when a node is further away than half the mesh's largest edge.
void project_nodes(Mesh& mesh, const Surface& surface);

/// Shape of the triangles between the corners (straight edges), at positions x (N x 3). Degenerate triangles
/// have radius ratio 0. Throws InputError when there is no element.
struct MeshQuality {
  double h;                  ///< largest edge length
  double h_min;              ///< smallest edge length
  double min_angle;          ///< smallest angle, degrees
  double mean_radius_ratio;  ///< mean of 2 (inradius)/(circumradius), 1 for equilateral triangles
  double min_radius_ratio;   ///< smallest of these, 0 of a degenerate triangle
  int worst_element;         ///< the element with the smallest radius ratio (0-based)
};
/// Measures it. elements: of any degree, of which the corners count.
MeshQuality mesh_quality(const Connectivity& elements, const Field& x);

/// Vertices - edges + triangles of the corner triangulation.
int euler_characteristic(const Mesh& mesh);

/// Subdivided icosahedron projected onto the sphere: 10·4^s + 2 vertices, s = 0, ..., 10.
Mesh icosphere(double radius, int subdivisions);
/// Subdivided octahedron projected onto the sphere: 4·4^s + 2 vertices, s = 0, ..., 10.
Mesh octasphere(double radius, int subdivisions);
/// n_major x n_minor grid on a torus, each cell cut along alternating diagonals where that is possible.
Mesh torus_grid(double major, double minor, int n_major, int n_minor);
/// The same, uniform in isothermal coordinates: r d theta/(R + r cos theta) is constant, R = major, r =
/// minor, so that all cells have one shape and their size is proportional to the distance from the axis. They
/// are squares when n_minor/n_major = r/sqrt(R² - r²), which is 1 on the Clifford torus R = sqrt(2) r.
Mesh isothermal_torus_grid(double major, double minor, int n_major, int n_minor);
/// A size function for unstructured meshes (`generate_mesh`) of surfaces around the x3 axis: linear in the
/// distance from the axis between (inner_distance, inner_length) and (outer_distance, outer_length), constant
/// beyond. Throws InputError unless 0 <= inner_distance < outer_distance.
std::function<double(const Vec3&)> radial_edge_length(double inner_distance, double inner_length,
                                                      double outer_distance, double outer_length);
/// The one for a torus: `largest` at the outer equator, largest min(1, (major - minor)/minor) at the inner.
/// It resolves the surface whenever largest <= minor.
std::function<double(const Vec3&)> torus_edge_length(double major, double minor, double largest);

}  // namespace esfem
