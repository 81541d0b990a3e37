// SPDX-License-Identifier: GPL-3.0-or-later
// How entries run their flows.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/entry.hpp"
#include "experiments/evolve/exact.hpp"
#include "experiments/evolve/history.hpp"
#include "experiments/evolve/series_lines.hpp"
#include "experiments/evolve/stop.hpp"
#include "experiments/harness/progress.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

struct CoupledDiffusionState;
struct ReactionDiffusionState;

/// What a run says at its end beside its records.
struct Outcome {
  std::string remark;          ///< for the status: empty, or the first thing that is doubtful
  std::string ended;           ///< why it ended before its last step, as "stop" asks; empty: it did not
  bool is_unfinished = false;  ///< its time was over
  nlohmann::json history;      ///< for the nodal output; null: none
};

/// A run: its configuration, and its records.
struct Run {
  const EvolveConfig& config;
  const SurfaceSpace& space;
  RunRecorder& recorder;
  Checkpoint* checkpoint;
  Outcome& outcome;
  ErrorRecorder* errors = nullptr;  ///< against the flow's exact solution; none: not wanted
};

/// The exact solution under mean curvature flow of the surfaces that have one.
std::optional<ExactEvolution> exact_mean_curvature_solution(const EvolveConfig& config);

/// The limits of a run; size_of_u: of the concentrations on the surface, if there are any.
RegularityLimits limits_of(const Run& run, double size_of_u = 0);
/// Those of kinetics and mixtures, which may start from traces u of a species: only values that no solution
/// has, 1e9 times those at the start or usual_size, end a run.
RegularityLimits limits_of_own_problem(const Run& run, const Field& u, double usual_size = 0);

/// Warns once that nu and H of the flow are no longer those of the surface.
void compare_curvature(const Run& run);

/// What looks at each step of a run, shows how far it has come, and writes the series as CSV.
class Watch {
 public:
  Watch(const Run& run, double start, double end) : Watch(run, start, end, 0, 0, 1) {}
  explicit Watch(const Run& run, const UniformSteps& steps);

  /// Before a step is recorded.
  void look_before() { stop_.look_before(run_.recorder); }
  /// When step n is recorded. Returns whether the run continues: no signal has arrived, and "stop" does not
  /// ask for the end. Throws ExtinctionError if a shrinking surface will have no area left for the next step.
  bool look_at_step(int n, double t);
  /// After a substep of the starting steps.
  void look_at_substep(double t) { progress_.show("starting steps", t); }

 private:
  Watch(const Run& run, double start, double end, double tau, int starting_steps, int substeps);

  const Run& run_;
  StopRule stop_;
  SeriesLines lines_;
  RunProgress progress_;
};

/// Equal steps as asked for; the start, where none is asked for, depends on whether a solution is known.
UniformSteps steps_of(const Run& run, bool has_exact_solution);

/// The field that adaptive steps follow: u where the flow has one, else the positions.
template <class State, class = void>
constexpr const char* controlled = "x";
template <class State>
constexpr const char* controlled<State, std::void_t<decltype(&State::u)>> = "u";

/// The units of its components on a surface with length L: L for positions, 1/L for H, none for normals and
/// u.
template <class State>
std::vector<double> units_of_controlled(double L) {
  if constexpr (std::is_same_v<State, MeanCurvatureFlow::State>) return {1, 1, 1, 1 / L};
  if constexpr (std::is_same_v<State, WillmoreFlow::State>) return {1 / L, 1, 1, 1};
  return controlled<State>[0] == 'x' ? std::vector<double>(3, L) : std::vector<double>();
}

/// Series of a flow in addition to those of its surface.
template <class State>
void record_more(const Run&, const State&) {}
void record_more(const Run& run, const CahnHilliardState& state);
void record_more(const Run& run, const ReactionDiffusionState& state);
void record_more(const Run& run, const CoupledDiffusionState& state);
void record_more(const Run& run, const WillmoreFlow::State& state);

/// The errors of a state against the exact solution, among the series.
template <class State>
void record_errors(const Run& run, const State& state) {
  run.errors->record(state);
  for (const auto& [name, values] : run.errors->series())
    if (name != "t") run.recorder.series()[name].push_back(values.back());
}

/// Integrates from the start, or from where the history of an earlier run ends, and records every step.
template <class Flow>
void run_flow(Flow&& flow, const Run& run, const typename std::decay_t<Flow>::State& initial,
              const std::function<typename std::decay_t<Flow>::State(double t)>& exact = {}) {
  using State = typename std::decay_t<Flow>::State;
  ExactFormulas exact_formulas(run.config, run.space);
  const auto integrate_watched = [&](Watch& watch, const auto& steps, auto start, History<State>& past) {
    start.after_substep = [&](double t) { watch.look_at_substep(t); };
    integrate_keeping(past, flow, steps, start, run.checkpoint, [&](int n, const State& state) {
      watch.look_before();
      run.recorder.record(n, state);
      if (!exact_formulas.empty())
        exact_formulas.record(state.t, state.x, nodal_fields(state), run.recorder.series());
      if (run.errors) record_errors(run, state);
      record_more(run, state);
      return watch.look_at_step(n, state.t);
    });
  };
  if (run.config.adaptive) {
    AdaptiveSteps steps = *run.config.adaptive;
    steps.controlled = controlled<State>;
    steps.units = units_of_controlled<State>(run.space.length());
    Watch watch(run, steps.start_time, steps.end_time);
    History<State> past(states_kept(steps));
    integrate_watched(watch, steps, StartingValues<State>(initial), past);
    return;
  }
  const UniformSteps steps = steps_of(run, exact != nullptr);
  StartingValues<State> start(initial, exact);
  if (run.config.history.is_object()) start_from_history(run.config, initial, flow, start);
  Watch watch(run, steps);
  History<State> past(states_kept(steps));
  const auto keep_history = [&] {
    if (!run.config.nodal_has_history || run.recorder.empty()) return;
    const RunRecorder::Surface& newest = run.recorder.newest();
    run.outcome.history = history_of(run.config, steps, newest.step, newest.t, flow, past);
  };
  try {
    integrate_watched(watch, steps, start, past);
  } catch (const std::exception&) {
    keep_history();
    throw;
  }
  keep_history();
}

}  // namespace esfem
