// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/time/bdf.hpp"

namespace esfem {

/// A Field of a State together with its name in messages.
template <class State>
struct NamedField {
  const char* name;
  Field State::*member;
};

/// The newest states of a run, newest first: back(j) is state n-1-j when step n is computed.
/// Nothing is allocated once `capacity` states are there.
///
/// A State is a copyable struct with `double t`, its Fields, and a list of them:
///   struct State {
///     double t = 0;
///     Field x, v, u;
///     static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"u", &State::u}};
///   };
template <class State>
class History {
 public:
  /// Throws InputError unless 1 <= capacity <= 5: a BDF method of order q needs q states.
  explicit History(int capacity) : capacity_(capacity) {
    check_bdf_order(capacity);
    for (int q = 1; q <= capacity; ++q) {
      delta_.push_back(bdf_delta(q));
      gamma_.push_back(bdf_gamma(q));
    }
    states_.reserve(capacity);
  }

  int size() const { return static_cast<int>(states_.size()); }
  int capacity() const { return capacity_; }

  const State& back(int j) const {
    require(j + 1, size());
    return states_[j];
  }
  State& back(int j) {
    require(j + 1, size());
    return states_[j];
  }

  /// Takes the contents of `next` as the newest state. `next` keeps Fields of the same size, whose values are
  /// stale: the storage of the oldest state, or a copy as long as the history is not full.
  void push(State& next) {
    if (size() < capacity_)
      states_.push_back(next);
    else
      std::swap(states_.back(), next);
    std::rotate(states_.begin(), states_.end() - 1, states_.end());
  }

  /// For steps of different sizes: from now on the weights of order q are those for a step from back(0).t,
  /// back(1).t, .. to t (bdf_weights, with its errors and its bounds on step sizes); until the first call
  /// they are those of equal steps. Allocates nothing.
  void aim(int q, double t) {
    require(q, size());
    std::array<double, max_bdf_order> old;
    for (int j = 0; j < q; ++j) old[j] = states_[j].t;
    bdf_weights(q, old.data(), t, delta_[q - 1].data(), gamma_[q - 1].data());
  }

  /// delta_0..delta_q of BDF q <= capacity, without allocation: a step needs delta(q)[0].
  const std::vector<double>& delta(int q) const {
    require(q, capacity_);
    return delta_[q - 1];
  }

  /// Extrapolation (kll19 5.2): out = sum_{j<q} gamma_j back(j).*member.
  void extrapolate(int q, Field State::*member, Field& out) const {
    require(q, size());
    combine(gamma_[q - 1].data(), q, member, out);
  }

  /// The known part of the BDF sum (kll19 5.1): out = sum_{j=1}^q delta_j back(j-1).*member.
  void bdf_sum(int q, Field State::*member, Field& out) const {
    require(q, size());
    combine(delta_[q - 1].data() + 1, q, member, out);
  }

 private:
  static void require(int count, int available) {
    if (count < 1 || count > available)
      throw InputError(format("history: %d states asked for, there are %d", count, available));
  }

  void combine(const double* weights, int q, Field State::*member, Field& out) const {
    out = weights[0] * (states_[0].*member);
    for (int j = 1; j < q; ++j) out += weights[j] * (states_[j].*member);
  }

  int capacity_;
  std::vector<State> states_;
  std::vector<std::vector<double>> delta_, gamma_;
};

}  // namespace esfem
