// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/fe/quadrature.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem {

/// One step of kll19 (5.1) as one writes it first: element by element, setFromTriplets, and a complete
/// Eigen::SimplicialLLT for each of the two systems. nu_h, H_h: columns of u (N x 4).
/// Returns the seven solution columns, v and (nu, H).
Field naive_step(const Mesh& mesh, const Quadrature& rule, const Field& u, double mass_factor);

/// One solve of the block system of kll21 (3.5), F(x, u) w on the right-hand side, as one writes it first:
/// element by element, setFromTriplets, and UMFPACK on the 2N x 2N matrix. u_w: (H, nu, V, z), N x 8, also
/// the columns of the result.
Field naive_willmore_step(const Mesh& mesh, const Quadrature& rule, const Field& u_w, double mass_factor);

/// One step of bk22 (8.3) with the double well in the same way: u~ (N x 1), old = -sum_{j>=1} delta_j M
/// u^{n-j}/tau. Returns u and w, N x 2.
Field naive_cahn_hilliard_step(const Mesh& mesh, const Quadrature& rule, const Field& u_tilde,
                               const Field& old, double epsilon, double mass_factor);

}  // namespace esfem
