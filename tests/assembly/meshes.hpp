// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// P_k mesh of the sphere of radius R around the origin, nodes on the sphere.
inline Mesh sphere_mesh(double R, int degree, int subdivisions) {
  Mesh mesh = lagrange_mesh(icosphere(R, subdivisions), degree);
  mesh.nodes = R * mesh.nodes.rowwise().normalized();
  return mesh;
}

/// The sphere mesh stretched to semi-axes a, b, c: nodes on the ellipsoid.
inline Mesh ellipsoid_mesh(const Vec3& axes, int degree, int subdivisions) {
  Mesh mesh = sphere_mesh(1, degree, subdivisions);
  mesh.nodes = mesh.nodes * axes.asDiagonal();
  return mesh;
}

/// P_k mesh of the torus around the x3 axis, nodes on the torus.
inline Mesh torus_mesh(double major, double minor, int degree, int n_major, int n_minor) {
  Mesh mesh = lagrange_mesh(torus_grid(major, minor, n_major, n_minor), degree);
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const Vec3 x = mesh.nodes.row(j);
    const Vec3 centre = major * Vec3(x[0], x[1], 0).normalized();
    mesh.nodes.row(j) = centre + minor * (x - centre).normalized();
  }
  return mesh;
}

/// log2 of the ratio of errors on two meshes with edge lengths in proportion 2:1.
inline double order(double coarse_error, double fine_error) {
  return std::log2(std::abs(coarse_error) / std::abs(fine_error));
}

}  // namespace esfem
