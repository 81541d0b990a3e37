// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

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

/// The seconds of wall-clock time that `body` takes.
template <class Body>
double seconds_of(Body&& body) {
  const auto begin = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Run time of `other` relative to `one`: the median of five pairs of runs. Each call is a run and returns
/// its seconds.
template <class One, class Other>
double median_seconds_ratio(One&& one, Other&& other) {
  std::vector<double> ratios;
  for (int pair = 0; pair < 5; ++pair) {
    const double seconds = one();
    ratios.push_back(other() / seconds);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

}  // namespace esfem
