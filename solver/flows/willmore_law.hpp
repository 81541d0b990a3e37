// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/pack.hpp"

namespace esfem {

/// What the terms of kll21 (3.5) are made of in a point of the surface, with u = (H, nu).
struct WillmorePoint {
  double t;          ///< time
  Pack x[3];         ///< position on Gamma_h
  Pack H;            ///< H_h
  Pack nu[3];        ///< nu_h, of length 1 only up to errors
  Pack grad_H[3];    ///< tangential gradient of H_h
  Pack A[3][3];      ///< A_h, the symmetric part of grad nu_h
  Pack A_squared;    ///< |A_h|², Frobenius
  Pack A_grad_H[3];  ///< A_h grad H_h
  Pack Q;            ///< of the law
};

/// The law of a flow with normal velocity V = Delta H + Q: Q in points of the surface, of which a law sees t,
/// x, nu, H and |A|².
using WillmoreLaw = std::function<void(const WillmorePoint& at, Pack& Q)>;

/// Q = -H³/2 + |A|² H of kll21 (2.2): Willmore flow, which decreases 1/2 int H².
inline WillmoreLaw willmore_law() {
  return [](const WillmorePoint& at, Pack& Q) { Q = at.H * (at.A_squared - 0.5 * at.H * at.H); };
}

/// Q = 0: surface diffusion, kll21 (1.2).
inline WillmoreLaw surface_diffusion_law() {
  return [](const WillmorePoint&, Pack& Q) { Q = Pack{}; };
}

}  // namespace esfem
