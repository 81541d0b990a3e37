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

  void step(const BdfStep<State>& step, State& next) {
    const double tau = step.tau, delta0 = step.delta[0];
    extrapolate(step, extrapolated);
    next.v.row(0) << -extrapolated(0, 1), extrapolated(0, 0);
    step.known_sum(&State::u, known);
    next.u = (2 * next.v - known / tau) / (delta0 / tau + 1);
    step.known_sum(&State::x, known);
    next.x = (tau * next.v - known) / delta0;
  }

  /// By the order of the step, or fewer states where orders are dropped.
  void extrapolate(const BdfStep<State>& step, Field& u) const {
    if (orders_dropped == 0) return step.extrapolate(&State::u, u);
    const std::vector<double> gamma = bdf_gamma(std::max(1, step.order - orders_dropped));
    u = gamma[0] * step.past(0).u;
    for (std::size_t j = 1; j < gamma.size(); ++j) u += gamma[j] * step.past(j).u;
  }
};

}  // namespace esfem
