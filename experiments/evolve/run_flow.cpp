// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/run_flow.hpp"

#include <algorithm>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/mixture.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/diagnostics.hpp"
#include "solver/error.hpp"
#include "solver/flows/coupled_diffusion.hpp"
#include "solver/flows/reaction_diffusion.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

std::optional<ExactEvolution> exact_mean_curvature_solution(const EvolveConfig& config) {
  if (!config.surface) return {};
  const auto& name = config.surface->name;
  const auto& parameters = config.surface->parameters;
  if (name == "sphere") return shrinking_sphere(parameters.at("radius"));
  const bool slides = config.variant.has("tangential") && !config.variant.is("tangential", "none");
  if (name == "angenent_torus")
    return (slides ? homothetic_angenent_torus : shrinking_angenent_torus)(parameters.at("scale"));
  return {};
}

RegularityLimits limits_of(const Run& run, double size_of_u) {
  const auto& asked = run.config.limits;
  RegularityLimits limits = limits_from_start(run.space, run.config.mesh.nodes);
  if (asked.curvature_size) limits.curvature_size = *asked.curvature_size;
  if (asked.radius_ratio) limits.radius_ratio = *asked.radius_ratio;
  if (asked.normal_length) limits.normal_length = *asked.normal_length;
  if (size_of_u > 0) limits.field_size = 1e3 * size_of_u;
  return limits;
}

RegularityLimits limits_of_own_problem(const Run& run, const Field& u, double usual_size) {
  RegularityLimits limits = limits_of(run);
  const double size = std::max(usual_size, u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0.0);
  if (size > 0) limits.field_size = 1e9 * size;
  return limits;
}

void compare_curvature(const Run& run) {
  if (!run.outcome.remark.empty() || !run.config.entry->evolves_curvature) return;
  const auto found = run.recorder.compare_curvature();
  if (!found || !have_parted(run.config, *found)) return;
  run.outcome.remark = curvature_remark(*found, run.recorder.newest().t);
  warn(run.outcome.remark + "; " + run.config.entry->curvature_cure(run.config));
}

namespace {

void look_at_first_step(const Run& run) {
  if (!run.config.entry->slides_nodes) return;
  run.outcome.remark = sliding_remark(run.recorder.series());
  warn(run.outcome.remark);
}

void require_area(const Run& run) {
  if (!run.config.entry->can_shrink_to_nothing) return;
  const Series& series = run.recorder.series();
  std::optional<double> end = extinction_time(series);
  if (run.config.entry->is_mean_curvature_flow) {
    const double latest = latest_end_of_mean_curvature_flow(series);
    if (series.at("t").back() >= latest) end = latest;
  }
  if (end) throw ExtinctionError(extinction(*end, series));
}

/// Of each species its smallest and largest nodal value, and its mass 1ᵀM u.
void record_species(const Field& u, const Field& Mu, Series& series) {
  const std::vector<std::string> names = concentration_names(static_cast<int>(u.cols()));
  for (int l = 0; l < u.cols(); ++l) {
    series["min_" + names[l]].push_back(u.col(l).minCoeff());
    series["max_" + names[l]].push_back(u.col(l).maxCoeff());
    series["mass_" + names[l]].push_back(Mu.col(l).sum());
  }
}

}  // namespace

Watch::Watch(const Run& run, double start, double end, double tau, int starting_steps, int substeps)
    : run_(run),
      stop_(run.config, run.space),
      lines_(run.config.series),
      progress_(start, end, tau, starting_steps, substeps) {}

Watch::Watch(const Run& run, const UniformSteps& steps)
    : Watch(run, steps.time(0), steps.time(steps.steps), steps.tau,
            run.config.history.is_object() ? 0 : std::min(steps.order - 1, steps.steps),
            steps.start.substeps_per_step) {}

bool Watch::look_at_step(int n, double t) {
  const EvolveConfig& config = run_.config;
  const bool is_last = config.adaptive ? t >= config.adaptive->end_time : n == config.grid.steps;
  if (is_csv(config.series)) lines_.append(run_.recorder.series());
  progress_.show(format("step %d", n), t);
  if (n == 1) look_at_first_step(run_);
  if (n % steps_between_comparisons == 0) compare_curvature(run_);
  run_.outcome.ended = stop_.reason(run_.recorder, n);
  if (run_.outcome.ended.empty()) require_area(run_);
  if (is_last && !config.adaptive) run_.recorder.finish();
  if (run_.outcome.ended.empty() && n > 0 && !is_last && stop_.is_time_over()) {
    run_.outcome.is_unfinished = true;
    run_.outcome.ended = format("seconds: %g are over at t = %g (step %d)", *config.stop.seconds, t, n);
  }
  return stop_signal() == 0 && run_.outcome.ended.empty();
}

UniformSteps steps_of(const Run& run, bool has_exact_solution) {
  UniformSteps steps = run.config.grid;
  if (!run.config.start_given && !has_exact_solution) steps.start = parse_start("substeps:16");
  return steps;
}

void record_more(const Run& run, const ReactionDiffusionState& state) {
  record_species(state.u, state.Mu, run.recorder.series());
}

void record_more(const Run& run, const CoupledDiffusionState& state) {
  record_species(state.u, state.Mu, run.recorder.series());
}

void record_more(const Run& run, const CahnHilliardState& state) {
  Series& series = run.recorder.series();
  series["mass"].push_back(state.Mu.sum());
  const double epsilon = run.config.parameters.number("epsilon");
  series["energy"].push_back(
      run.config.formulas.contains("potential")
          ? mixture_of(run.config).energy(run.space, state.t, state.x, state.u, epsilon)
          : ginzburg_landau_energy(run.space, state.x, state.u, epsilon));
}

}  // namespace esfem
