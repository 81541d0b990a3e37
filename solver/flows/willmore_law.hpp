// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/pack.hpp"

namespace esfem {

/// The law of a flow with normal velocity V = Delta H + Q: Q in points of the surface, of their H and |A|².
using WillmoreLaw = std::function<void(const Pack& H, const Pack& A_squared, Pack& Q)>;

/// Q = -H³/2 + |A|² H of kll21 (2.2): Willmore flow, which decreases 1/2 int H².
inline WillmoreLaw willmore_law() {
  return [](const Pack& H, const Pack& A_squared, Pack& Q) { Q = H * (A_squared - 0.5 * H * H); };
}

/// Q = 0: surface diffusion, kll21 (1.2).
inline WillmoreLaw surface_diffusion_law() {
  return [](const Pack&, const Pack&, Pack& Q) { Q = Pack{}; };
}

/// Q in one point.
inline double Q_of(const WillmoreLaw& law, double H, double A_squared) {
  Pack Q;
  law(pack(H), pack(A_squared), Q);
  return Q[0];
}

}  // namespace esfem
