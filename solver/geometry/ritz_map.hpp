// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/assembly/surface_space.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// Value and tangential gradient of a function in a point of a surface.
struct ValueAndGradient {
  double value;   ///< u(y)
  Vec3 gradient;  ///< grad_Gamma u(y)
};

/// The generalised Ritz map of bk22 (5.4): u_h with, for all phi_h in S_h[x],
///   int over Gamma_h of grad u_h . grad phi_h + u_h phi_h/L²
///     = int over Gamma of grad u . grad phi_h^l + u phi_h^l/L²,
/// L = length (the paper has L = 1), the right-hand side by the space's rule on the lifted elements. Returns
/// nodal values, N x 1.
Field ritz_map(const SurfaceSpace& space, const Field& x, const Surface& surface,
               const std::function<ValueAndGradient(const Vec3& y)>& u, double length);

}  // namespace esfem
