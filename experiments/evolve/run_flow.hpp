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
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// A run: its configuration, and its records.
struct Run {
  const EvolveConfig& config;
  const SurfaceSpace& space;
  RunRecorder& recorder;
  Checkpoint* checkpoint;
  std::string& remark;  ///< for the status: empty, or that nu and H deviate from the surface
};

/// The exact solution under mean curvature flow of the surfaces that have one.
std::optional<ExactEvolution> exact_mean_curvature_solution(const EvolveConfig& config);

/// The limits of a run; size_of_u: of the concentrations on the surface, if there are any.
RegularityLimits limits_of(const Run& run, double size_of_u = 0);

/// Warns once that nu and H of the flow are no longer those of the surface.
void compare_curvature(const Run& run);

/// Checks after step n, when it is recorded. Returns whether the run continues, that is, no signal has
/// arrived. Throws ExtinctionError if a shrinking surface will have no area left for the next step.
bool look_at_step(const Run& run, int n, double t);

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

/// Integrates from the start and records every step.
template <class Flow>
void run_flow(Flow&& flow, const Run& run, const typename std::decay_t<Flow>::State& initial,
              const std::function<typename std::decay_t<Flow>::State(double t)>& exact = {}) {
  using State = typename std::decay_t<Flow>::State;
  const auto observe = [&](int n, const State& state) {
    run.recorder.record(n, state);
    record_more(run, state);
    return look_at_step(run, n, state.t);
  };
  if (run.config.adaptive) {
    AdaptiveSteps steps = *run.config.adaptive;
    steps.controlled = controlled<State>;
    steps.units = units_of_controlled<State>(run.space.length());
    integrate(flow, steps, initial, run.checkpoint, observe);
  } else {
    integrate(flow, steps_of(run, exact != nullptr), {initial, exact}, run.checkpoint, observe);
  }
}

}  // namespace esfem
