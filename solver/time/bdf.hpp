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

/// The newest states of a run, as a BDF step sees them. A State is a struct with `double t` and Fields.
template <class State>
class History;  // time/history.hpp

}  // namespace esfem
