// SPDX-License-Identifier: GPL-3.0-or-later
// The mode l = 2 of a nearly round unit sphere, r = 1 + a Y with Y = (3 cos² - 1)/2. With H = 2/R + a (l (l +
// 1) - 2) Y/R² and -Lap Y = l (l + 1) Y/R² to first order in a, it decays
//   under v = -H nu, where R² = 1 - 4t, by a' = -(l (l + 1) - 2) a/R² = -4 a/R²: like 1 - 4t;
//   under V = Lap H by a' = -(l - 1) l (l + 1) (l + 2) a = -24 a, because Lap H = -a (l - 1) (l + 2) l (l +
//   1) Y; and under V = Lap H + Q with Q = -H³/2 + |A|² H as well: the bracket of Q = H (|A|² - H²/2), half
//   the square of kappa_1 - kappa_2, is of second order.
#pragma once

#include "solver/surfaces/surface.hpp"

namespace esfem {

/// The unit sphere with the mode l = 2, to first order in its amplitude: an ellipsoid.
Surface nearly_round_sphere(double amplitude = 1e-3);

/// The amplitude of this mode in the nodes x: least squares of |x|.
double mode_amplitude(const Field& x);

}  // namespace esfem
