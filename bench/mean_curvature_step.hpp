// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/mesh/generate.hpp"

namespace esfem {

/// g and f of kll19 §3.3 in one pass: columns 0-2 are g = -∫ H_h nu_h phi - ∫ grad(H_h nu_h) . grad phi,
/// columns 3-6 are f = ∫ |grad nu_h|² (nu_h, H_h) phi; u = (nu_h, H_h).
inline void mean_curvature_load(const PointData<4>& at, Integrand<7, 3>& out) {
  Pack grad_nu_squared = {};
  for (int l = 0; l < 3; ++l) {
    grad_nu_squared += dot(at.grad[l], at.grad[l]);
    out.value[l] = -at.u[3] * at.u[l];
    for (int i = 0; i < 3; ++i) out.flux[l][i] = -(at.u[3] * at.grad[l][i] + at.u[l] * at.grad[3][i]);
  }
  for (int l = 0; l < 4; ++l) out.value[3 + l] = grad_nu_squared * at.u[l];
}

/// An icosphere of degree 2.
inline Mesh quadratic_icosphere(double radius, int subdivisions) {
  Mesh mesh = lagrange_mesh(icosphere(radius, subdivisions), 2);
  mesh.nodes = radius * mesh.nodes.rowwise().normalized();
  return mesh;
}

/// nu and H of a sphere around the origin, N x 4.
inline Field normal_and_curvature(const Mesh& mesh, double radius) {
  Field u(mesh.nodes.rows(), 4);
  u.leftCols(3) = mesh.nodes / radius;
  u.col(3).setConstant(2 / radius);
  return u;
}

}  // namespace esfem
