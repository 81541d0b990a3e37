// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "solver/time/integrate.hpp"

namespace esfem {

/// Step sizes that follow the solution.
struct AdaptiveGrid {
  int order = 2;  ///< of BDF, 1 or 2
  double end_time = 0;
  double tolerance = 1e-3;         ///< of the estimate of each step, in `units`
  double first_step = 1e-6;        ///< not controlled itself; a hundredth of it is the smallest step
  double largest_step = 0;         ///< 0: no bound
  std::vector<double> units = {};  ///< of the components of the controlled field; empty: 1
};

/// Throws InputError unless order is 1 or 2, end_time >= 0, tolerance > 0, end_time/10^12 <= first_step,
/// units > 0 and, where a largest step is given, first_step <= largest_step.
void check_adaptive_grid(const AdaptiveGrid& grid);

/// As for a TimeGrid: all but the end time.
nlohmann::json identity_of_steps(const AdaptiveGrid& grid);
std::string objection_of_end(const AdaptiveGrid& grid, const RunPosition& done);

/// The time after t for a step of about tau: the last step ends at end_time, and what remains for one step to
/// two is halved.
double next_time(const AdaptiveGrid& grid, double t, double tau);

/// The least end time (up to round-off, not below it) for which next_time is t + tau.
double least_end(double t, double tau);

/// min(1.5, max(0.5, 0.9 sqrt(tolerance / error))): the estimate is of second order. 1.5 keeps BDF2
/// zero-stable.
double step_factor(double tolerance, double error);

/// The size of a nodal field: sqrt(sum of squares / number of nodes).
double root_mean_square(const Field& field);

/// That of the field whose components are measured in `units`: one for each, or none. Changes the field.
double root_mean_square(Field& field, const std::vector<double>& units);

/// Takes one step to next.t and returns the factor for the size of the following one. Throws NumericsError
/// when the estimated error is more than 4 times the tolerance. `difference` is work space.
template <class Flow>
double attempt_step(Flow& flow, const AdaptiveGrid& grid, History<typename Flow::State>& past,
                    Field Flow::State::*controlled, Field& difference, typename Flow::State& next) {
  const int available = past.size();
  past.aim(available, next.t);
  flow.step(past, std::min(grid.order, available), next.t - past.back(0).t, next);
  check_finite(next);
  if (available < 2) return 1;
  past.extrapolate(2, controlled, difference);
  difference -= next.*controlled;
  const double error = root_mean_square(difference, grid.units);
  if (!(error <= 4 * grid.tolerance))
    throw NumericsError(format("estimated error %g of a step of size %g: at most %g expected", error,
                               next.t - past.back(0).t, 4 * grid.tolerance));
  return step_factor(grid.tolerance, error);
}

/// Computes `next` by a step whose size is halved until it succeeds; done.tau is the size to begin with, and
/// becomes that for the following step. When the size has come down to first_step / 100 the error is let
/// through.
template <class Flow>
void take_adaptive_step(Flow& flow, const AdaptiveGrid& grid, History<typename Flow::State>& past,
                        Field Flow::State::*controlled, RunPosition& done, Field& difference,
                        typename Flow::State& next) {
  for (;; ++done.rejected) {
    next.t = next_time(grid, past.back(0).t, done.tau);
    const double tau = next.t - past.back(0).t;
    try {
      const double wanted = tau * attempt_step(flow, grid, past, controlled, difference, next);
      done.tau = grid.largest_step > 0 ? std::min(grid.largest_step, wanted) : wanted;
      return;
    } catch (const NumericsError&) {
      if (tau / 2 < grid.first_step / 100) throw;
      done.tau = tau / 2;
    }
  }
}

struct AdaptiveRun {
  int steps = 0, rejected = 0;
};

/// Runs a flow (see integrate) from t = 0 to end_time by BDF of order 1 or 2 with variable steps. The error
/// of a step is estimated by the root mean square over the nodes of the difference of the `controlled` field
/// from its linear extrapolation from the two newest states, which is of second order in the step size; the
/// first step is a backward Euler step without estimate. A step is rejected, and repeated from the same
/// history with half its size, when the estimate is more than 4 times the tolerance, or when it throws a
/// NumericsError. Calls observe(n, state) for n = 0, 1, .. Errors, exactness of restarts, checkpoints and
/// stops as for integrate; the last state that is saved is the one before the first step whose size depends
/// on the end time, so that a run with a later end goes on from there.
template <class Flow, class Observer>
AdaptiveRun integrate_adaptive(Flow& flow, const AdaptiveGrid& grid, typename Flow::State initial,
                               Field Flow::State::*controlled, Observer&& observe,
                               Checkpoint* checkpoint = nullptr) {
  check_adaptive_grid(grid);
  History<typename Flow::State> past(2);
  RunPosition done{0, grid.first_step, 0, 0};
  initial.t = 0;
  typename Flow::State& next = initial;
  bool goes_on = true;
  if (!resume_run(checkpoint, flow, grid, initial, past, done))
    at_step(0, 0.0, [&] {
      check_finite(next);
      goes_on = goes_on_after(observe, 0, std::as_const(next));
      past.push(next);
    });
  Field difference;
  bool depends_on_end = false;
  while (goes_on && past.back(0).t < grid.end_time) {
    const double least = least_end(past.back(0).t, done.tau);
    if (checkpoint && !depends_on_end)
      least <= grid.end_time ? checkpoint->save_when_due(done, past) : checkpoint->save(done, past);
    depends_on_end = depends_on_end || least > grid.end_time;
    done.least_end = std::max(done.least_end, least);
    const int n = done.n + 1;
    at_step(n, next.t, [&] {
      take_adaptive_step(flow, grid, past, controlled, done, difference, next);
      settle(flow, past, next);
      goes_on = goes_on_after(observe, n, std::as_const(next));
    });
    past.push(next);
    done.n = n;
  }
  if (past.back(0).t < grid.end_time) {
    if (checkpoint && !depends_on_end) checkpoint->save(done, past);
    stop_at(done.n, past.back(0).t);
  }
  return {done.n, done.rejected};
}

}  // namespace esfem
