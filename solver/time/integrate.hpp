// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "solver/error.hpp"
#include "solver/time/checkpoint.hpp"
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

/// Throws InputError unless 1 <= order <= 5, tau > 0, steps >= 0, K >= 1.
void check_time_grid(const TimeGrid& grid);

/// What the numbers of a step depend on: all but the number of steps.
nlohmann::json identity_of_steps(const TimeGrid& grid);
/// Why a run that has come so far does not lead to this end; empty when it does.
std::string objection_of_end(const TimeGrid& grid, const RunPosition& done);

/// Throws NumericsError naming field and node when a value of the state is not finite.
template <class State>
void check_finite(const State& state) {
  for (const NamedField<State>& field : State::fields) {
    const Field& values = state.*field.member;
    if (values.allFinite()) continue;
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      if (!values.row(i).allFinite())
        throw NumericsError(format("non-finite value of %s at node %td (counted from 1)", field.name, i + 1));
  }
}

/// Adds step and time (as `body` leaves it) to the NumericsErrors of `body`.
template <class Body>
void at_step(int n, const double& t, Body&& body) {
  try {
    body();
  } catch (const SingularityError& error) {
    throw error.at(n, t);
  } catch (const ExtinctionError& error) {
    throw error.at(n, t);
  } catch (const NumericsError& error) {
    throw error.at(n, t);
  }
}

template <class Flow, class = void>
struct Settles : std::false_type {};
template <class Flow>
struct Settles<Flow,
               std::void_t<decltype(std::declval<Flow&>().settle(
                   std::declval<History<typename Flow::State>&>(), std::declval<typename Flow::State&>()))>>
    : std::true_type {};

/// What a flow with settle(past, next) changes in a new state and those before it, between two steps.
template <class Flow>
void settle(Flow& flow, History<typename Flow::State>& past, typename Flow::State& next) {
  if constexpr (Settles<Flow>::value) flow.settle(past, next);
}

/// Advances `past`, which has step size tau/K, from state n-1 to state n of the coarse grid; leaves that in
/// `next`.
template <class Flow>
void take_substeps(Flow& flow, History<typename Flow::State>& past, int q, double tau, int K, int n,
                   typename Flow::State& next) {
  for (int k = 1; k <= K; ++k) {
    const int m = (n - 1) * K + k;
    next.t = static_cast<double>(m) / K * tau;
    try {
      flow.step(past, std::min(m, q), tau / K, next);
      check_finite(next);
      settle(flow, past, next);
    } catch (const SingularityError&) {
      throw;
    } catch (const NumericsError& error) {
      throw NumericsError(format("starting substep %d of %d: %s", k, K, error.what()));
    }
    if (k < K) {
      past.push(next);
    } else {
      typename Flow::State kept = next;
      past.push(kept);
    }
  }
}

/// Whether an observer lets the run go on after this step: one that returns nothing always does.
template <class Observer, class State>
bool goes_on_after(Observer& observe, int n, const State& state) {
  if constexpr (std::is_same_v<decltype(observe(n, state)), bool>) {
    return observe(n, state);
  } else {
    observe(n, state);
    return true;
  }
}

[[noreturn]] inline void stop_at(int n, double t) {
  throw StoppedError(format("stopped at t = %g (step %d)", t, n));
}

/// Computes the starting value of step n < q. `fine` is the history with step size tau/K (Start::substeps).
template <class Flow>
void find_starting_value(Flow& flow, const TimeGrid& grid,
                         const std::function<typename Flow::State(double t)>& exact_state, int n,
                         History<typename Flow::State>& past, History<typename Flow::State>& fine,
                         typename Flow::State& next) {
  const double t = n * grid.tau;
  switch (grid.start.kind) {
  case Start::exact:
    next = exact_state(t);
    break;
  case Start::cascade:
    next.t = t;
    flow.step(past, n, grid.tau, next);
    settle(flow, past, next);
    break;
  case Start::substeps:
    take_substeps(flow, fine, grid.order, grid.tau, grid.start.substeps_per_step, n, next);
    break;
  }
  next.t = t;
}

/// Finds the states 0..q-1 (fewer when the run is shorter), observes them and pushes them to `past`.
template <class Flow, class Observer>
void take_starting_steps(Flow& flow, const TimeGrid& grid, const typename Flow::State& initial,
                         const std::function<typename Flow::State(double t)>& exact_state, Observer&& observe,
                         History<typename Flow::State>& past) {
  typename Flow::State next = initial;
  History<typename Flow::State> fine(grid.order);
  fine.push(next);
  for (int n = 0; n < grid.order && n <= grid.steps; ++n)
    at_step(n, n * grid.tau, [&] {
      if (n > 0) find_starting_value(flow, grid, exact_state, n, past, fine, next);
      check_finite(next);
      if (!goes_on_after(observe, n, std::as_const(next)) && n < grid.steps) stop_at(n, n * grid.tau);
      past.push(next);
    });
}

template <class Flow, class = void>
struct KeepsProgress : std::false_type {};
template <class Flow>
struct KeepsProgress<Flow,
                     std::void_t<decltype(std::declval<Flow&>().resume(std::declval<Flow&>().progress()))>>
    : std::true_type {};

/// Checkpoint::resume, before which the flow itself is attached when it has progress() and resume(json). A
/// checkpoint serves one run. False without checkpoint.
template <class Grid, class Flow, class State>
bool resume_run(Checkpoint* checkpoint, Flow& flow, const Grid& grid, const State& initial,
                History<State>& past, RunPosition& done) {
  if (!checkpoint) return false;
  if constexpr (KeepsProgress<Flow>::value)
    checkpoint->attach([&flow] { return flow.progress(); },
                       [&flow](const nlohmann::json& saved) { flow.resume(saved); });
  return checkpoint->resume(identity_of_steps(grid), initial, past, done,
                            [&grid](const RunPosition& saved) { return objection_of_end(grid, saved); });
}

/// Runs a flow from t = 0: calls observe(n, state) for n = 0..steps, the starting steps included; t = n tau.
/// A flow has a type State (see History) and
///   void step(const History<State>& past, int q, double tau, State& next)
/// that computes next (its t is set already, its Fields have the right size and stale values) from the q
/// newest states by BDF of order q. exact_state(t) is needed for Start::exact with q > 1; without it that
/// start is an InputError. NumericsErrors (of the observer too) are rethrown with step and time; a non-finite
/// value in a new state is one too. A flow that has settle(past, next) may change both after each step. An
/// observer that returns false ends the run after this step with a
/// StoppedError. With a checkpoint the run goes on where an earlier one had saved its states (after the
/// starting steps, that is), with the same or another number of steps, and observes the steps from there on:
/// with the same numbers, as long as `step` depends on its arguments alone, or what an earlier step has left
/// in the flow is restored by its resume(progress()). It is saved now and then, when the run is stopped, and
/// at its end.
template <class Flow, class Observer>
void integrate(Flow& flow, const TimeGrid& grid, typename Flow::State initial,
               const std::function<typename Flow::State(double t)>& exact_state, Observer&& observe,
               Checkpoint* checkpoint = nullptr) {
  check_time_grid(grid);
  if (grid.start.kind == Start::exact && grid.order > 1 && grid.steps > 0 && !exact_state)
    throw InputError("start exact: there is no exact solution; expected start cascade or substeps:K");

  History<typename Flow::State> past(grid.order);
  RunPosition done;
  initial.t = 0;
  if (!resume_run(checkpoint, flow, grid, initial, past, done)) {
    take_starting_steps(flow, grid, initial, exact_state, observe, past);
    done.n = past.size() - 1;
  }
  typename Flow::State& next = initial;
  bool goes_on = true;
  while (goes_on && done.n < grid.steps) {
    if (checkpoint) checkpoint->save_when_due(done, past);
    const int n = done.n + 1;
    const double t = n * grid.tau;
    at_step(n, t, [&] {
      next.t = t;
      flow.step(past, grid.order, grid.tau, next);
      check_finite(next);
      settle(flow, past, next);
      goes_on = goes_on_after(observe, n, std::as_const(next));
      past.push(next);
    });
    done.n = n;
  }
  if (checkpoint && past.size() == past.capacity()) checkpoint->save(done, past);
  if (done.n < grid.steps) stop_at(done.n, past.back(0).t);
}

}  // namespace esfem
