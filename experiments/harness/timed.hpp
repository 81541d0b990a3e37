// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ctime>

#include "solver/time/history.hpp"

namespace esfem {

/// A flow whose steps are timed, in seconds of the processor.
template <class Flow>
struct Timed {
  using State = typename Flow::State;
  Flow& flow;
  double seconds = 0;

  void step(const BdfStep<State>& step, State& next) {
    const std::clock_t start = std::clock();
    flow.step(step, next);
    seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }
};

}  // namespace esfem
