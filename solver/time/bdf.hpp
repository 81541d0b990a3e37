// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/types.hpp"

namespace esfem {

constexpr int max_bdf_order = 5;

/// Throws InputError unless 1 <= q <= 5.
void check_bdf_order(int q);

/// delta_0..delta_q of kll19 §5: delta(zeta) = sum_{l=1}^q (1 - zeta)^l / l. Checks q.
std::vector<double> bdf_delta(int q);
/// gamma_0..gamma_{q-1} of kll19 §5: gamma(zeta) = (1 - (1 - zeta)^q) / zeta. Checks q.
std::vector<double> bdf_gamma(int q);

/// BDF and extrapolation of order q on any grid of times: `old` has the q newest times, newest first, t is
/// the new one. delta (q + 1 numbers): the derivative at t of the polynomial through the values at t, old[0],
/// .., times tau = t - old[0], so that uniform times give bdf_delta. gamma (q numbers): its value at t
/// without that at t (Lagrange's interpolation; Hairer, Norsett, Wanner: Solving ODEs I, III.5). Throws
/// InputError unless the times increase. BDF2 is zero-stable as long as a step is less than 1 + sqrt(2) times
/// the one before (Grigorieff 1983); higher orders allow less.
void bdf_weights(int q, const double* old, double t, double* delta, double* gamma);

/// The newest states of a run, as a BDF step sees them. A State is a struct with `double t` and Fields.
template <class State>
class History;  // time/history.hpp

}  // namespace esfem
