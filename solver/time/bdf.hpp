// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// Largest order q of BDF.
constexpr int max_bdf_order = 5;

/// Throws InputError unless 1 <= q <= 5.
void check_bdf_order(int q);

/// delta_0..delta_q of kll19 §5: delta(zeta) = sum_{l=1}^q (1 - zeta)^l / l. Checks q.
std::vector<double> bdf_delta(int q);
/// gamma_0..gamma_{q-1} of kll19 §5: gamma(zeta) = (1 - (1 - zeta)^q) / zeta. Checks q.
std::vector<double> bdf_gamma(int q);

/// The weights of BDF and of extrapolation of one order q: delta_0..delta_q, gamma_0..gamma_{q-1}.
struct BdfWeights {
  std::array<double, max_bdf_order + 1> delta = {};  ///< 0 beyond delta_q
  std::array<double, max_bdf_order> gamma = {};      ///< 0 beyond gamma_{q-1}
};

/// Those of equal steps: bdf_delta and bdf_gamma.
BdfWeights bdf_weights(int q);

/// Those on any grid of times: `old` has the q newest times, newest first, t is the new one. delta: the
/// derivative at t of the polynomial through the values at t, old[0], .., times tau = t - old[0], so that
/// uniform times give bdf_delta. gamma: its value at t without that at t (Lagrange's interpolation; Hairer,
/// Norsett, Wanner: Solving ODEs I, III.5). Throws InputError unless the times increase. BDF2 is zero-stable
/// as long as a step is less than 1 + sqrt(2) times the one before (Grigorieff 1983); higher orders allow
/// less.
BdfWeights bdf_weights(int q, const double* old, double t);

/// What a step of BDF of order q from t - tau to t needs: the weights, and the q newest states. It is the
/// argument of a flow's step. It refers to the states of a History, and holds until that changes.
template <class State>
class BdfStep {
 public:
  const double t;                                     ///< the new time
  const double tau;                                   ///< the step size
  const int order;                                    ///< q
  const std::array<double, max_bdf_order + 1> delta;  ///< delta_0..delta_q
  const std::array<double, max_bdf_order> gamma;      ///< gamma_0..gamma_{q-1}

  /// A History makes them. past: the q newest states, newest first, which must outlive the object.
  BdfStep(double t, double tau, int order, const BdfWeights& weights,
          const std::array<const State*, max_bdf_order>& past)
      : t(t), tau(tau), order(order), delta(weights.delta), gamma(weights.gamma), past_(past) {}

  /// The state j + 1 steps before the new one, j < q.
  const State& past(int j) const { return *past_[j]; }

  /// Extrapolation to t (kll19 5.2): out = sum_{j<q} gamma_j past(j).*member.
  void extrapolate(Field State::*member, Field& out) const { combine(gamma.data(), member, out); }

  /// The known part of the BDF sum (kll19 5.1): out = sum_{j=1}^q delta_j past(j-1).*member.
  void known_sum(Field State::*member, Field& out) const { combine(delta.data() + 1, member, out); }

 private:
  void combine(const double* factors, Field State::*member, Field& out) const {
    out = factors[0] * (past_[0]->*member);
    for (int j = 1; j < order; ++j) out += factors[j] * (past_[j]->*member);
  }

  std::array<const State*, max_bdf_order> past_;
};

}  // namespace esfem
