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
  const char* name;      ///< "x", "u": also in checkpoints
  Field State::*member;  ///< the Field
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
    for (int q = 1; q <= capacity; ++q) equal_steps_.push_back(bdf_weights(q));
    states_.reserve(capacity);
  }

  /// How many states there are.
  int size() const { return static_cast<int>(states_.size()); }
  /// How many states are kept.
  int capacity() const { return capacity_; }

  /// The state j steps before the newest one. Throws InputError unless 0 <= j < size().
  /// @{
  const State& back(int j) const {
    require(j + 1);
    return states_[j];
  }
  State& back(int j) {
    require(j + 1);
    return states_[j];
  }
  /// @}

  /// Takes the contents of `next` as the newest state. `next` keeps Fields of the same size, whose values are
  /// stale: the storage of the oldest state, or a copy as long as the history is not full.
  void push(State& next) {
    if (size() < capacity_)
      states_.push_back(next);
    else
      std::swap(states_.back(), next);
    std::rotate(states_.begin(), states_.end() - 1, states_.end());
  }

  /// The step of BDF q to t from states at distances tau. Allocates nothing.
  BdfStep<State> equal_step(int q, double tau, double t) const {
    return {t, tau, q, equal_steps_[require(q) - 1], newest(q)};
  }

  /// The same whatever the distances of the states are (bdf_weights, with its errors and its bounds on step
  /// sizes).
  BdfStep<State> step_to(double t, int q) const {
    std::array<double, max_bdf_order> old;
    for (int j = 0; j < require(q); ++j) old[j] = states_[j].t;
    return {t, t - old[0], q, bdf_weights(q, old.data(), t), newest(q)};
  }

 private:
  int require(int count) const {
    if (count < 1 || count > size())
      throw InputError(format("history: %d states asked for, there are %d", count, size()));
    return count;
  }

  std::array<const State*, max_bdf_order> newest(int count) const {
    std::array<const State*, max_bdf_order> newest = {};
    for (int j = 0; j < count; ++j) newest[j] = &states_[j];
    return newest;
  }

  int capacity_;
  std::vector<State> states_;
  std::vector<BdfWeights> equal_steps_;  ///< of the orders 1 to capacity
};

}  // namespace esfem
