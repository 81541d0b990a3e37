// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// Richardson's extrapolation to tau = 0 of values with the step sizes tau, 2 tau, 4 tau, .., whose errors
/// are c_p tau^p + c_{p+1} tau^{p+1} + ..: n values leave an error of order p + n - 1. One value stays as it
/// is.
inline Field richardson(std::vector<Field> values, int p) {
  // The term tau^p is 2^p times as large with 2 tau: u^tau - u = (u^{2 tau} - u^tau)/(2^p - 1) but for higher
  // powers.
  for (; values.size() > 1; values.pop_back(), ++p) {
    for (std::size_t i = 0; i + 1 < values.size(); ++i)
      values[i] += (values[i] - values[i + 1]) / (std::pow(2, p) - 1);
  }
  return values.front();
}

}  // namespace esfem
