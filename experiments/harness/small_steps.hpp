// SPDX-License-Identifier: GPL-3.0-or-later
// Errors in time alone: against the solution of the same discretisation in space with small steps.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// Throws InputError that names --steps unless small steps give all the starting values of BDF of order q
/// with step size tau, that of --steps k, before they are compared from the time `begin` on.
inline void require_starting_values(int k, int q, double tau, double begin) {
  if (q * tau > begin * (1 + 1e-9))
    throw InputError(format("--steps: found %d, expected more: BDF%d needs %d steps of %g before t = %g", k,
                            q, q, tau, begin));
}

/// A solution with small steps, and runs with larger ones that it gives the starting values. Exact starting
/// values differ from the discrete solution by the error in space; the effect depends on tau, and would hide
/// the orders 4 and 5.
template <class Flow>
class SmallSteps {
 public:
  using State = typename Flow::State;

  /// Integrates `flow` from `initial` by `grid` and keeps every `every`-th state. exact_state: as integrate
  /// takes it.
  SmallSteps(Flow& flow, const UniformSteps& grid, const State& initial,
             const std::function<State(double t)>& exact_state, int every)
      : flow_(flow), tau_(every * grid.tau) {
    integrate(flow, grid, {initial, exact_state}, [&](int n, const State& state) {
      if (n % every == 0) states_.push_back(state);
    });
  }

  /// The kept state at time t, a multiple of the kept steps.
  const State& at(double t) const { return states_.at(std::lround(t / tau_)); }

  /// Runs BDF of order q with step size tau, a multiple of the kept steps, until the end; the q states before
  /// the step `first` >= q are those of this solution. Calls observe(n, state, small) for n = first, .., with
  /// this solution at the same time. NumericsErrors are rethrown with step and time.
  template <class Observer>
  void compare(int q, double tau, int first, Observer&& observe) const {
    const int last = static_cast<int>(std::lround((states_.size() - 1) * tau_ / tau)), begin = first - q;
    integrate(flow_, UniformSteps{q, tau, last - begin, {}, begin},
              {at(begin * tau), [this](double t) { return at(t); }}, [&](int n, const State& state) {
                if (n >= q) observe(begin + n, state, at(state.t));
              });
  }

 private:
  Flow& flow_;
  double tau_;
  std::vector<State> states_;
};

}  // namespace esfem
