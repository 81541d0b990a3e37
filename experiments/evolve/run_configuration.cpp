// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/run_configuration.hpp"

#include <signal.h>

#include <chrono>
#include <optional>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/files.hpp"
#include "experiments/evolve/start.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

using nlohmann::json;

std::optional<Checkpoint> checkpoint_of(const EvolveConfig& config, const json& config_json,
                                        RunRecorder& recorder, bool is_seen) {
  if (config.checkpoint.empty()) return {};
  std::optional<Checkpoint> checkpoint =
      Checkpoint(config.checkpoint, run_identity(config, config_json), checkpoint_seconds(), warn);
  if (is_seen) checkpoint->start_afresh_when_unusable();
  attach(*checkpoint, recorder);
  return checkpoint;
}

/// The status of a run that ended with an error: extinct if a shrinking surface had no area left for the
/// step.
std::string end_of(const EvolveConfig& config, RunRecorder& recorder, const NumericsError& error) {
  const bool extinct = dynamic_cast<const ExtinctionError*>(&error) != nullptr;
  if (extinct || recorder.empty()) return error.what();
  if (config.entry->can_shrink_to_nothing) {
    if (const std::optional<double> end = extinction_time(recorder.series(), 3))
      return extinction(*end, recorder.series()) + "; the next step: " + error.what();
  }
  if (dynamic_cast<const ToleranceError*>(&error))
    return std::string(error.what()) +
           format("; try a larger tolerance, or a smaller first_step, such as %.2g",
                  config.adaptive->first_step / 100);
  const std::string large_step = large_step_remark(config, recorder.series());
  return std::string(error.what()) + "; " +
         (large_step.empty() ? mesh_failure_remark(config, recorder.series()) : large_step) +
         config.entry->cure(config);
}

/// The status of a run that a signal has stopped.
std::string stopped_status(const RunRecorder& recorder) {
  return format("stopped by signal %s at t = %g (step %d)", stop_signal() == SIGINT ? "SIGINT" : "SIGTERM",
                recorder.newest().t, recorder.newest().step);
}

/// Runs the flow; returns the status. Throws what ends it early.
std::string run_to_end(const Run& run) {
  try {
    run.config.entry->run(run);
  } catch (const StoppedError&) {
    if (run.outcome.ended.empty()) throw;
  }
  compare_curvature(run);
  const std::string& remark = run.outcome.remark;
  const std::string status = run.outcome.ended.empty() ? "ok" : run.outcome.ended;
  return remark.empty() ? status : status + ", but " + remark;
}

}  // namespace

void run_configuration(const EvolveConfig& config, const json& description, const json& origin,
                       const SeeRun& see) {
  const auto begin = std::chrono::steady_clock::now();
  prepare_outputs(config, description, config.source);
  for (const std::string& remark : config.mesh_remarks) warn(remark);
  warn(thin_elements_remark(config.mesh, config.mesh_origin));
  const SurfaceSpace space(config.mesh, config.rule);
  SnapshotPlan plan = config.snapshots;
  plan.run = {config.entry->flow, description.dump()};
  plan.origin = config.origin;
  RunRecorder recorder(
      space, plan,
      config.entry->records_kappa_energy ? RunRecorder::of_flow_and_surface : RunRecorder::of_the_flow);
  std::optional<Checkpoint> checkpoint = checkpoint_of(config, description, recorder, bool(see));
  warn(start_remark(config));
  warn(curvature_start_remark(config));
  Outcome outcome;
  if (checkpoint)
    checkpoint->attach([&] { return json(outcome.remark); },
                       [&](const json& saved) { outcome.remark = saved.get<std::string>(); });
  std::optional<ExactEvolution> exact;
  std::optional<ErrorRecorder> errors;
  if (see && config.entry->exact_solution && !config.formulas.contains("exact"))
    exact = config.entry->exact_solution(config);
  if (exact) errors.emplace(space, *exact, config.mesh.nodes);
  const Run asked = {
      config, space, recorder, checkpoint ? &*checkpoint : nullptr, outcome, errors ? &*errors : nullptr};
  std::vector<std::string> failures;
  const auto write = [&](const std::string& status) {
    failures = write_outputs(asked, status, description, origin, failures);
    if (see) see(asked, status);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (!failures.empty() || see) return;
    const std::string more = outcome.is_unfinished ? how_to_go_on(asked, failures) : "";
    warn(joined({outcome.ended, more, summary(asked, elapsed.count())}));
  };
  note_stop_signals();
  try {
    write(run_to_end(asked));
  } catch (const NumericsError& error) {
    const std::string status = end_of(config, recorder, error);
    if (!recorder.empty()) write(status);
    if (!failures.empty()) warn(joined({joined(failures), how_to_go_on(asked, failures)}));
    throw NumericsError(status);
  } catch (const StoppedError&) {
    const std::string status = stopped_status(recorder);
    write(status);
    throw StoppedError(joined({status, joined(failures), how_to_go_on(asked, failures)}));
  } catch (const InputError& error) {
    if (recorder.empty()) throw;
    failures = {error.what()};
    write(format("stopped at t = %g: %s", recorder.newest().t, error.what()));
  }
  if (!failures.empty()) throw InputError(joined({joined(failures), how_to_go_on(asked, failures)}));
}

}  // namespace esfem
