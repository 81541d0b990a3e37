// SPDX-License-Identifier: GPL-3.0-or-later
// How large steps may be where terms are extrapolated.
#pragma once

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// The step size above which a term of second order that BDF of order q extrapolates makes some mode
/// alternate and grow, beside one of fourth order that is implicit, as in kll21 (3.5) with extrapolated F.
///
/// For u' = -k⁴ u - a k² u, with wave number k, take u^n = (-1)^n. Its BDF derivative is delta(-1)/tau u^n
/// with delta(-1) = sum_{j=1}^q 2^j/j, and its extrapolation -(2^q - 1) u^n. So a mode alternates with
/// constant size where
///   delta(-1)/tau + k⁴ = (2^q - 1) a k²,
/// which has a solution k exactly for tau >= 4 delta(-1)/((2^q - 1) a)². In (3.5) a is |A|² up to a factor:
/// on a vesicle the step sizes at which BDF2 to BDF5 become unstable are within a factor of 2 of this bound.
double largest_extrapolated_step(int order, double a);

/// The largest |A_h|² in the quadrature points of Gamma_h[x], with u = (H, nu), N x 4.
double largest_weingarten_squared(const SurfaceSpace& space, const Field& x, const Field& u);

}  // namespace esfem
