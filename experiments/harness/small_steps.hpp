// SPDX-License-Identifier: GPL-3.0-or-later
// Errors in time alone: against the solution of the same discretisation in space with small steps.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "solver/analysis/table.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// A solution with small steps, and runs with larger ones that it gives the starting values. Exact starting
/// values are off the discrete solution by the error in space; how far is a matter of tau, and this would
/// hide the orders 4 and 5.
template <class Flow>
class SmallSteps {
 public:
  using State = typename Flow::State;

  /// Integrates `flow` from `initial` by `grid` and keeps every `every`-th state. exact_state: as integrate
  /// takes it.
  SmallSteps(Flow& flow, const TimeGrid& grid, const State& initial,
             const std::function<State(double t)>& exact_state, int every)
      : flow_(flow), tau_(every * grid.tau) {
    integrate(flow, grid, initial, exact_state, [&](int n, const State& state) {
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
    History<State> past(q);
    State next;
    for (int n = first - q; n < first; ++n) {
      next = at(n * tau);
      past.push(next);
    }
    const int last = static_cast<int>(std::lround((states_.size() - 1) * tau_ / tau));
    for (int n = first; n <= last; ++n) {
      const double t = n * tau;
      at_step(n, t, [&] {
        next.t = t;
        flow_.step(past, q, tau, next);
        check_finite(next);
        observe(n, std::as_const(next), at(t));
        past.push(next);
      });
    }
  }

 private:
  Flow& flow_;
  double tau_;
  std::vector<State> states_;
};

/// The largest nodal norms, over the steps of a run, of differences of several quantities.
class LargestDifferences {
 public:
  /// quantities: in the order of the columns of the differences. The space must outlive this.
  LargestDifferences(const SurfaceSpace& space, std::vector<ExactEvolution::Quantity> quantities);

  /// difference: N x all components; norms on Gamma_h[x].
  void add(const Field& x, const Field& difference);

  /// nodal_L2, nodal_H1 and nodal_H1_semi of each quantity.
  const Errors& errors() const { return errors_; }

 private:
  const SurfaceSpace& space_;
  std::vector<ExactEvolution::Quantity> quantities_;
  SymmetricMatrix M_, A_;
  Errors errors_;
};

}  // namespace esfem
