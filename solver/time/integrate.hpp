// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "solver/error.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// How the states 1..q-1 are found. exact: from the exact solution. cascade: BDF 1, 2, .. with the same step
/// size (global order 2 at most). substeps: the same method started by a cascade with step size tau/K, every
/// K-th kept.
struct Start {
  enum Kind { exact, cascade, substeps } kind = exact;
  int substeps_per_step = 1;  ///< K
};
/// Parses "exact" | "cascade" | "substeps:K"; throws InputError that lists these.
Start parse_start(const std::string& text);
std::string to_string(const Start& start);

struct TimeGrid {
  int order = 2;  ///< q of BDF
  double tau = 0;
  int steps = 0;  ///< end time = steps * tau, starting steps counted
  Start start;
};

/// Runs a flow: calls observe(n, state) for n = 0..steps.
/// A flow has a type State (see History) and
///   void step(const History<State>& past, int q, double tau, State& next)
/// that computes next (its t is set already) from the q newest states by BDF of order q.
/// exact_state(t) is needed for Start::exact with q > 1; without it that start is an InputError.
/// NumericsErrors are rethrown with step and time; a non-finite value in a new state is one too.
template <class Flow, class Observer>
void integrate(Flow& flow, const TimeGrid& grid, typename Flow::State initial,
               const std::function<typename Flow::State(double t)>& exact_state, Observer&& observe);

}  // namespace esfem
