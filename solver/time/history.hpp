// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "solver/time/bdf.hpp"

namespace esfem {

/// The newest states of a run, newest first: back(j) is state n-1-j when step n is computed.
/// A State is a struct with `double t` and Field members. Nothing is allocated once `capacity` states are
/// there.
template <class State>
class History {
 public:
  explicit History(int capacity);
  int size() const;
  const State& back(int j) const;
  /// Takes the contents of `next` as the newest state; `next` gets the storage of the oldest (its values are
  /// stale).
  void push(State& next);
  /// Extrapolation (5.2): out = sum_{j<q} gamma_j back(j).*member.
  void extrapolate(int q, Field State::*member, Field& out) const;
  /// The known part of the BDF sum (5.1): out = sum_{j=1}^q delta_j back(j-1).*member.
  void bdf_sum(int q, Field State::*member, Field& out) const;
};

}  // namespace esfem
