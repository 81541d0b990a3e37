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
/// which has a solution k exactly for tau >= 4 delta(-1)/((2^q - 1) a)².
double largest_extrapolated_step(int order, double a);

/// A step size up to which (3.5) with extrapolated F was stable, where |A|² is at most A_squared: the bound
/// above with a = |A|², divided by a factor, since (3.5) is a system and a is |A|² only in size. Measured on
/// a vesicle (|A|² = 11.8) and on the Clifford torus (13.7): the steps of BDF2, 3 and 4 become unstable at
/// 1/2.2 and 1/1.5, 1/2.7 and 1/1.1, 1/4.5 and 1/3.7 of the bound, those of BDF5 on the vesicle below 1/13.
double stable_willmore_step(int order, double A_squared);

/// The largest |A_h|² in the quadrature points of Gamma_h[x], with u = (H, nu), N x 4.
double largest_weingarten_squared(const SurfaceSpace& space, const Field& x, const Field& u);

}  // namespace esfem
