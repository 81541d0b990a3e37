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

BdfWeights bdf_weights(int q) {
  const std::vector<double> delta = bdf_delta(q), gamma = bdf_gamma(q);
  BdfWeights weights;
  std::copy(delta.begin(), delta.end(), weights.delta.begin());
  std::copy(gamma.begin(), gamma.end(), weights.gamma.begin());
  return weights;
}

BdfWeights bdf_weights(int q, const double* old, double t) {
  check_bdf_order(q);
  for (int j = 0; j < q; ++j) {
    const double newer = j == 0 ? t : old[j - 1];
    if (!(old[j] < newer))
      throw InputError(format("BDF: time %.17g after %.17g, expected increasing times", newer, old[j]));
  }
  const double tau = t - old[0];
  BdfWeights weights;
  for (int j = 0; j < q; ++j) {
    weights.gamma[j] = 1;
    for (int i = 0; i < q; ++i)
      if (i != j) weights.gamma[j] *= (t - old[i]) / (old[j] - old[i]);
    const double ratio = tau / (t - old[j]);
    weights.delta[0] += ratio;
    weights.delta[j + 1] = -ratio * weights.gamma[j];
  }
  return weights;
}

}  // namespace esfem
