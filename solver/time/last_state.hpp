// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/time/integrate.hpp"

namespace esfem {

/// The state at the end of a run.
template <class Flow>
typename Flow::State last_state(Flow& flow, const UniformSteps& steps,
                                const StartingValues<typename Flow::State>& start) {
  typename Flow::State last;
  integrate(flow, steps, start, [&](int n, const typename Flow::State& state) {
    if (n == steps.steps) last = state;
  });
  return last;
}

}  // namespace esfem
