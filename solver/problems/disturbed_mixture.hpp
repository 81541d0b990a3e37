// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/cahn_hilliard.hpp"

namespace esfem {

/// A disturbed mixture on nodes x, u = mean + disturbance times plane waves (in units of the space's length
/// from `origin`) less their mean over Gamma_h[x], so that int u is `mean` times the area, and w from the
/// second equation; t = 0.
CahnHilliardState disturbed_mixture(const SurfaceSpace& space, const Field& x, double epsilon, double mean,
                                    double disturbance, unsigned seed, const Vec3& origin = Vec3::Zero());

}  // namespace esfem
