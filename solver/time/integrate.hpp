// SPDX-License-Identifier: GPL-3.0-or-later
// The time loop.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/time/checkpoint.hpp"
#include "solver/time/history.hpp"
#include "solver/time/steps.hpp"

namespace esfem {

/// What a run starts from: a state, and for Start::exact the exact solution.
template <class State>
struct StartingValues {
  State initial;                         ///< its t is replaced by the first time of the steps
  std::function<State(double t)> exact;  ///< the exact state at a time; may be empty

  /// Equal steps: the states before the initial one, newest first, as an earlier run of the same step size
  /// has left them. With q - 1 of them or more, there are no starting steps.
  std::vector<State> before = {};
  /// Called after each substep of the starting steps, if there is one.
  std::function<void(double t)> after_substep = {};

  /// exact: what Start::exact with q > 1 needs.
  StartingValues(State initial, std::function<State(double t)> exact = {})
      : initial(std::move(initial)), exact(std::move(exact)) {}
};

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
  } catch (const ToleranceError& error) {
    throw error.at(n, t);
  } catch (const NumericsError& error) {
    throw error.at(n, t);
  }
}

/// @cond

/// Whether a flow has settle(past, next).
template <class Flow, class = void>
struct Settles : std::false_type {};
template <class Flow>
struct Settles<Flow,
               std::void_t<decltype(std::declval<Flow&>().settle(
                   std::declval<History<typename Flow::State>&>(), std::declval<typename Flow::State&>()))>>
    : std::true_type {};

/// @endcond

/// What a flow with settle(past, next) changes in a new state and those before it, between two steps.
template <class Flow>
void settle(Flow& flow, History<typename Flow::State>& past, typename Flow::State& next) {
  if constexpr (Settles<Flow>::value) flow.settle(past, next);
}

/// One step of a flow, and its check.
template <class Flow>
void take_step(Flow& flow, const BdfStep<typename Flow::State>& step, typename Flow::State& next) {
  flow.step(step, next);
  check_finite(next);
}

// Equal steps.

/// Advances `past`, which has step size tau/K, from state n-1 to state n of the coarse steps; leaves that in
/// `next`.
template <class Flow>
void take_substeps(Flow& flow, const UniformSteps& steps, int n, History<typename Flow::State>& past,
                   typename Flow::State& next, const std::function<void(double t)>& after_substep) {
  const int K = steps.start.substeps_per_step;
  for (int k = 1; k <= K; ++k) {
    const int m = (n - 1) * K + k;
    next.t = steps.start_time + (steps.first + static_cast<double>(m) / K) * steps.tau;
    try {
      take_step(flow, past.equal_step(std::min(m, steps.order), steps.tau / K, next.t), next);
      settle(flow, past, next);
    } catch (const SingularityError&) {
      throw;
    } catch (const NumericsError& error) {
      throw NumericsError(format("starting substep %d of %d: %s", k, K, error.what()));
    }
    if (after_substep) after_substep(next.t);
    if (k < K) {
      past.push(next);
    } else {
      typename Flow::State kept = next;
      past.push(kept);
    }
  }
}

/// Computes the starting value of step n < q. `fine` is the history with step size tau/K (Start::substeps).
template <class Flow>
void find_starting_value(Flow& flow, const UniformSteps& steps,
                         const StartingValues<typename Flow::State>& start, int n,
                         History<typename Flow::State>& past, History<typename Flow::State>& fine,
                         typename Flow::State& next) {
  const double t = steps.time(n);
  switch (steps.start.kind) {
  case Start::exact:
    next = start.exact(t);
    break;
  case Start::cascade:
    next.t = t;
    take_step(flow, past.equal_step(n, steps.tau, t), next);
    settle(flow, past, next);
    break;
  case Start::substeps:
    take_substeps(flow, steps, n, fine, next, start.after_substep);
    break;
  }
  next.t = t;
}

/// Finds the states 0..q-1 (fewer when the run is shorter) and pushes them to `past`; state 0 alone when
/// those before it are known. Returns false when observe(n, state) ends the run.
template <class Flow, class Observe>
bool take_starting_steps(Flow& flow, const UniformSteps& steps,
                         const StartingValues<typename Flow::State>& start, const Observe& observe,
                         History<typename Flow::State>& past, RunPosition& done) {
  const bool has_past = steps.order > 1 && static_cast<int>(start.before.size()) >= steps.order - 1;
  const int starting_states = has_past ? 1 : steps.order;
  if (steps.start.kind == Start::exact && starting_states > 1 && steps.steps > 0 && !start.exact)
    throw InputError("start exact: there is no exact solution; expected start cascade or substeps:K");
  typename Flow::State next = start.initial;
  next.t = steps.time(0);
  History<typename Flow::State> fine(steps.order);
  fine.push(next);
  for (int j = has_past ? steps.order - 1 : 0; j > 0; --j) {
    typename Flow::State earlier = start.before[j - 1];
    past.push(earlier);
  }
  bool goes_on = true;
  for (int n = 0; goes_on && n < starting_states && n <= steps.steps; ++n)
    at_step(n, steps.time(n), [&] {
      if (n > 0) find_starting_value(flow, steps, start, n, past, fine, next);
      check_finite(next);
      goes_on = observe(n, std::as_const(next));
      past.push(next);
      done.n = n;
    });
  return goes_on;
}

/// How many states the History of a run with these steps keeps.
inline int states_kept(const UniformSteps& steps) {
  return steps.order;
}
/// Whether the run has taken all its steps.
template <class State>
bool is_at_end(const UniformSteps& steps, const RunPosition& done, const History<State>&) {
  return done.n >= steps.steps;
}
/// Computes `next`, the state after the newest one of `past`.
template <class Flow>
void take_next_step(Flow& flow, const UniformSteps& steps, const History<typename Flow::State>& past,
                    RunPosition& done, typename Flow::State& next) {
  next.t = steps.time(done.n + 1);
  take_step(flow, past.equal_step(steps.order, steps.tau, next.t), next);
}

/// Whether a run can resume from these states: not from an incomplete set of starting values.
template <class State>
bool can_be_resumed(const UniformSteps&, const RunPosition&, const History<State>& past) {
  return past.size() == past.capacity();
}
/// Whether this state is the last one from which a run with a later end can resume, so that it is to be
/// saved: such a run can resume from any state at equal steps.
inline bool is_last_to_resume(const UniformSteps&, const RunPosition&, double) {
  return false;
}

/// Given times and steps that follow the solution start from the initial state alone, which is pushed to
/// `past`. Returns false when observe(0, state) ends the run.
template <class Flow, class Steps, class Observe>
bool take_starting_steps(Flow&, const Steps&, const StartingValues<typename Flow::State>& start,
                         const Observe& observe, History<typename Flow::State>& past, RunPosition&) {
  typename Flow::State next = start.initial;
  bool goes_on = true;
  at_step(0, next.t, [&] {
    check_finite(next);
    goes_on = observe(0, std::as_const(next));
  });
  past.push(next);
  return goes_on;
}

// Given times.

/// The same for given times.
/// @{
inline int states_kept(const GivenTimes& steps) {
  return steps.order;
}
template <class State>
bool is_at_end(const GivenTimes& steps, const RunPosition& done, const History<State>&) {
  return done.n + 1 >= static_cast<int>(steps.times.size());
}
template <class Flow>
void take_next_step(Flow& flow, const GivenTimes& steps, const History<typename Flow::State>& past,
                    RunPosition& done, typename Flow::State& next) {
  next.t = steps.times[done.n + 1];
  take_step(flow, past.step_to(next.t, std::min(steps.order, past.size())), next);
}
template <class State>
bool can_be_resumed(const GivenTimes&, const RunPosition&, const History<State>&) {
  return true;
}
inline bool is_last_to_resume(const GivenTimes&, const RunPosition&, double) {
  return false;
}
/// @}

// Steps that follow the solution.

/// Takes one step to next.t and returns the factor for the size of the following one. Throws ToleranceError
/// when the estimated error is more than 4 times the tolerance.
template <class Flow>
double attempt_step(Flow& flow, const AdaptiveSteps& steps, const History<typename Flow::State>& past,
                    typename Flow::State& next) {
  using State = typename Flow::State;
  take_step(flow, past.step_to(next.t, std::min(steps.order, past.size())), next);
  if (past.size() < 2) return 1;
  Field State::*controlled = nullptr;
  for (const NamedField<State>& field : State::fields)
    if (field.name == steps.controlled) controlled = field.member;
  if (!controlled)
    throw InputError("adaptive steps: there is no field '" + steps.controlled + "' to control");
  Field difference;
  past.step_to(next.t, 2).extrapolate(controlled, difference);
  difference -= next.*controlled;
  const double error = root_mean_square(difference, steps.units);
  if (!(error <= 4 * steps.tolerance))
    throw ToleranceError(format("estimated error %g of a step of size %g: at most %g expected", error,
                                next.t - past.back(0).t, 4 * steps.tolerance));
  return step_factor(steps.tolerance, error);
}

/// Two, of which the estimate of the error extrapolates.
inline int states_kept(const AdaptiveSteps&) {
  return 2;
}
/// Whether the run has reached its end time.
template <class State>
bool is_at_end(const AdaptiveSteps& steps, const RunPosition&, const History<State>& past) {
  return past.back(0).t >= steps.end_time;
}

/// Computes `next` by a step whose size is halved until it succeeds; done.tau is the size to begin with, and
/// becomes that for the following step. When the size has been reduced to first_step / 100, the error is
/// rethrown.
template <class Flow>
void take_next_step(Flow& flow, const AdaptiveSteps& steps, const History<typename Flow::State>& past,
                    RunPosition& done, typename Flow::State& next) {
  const double t = past.back(0).t;
  done.least_end = std::max(done.least_end, least_end(t, done.tau));
  for (;; ++done.rejected) {
    next.t = next_time(steps, t, done.tau);
    const double tau = next.t - t;
    try {
      const double wanted = tau * attempt_step(flow, steps, past, next);
      done.tau = steps.largest_step > 0 ? std::min(steps.largest_step, wanted) : wanted;
      return;
    } catch (const NumericsError&) {
      if (tau / 2 < steps.first_step / 100) throw;
      done.tau = tau / 2;
    }
  }
}

/// A run with a later end resumes from states whose steps do not depend on this end.
template <class State>
bool can_be_resumed(const AdaptiveSteps& steps, const RunPosition& done, const History<State>&) {
  return done.least_end <= steps.end_time;
}
/// Whether the size of the next step depends on the end time already. t: that of the newest state.
inline bool is_last_to_resume(const AdaptiveSteps& steps, const RunPosition& done, double t) {
  return least_end(t, done.tau) > steps.end_time;
}

// The loop.

/// Whether the run continues after this step: it always does if the observer returns nothing.
template <class Observer, class State>
bool goes_on_after(Observer& observe, int n, const State& state) {
  if constexpr (std::is_same_v<decltype(observe(n, state)), bool>) {
    return observe(n, state);
  } else {
    observe(n, state);
    return true;
  }
}

/// @cond

/// Whether a flow or an observer has progress() and resume(json).
template <class Keeper, class = void>
struct KeepsProgress : std::false_type {};
template <class Keeper>
struct KeepsProgress<
    Keeper, std::void_t<decltype(std::declval<Keeper&>().resume(std::declval<Keeper&>().progress()))>>
    : std::true_type {};

/// @endcond

/// A flow or an observer that has progress() and resume(json) is saved and resumed with the run.
template <class Keeper>
void attach_progress(Checkpoint& checkpoint, Keeper& keeper) {
  if constexpr (KeepsProgress<Keeper>::value)
    checkpoint.attach([&keeper] { return keeper.progress(); },
                      [&keeper](const nlohmann::json& saved) { keeper.resume(saved); });
}

/// The steps of a run, those before it was resumed included.
struct StepCount {
  int steps = 0;     ///< how many it has taken
  int rejected = 0;  ///< adaptive: how many it has repeated with a smaller size
};

/// Runs a flow: calls observer(n, state) for n = 0, 1, .., the starting steps included. A flow has a type
/// State (see History) and
///   void step(const BdfStep<State>& step, State& next)
/// that computes `next` (its t is set already, its Fields have the right size and stale values).
///
/// The exact solution is needed for Start::exact with q > 1; without it that start is an InputError.
/// NumericsErrors (of observers too) are rethrown with step and time; a non-finite value in a new state is
/// one too. A flow that has settle(past, next) may change both after each step. An observer that returns
/// false ends the run after this step with a StoppedError. With a checkpoint (none: nullptr) the run resumes
/// where an earlier one had saved its states (after the starting steps), with the same or a later end (given
/// times: the same), and observes the steps from there on. The numbers are the same if `step` depends on its
/// arguments alone, or if the flow's resume(progress()) restores what earlier steps have left in it. The data
/// of observers are saved in the same way. The checkpoint is saved at intervals, when the run is stopped, and
/// at its end; with adaptive steps at the last state whose steps do not depend on the end time. A checkpoint
/// serves one run.
///
/// This function leaves in `past` (empty, of capacity states_kept(steps)) the states at the end, also when
/// the run ends with an error: then those before the step that failed.
template <class Steps = UniformSteps, class Flow, class... Observers>
StepCount integrate_keeping(History<typename Flow::State>& past, Flow& flow, const Steps& steps,
                            const StartingValues<typename Flow::State>& start, Checkpoint* checkpoint,
                            Observers&&... observers) {
  using State = typename Flow::State;
  check_steps(steps);
  const auto observe = [&](int n, const State& state) {
    bool goes_on = true;
    ((goes_on = goes_on_after(observers, n, state) && goes_on), ...);
    return goes_on;
  };
  RunPosition done;
  if constexpr (std::is_same_v<Steps, AdaptiveSteps>) done.tau = steps.first_step;
  State next = start.initial;
  if constexpr (std::is_same_v<Steps, AdaptiveSteps>) next.t = steps.start_time;
  if constexpr (std::is_same_v<Steps, UniformSteps>) next.t = steps.time(0);
  if constexpr (std::is_same_v<Steps, GivenTimes>) next.t = steps.times[0];

  bool is_resumed = false, goes_on = true;
  if (checkpoint) {
    attach_progress(*checkpoint, flow);
    (attach_progress(*checkpoint, observers), ...);
    is_resumed = checkpoint->resume(identity_of_steps(steps), next, past, done,
                                    [&](const RunPosition& saved) { return objection_of_end(steps, saved); });
  }
  if (!is_resumed) {
    StartingValues<State> at_start = start;
    at_start.initial.t = next.t;
    goes_on = take_starting_steps(flow, steps, at_start, observe, past, done);
  }

  while (goes_on && !is_at_end(steps, done, past)) {
    if (checkpoint && can_be_resumed(steps, done, past))
      is_last_to_resume(steps, done, past.back(0).t) ? checkpoint->save(done, past)
                                                     : checkpoint->save_when_due(done, past);
    const int n = done.n + 1;
    at_step(n, next.t, [&] {
      take_next_step(flow, steps, past, done, next);
      settle(flow, past, next);
      goes_on = observe(n, std::as_const(next));
    });
    past.push(next);
    done.n = n;
  }
  if (checkpoint && can_be_resumed(steps, done, past)) checkpoint->save(done, past);
  if (!is_at_end(steps, done, past))
    throw StoppedError(format("stopped at t = %g (step %d)", past.back(0).t, done.n));
  return {done.n, done.rejected};
}

/// The same for a run whose past is not needed afterwards.
template <class Steps = UniformSteps, class Flow, class... Observers>
StepCount integrate(Flow& flow, const Steps& steps, const StartingValues<typename Flow::State>& start,
                    Checkpoint* checkpoint, Observers&&... observers) {
  History<typename Flow::State> past(states_kept(steps));
  return integrate_keeping<Steps>(past, flow, steps, start, checkpoint, observers...);
}

/// The same without checkpoint.
template <class Steps = UniformSteps, class Flow, class... Observers>
StepCount integrate(Flow& flow, const Steps& steps, const StartingValues<typename Flow::State>& start,
                    Observers&&... observers) {
  return integrate<Steps>(flow, steps, start, static_cast<Checkpoint*>(nullptr), observers...);
}

}  // namespace esfem
