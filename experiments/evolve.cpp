// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any flow on any surface or mesh, from a JSON file
//
// Sample runs:  build/bin/evolve reference/examples/sphere.json
//               build/bin/evolve reference/examples/dumbbell.json
//               build/bin/evolve reference/examples/tumour.json
//               build/bin/evolve reference/examples/willmore.json
//               build/bin/evolve reference/examples/genus2.json
//               build/bin/evolve reference/examples/turing.json
//
// Writes the nodal values at the end, a time series and snapshots, as the file says; `evolve --help` explains
// its keys.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/config.hpp"
#include "experiments/evolve/files.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/provenance.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"
#include "solver/thread_count.hpp"

namespace {

using namespace esfem;
using nlohmann::json;

std::optional<Checkpoint> checkpoint_of(const EvolveConfig& config, const json& config_json,
                                        RunRecorder& recorder) {
  if (config.checkpoint.empty()) return {};
  std::optional<Checkpoint> checkpoint =
      Checkpoint(config.checkpoint, run_identity(config, config_json), checkpoint_seconds(), warn);
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
  return std::string(error.what()) + "; " + config.entry->cure(config);
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

int evolve(const std::string& file, const json& origin) {
  const auto begin = std::chrono::steady_clock::now();
  const json config_json = read_json(file);
  const EvolveConfig config = evolve_config(config_json, file);
  prepare_outputs(config, config_json, file);
  for (const std::string& remark : config.mesh_remarks) warn(remark);
  warn(thin_elements_remark(config.mesh, config.mesh_origin));
  const SurfaceSpace space(config.mesh, config.rule);
  SnapshotPlan plan = config.snapshots;
  plan.run = {config.entry->flow, config_json.dump()};
  plan.origin = config.origin;
  RunRecorder recorder(
      space, plan,
      config.entry->records_kappa_energy ? RunRecorder::of_flow_and_surface : RunRecorder::of_the_flow);
  std::optional<Checkpoint> checkpoint = checkpoint_of(config, config_json, recorder);
  warn(start_remark(config));
  warn(curvature_start_remark(config));
  Outcome outcome;
  if (checkpoint)
    checkpoint->attach([&] { return json(outcome.remark); },
                       [&](const json& saved) { outcome.remark = saved.get<std::string>(); });
  const Run asked = {config, space, recorder, checkpoint ? &*checkpoint : nullptr, outcome};
  std::vector<std::string> failures;
  const auto write = [&](const std::string& status) {
    failures = write_outputs(asked, status, config_json, origin, failures);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (!failures.empty()) return;
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
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] {
    std::string file;
    int threads = 1;
    bool schema = false;
    CommandLine line(
        "Evolves a surface: flow, surface or mesh, and method come from a JSON file.\n"
        "Example: evolve reference/examples/sphere.json\n\n" +
            evolve_config_help(),
        "evolve");
    line.optional_argument("config", file, "the configuration", "CONFIG.json");
    line.flag("--schema", schema,
              "print the keys of a configuration as JSON Schema; editors complete a configuration that "
              "has \"$schema\": \"schema.json\"");
    line.integer("--threads", 1, 1024, threads, "threads that the factorisations may use");
    if (!line.parse(argc, argv)) return static_cast<int>(exit_done);
    if (schema) {
      std::cout << evolve_schema().dump(1) << std::endl;
      return static_cast<int>(exit_done);
    }
    if (file.empty()) throw InputError("config is required: expected CONFIG.json (see --help)");
    set_thread_count(threads);
    return evolve(file, provenance(argc, argv));
  });
}
