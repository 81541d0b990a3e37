// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "solver/time/integrate.hpp"

namespace esfem {

/// u' = -u + 2 J u, x' = v = J u with J the rotation by 90 degrees, discretised as kll19 (5.1) is: the
/// damping is implicit, what rotates is extrapolated, x follows from the BDF relation. `extrapolation_order`
/// below q is the broken variant: gamma of a lower order.
struct LinearOde {
  struct State {
    double t = 0;
    Field x, v, u;
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"u", &State::u}};
  };

  int orders_dropped = 0;
  Field known, extrapolated;

  static Field rotated(const Field& u) {
    Field result(1, 2);
    result << -u(0, 1), u(0, 0);
    return result;
  }

  static State exact(double t) {
    State state;
    state.t = t;
    state.u = Field(1, 2);
    state.u << std::exp(-t) * std::cos(2 * t), std::exp(-t) * std::sin(2 * t);
    state.v = rotated(state.u);
    // x = J (-1 + 2J)^{-1} (u(t) - u(0)), and (-1 + 2J)^{-1} = -(1 + 2J)/5.
    Field start(1, 2);
    start << 1, 0;
    const Field difference = state.u - start;
    state.x = -(rotated(difference) - 2 * difference) / 5;
    return state;
  }

  void step(const History<State>& past, int q, double tau, State& next) {
    const double delta0 = past.delta(q)[0];
    past.extrapolate(std::max(1, q - orders_dropped), &State::u, extrapolated);
    next.v.row(0) << -extrapolated(0, 1), extrapolated(0, 0);
    past.bdf_sum(q, &State::u, known);
    next.u = (2 * next.v - known / tau) / (delta0 / tau + 1);
    past.bdf_sum(q, &State::x, known);
    next.x = (tau * next.v - known) / delta0;
  }
};

}  // namespace esfem
