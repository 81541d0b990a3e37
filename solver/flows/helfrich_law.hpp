// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/willmore_law.hpp"

namespace esfem {

/// Q of Helfrich flow, the gradient flow of E = 1/2 int (H - H_0)² with constant spontaneous curvature H_0,
/// which has the sign of H: of spheres, that with radius 2/H_0 has E = 0.
///
/// Nodes that move with V nu have d(H) = -(Delta V + |A|² V) and d(dA) = H V dA (kll21 §2), so that
///   dE/dt = int (H - H_0) (-Delta V - |A|² V) + 1/2 (H - H_0)² H V
///         = -int (Delta H + |A|² (H - H_0) - 1/2 H (H - H_0)²) V.
/// V = Delta H + Q is the bracket: Q = |A|² (H - H_0) - 1/2 H (H - H_0)². With H_0 = 0 it is that of
/// willmore_law.
inline WillmoreLaw helfrich_law(double H_0) {
  return [H_0](const WillmorePoint& at, Pack& Q) {
    const Pack difference = at.H - H_0;
    Q = difference * (at.A_squared - 0.5 * at.H * difference);
  };
}

/// 1/2 int (H_h - H_0)² over Gamma_h[x]; H_0 (N x 1) in the nodes.
double helfrich_energy(const SurfaceSpace& space, const Field& x, const Field& H, const Field& H_0);

}  // namespace esfem
