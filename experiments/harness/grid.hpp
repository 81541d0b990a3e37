// SPDX-License-Identifier: GPL-3.0-or-later
// Common parts of the experiments' grids of runs: step sizes, mesh levels, initial surfaces, and their
// entries in a row.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/choice.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// The edge length of a level, largest 2^(-level/2): each level has twice as many triangles as the one
/// before.
double edge_length(double largest, int level);

/// Throws InputError that names --levels unless every level is less than count, the number of what `counted`
/// says ("--mesh files").
void require_levels(const std::vector<int>& levels, int count, const std::string& counted);

/// The initial surface of a run, from files[level], or made by `generate` when there are no files: elements
/// of the given degree with their nodes on the surface. Changes by the reader of a file are printed as a
/// warning.
Mesh initial_mesh(const std::vector<std::string>& files, int level, const std::function<Mesh()>& generate,
                  const Surface& surface, int degree);

/// The same for a run: its files, level and degree.
Mesh initial_mesh(const Choice& choice, const std::function<Mesh()>& generate, const Surface& surface);

/// The entry on the meshes in the parameters of a table: the files, or `generated` when there are none.
nlohmann::json mesh_parameter(const std::vector<std::string>& files, const std::string& generated);

/// The row of a run as it is known beforehand, with its labels.
Row planned_row(int level, const HalvedSteps& steps, int k, nlohmann::json labels = nlohmann::json::object());

/// Fills in h and nodes.
void describe_mesh(const Mesh& mesh, Row& row);

/// Snapshots at the given times as surfaces.pvd in the folder of a run; none without folder. They say what
/// the flow is, by its name in `evolve`, and what the row says beforehand: mesh, step size and labels.
SnapshotPlan snapshot_plan(const std::string& folder, const std::vector<double>& times,
                           const std::string& flow, const Row& row);

/// Integrates a flow whose steps are recorded, and finishes the recorder. Returns the status of the row:
/// "ok", or why the run ended before its time. A NumericsError of a run without any recorded step passes
/// through.
std::string run_to_end(const std::function<void()>& integrate, RunRecorder& recorder);

/// The seconds between two checkpoints of a run: 30, or the environment's ESFEM_CHECKPOINT_SECONDS (0: at
/// every step), by which tests/crash finds checkpoints in short runs.
double checkpoint_seconds();

/// The checkpoint in the folder of a run, from which the cell resumes when it is started again; a checkpoint
/// of another cell or another build of the program is not used. run_experiment removes it when the row is
/// written. None without folder.
std::optional<Checkpoint> checkpoint_in(const std::string& folder, const std::string& cell);

/// Integrates a flow, with a checkpoint in the folder of the run, to its end, its singularity, or the step
/// after which an observer ends it: observers as for integrate, of which one records. Fills in status, steps,
/// seconds, series and snapshots; of adaptive steps also the value "rejected_steps".
template <class Flow, class Steps, class... Observers>
void run_recorded(Flow& flow, const Steps& steps, const StartingValues<typename Flow::State>& start,
                  const std::string& folder, RunRecorder& recorder, Row& row, Observers&&... observers);

/// Fills in the series, and the list "snapshots" of {"t", "file"} when there are some.
void describe_run(RunRecorder& recorder, Row& row);

template <class Flow, class Steps, class... Observers>
void run_recorded(Flow& flow, const Steps& steps, const StartingValues<typename Flow::State>& start,
                  const std::string& folder, RunRecorder& recorder, Row& row, Observers&&... observers) {
  std::optional<Checkpoint> checkpoint = checkpoint_in(folder, row.cell);
  if (checkpoint) attach(*checkpoint, recorder);
  const auto to_the_end = [&] {
    try {
      const StepCount done = integrate(flow, steps, start, checkpoint ? &*checkpoint : nullptr, observers...);
      row.steps = done.steps;
      if (std::is_same_v<Steps, AdaptiveSteps>) row.values["rejected_steps"] = done.rejected;
    } catch (const StoppedError&) {
      if (stop_signal() != 0) throw;
      row.steps = recorder.newest().step;
    }
  };
  row.status = run_to_end(to_the_end, recorder);
  if (checkpoint) row.seconds = checkpoint->seconds_before();
  describe_run(recorder, row);
}

}  // namespace esfem
