// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time/bdf.hpp"

#include <algorithm>

#include "solver/error.hpp"

namespace esfem {
namespace {

double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

double sign(int j) {
  return j % 2 == 0 ? 1 : -1;
}

}  // namespace

void check_bdf_order(int q) {
  if (q < 1 || q > max_bdf_order)
    throw InputError(format("BDF order %d: expected 1 to %d", q, max_bdf_order));
}

std::vector<double> bdf_delta(int q) {
  check_bdf_order(q);
  std::vector<double> delta(q + 1, 0.0);
  for (int j = 0; j <= q; ++j)
    for (int l = std::max(j, 1); l <= q; ++l) delta[j] += sign(j) * binomial(l, j) / l;
  return delta;
}

std::vector<double> bdf_gamma(int q) {
  check_bdf_order(q);
  std::vector<double> gamma(q);
  for (int j = 0; j < q; ++j) gamma[j] = sign(j) * binomial(q, j + 1);
  return gamma;
}

}  // namespace esfem
