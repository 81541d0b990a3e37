// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/grid.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "experiments/harness/provenance.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"

namespace esfem {

double edge_length(double largest, int level) {
  return largest * std::pow(2.0, -0.5 * level);
}

void require_levels(const std::vector<int>& levels, int count, const std::string& counted) {
  for (int level : levels) {
    if (level >= count) {
      throw InputError(format("--levels: found %d, expected less than %d, the number of %s", level, count,
                              counted.c_str()));
    }
  }
}

Mesh initial_mesh(const std::vector<std::string>& files, int level, const std::function<Mesh()>& generate,
                  const Surface& surface, int degree) {
  Mesh mesh = lagrange_mesh(files.empty() ? generate() : mesh_from_file(files.at(level)), degree);
  project_nodes(mesh, surface);
  return mesh;
}

Mesh initial_mesh(const Choice& choice, const std::function<Mesh()>& generate, const Surface& surface) {
  return initial_mesh(choice.meshes(), choice.level(), generate, surface, choice.degree());
}

nlohmann::json mesh_parameter(const std::vector<std::string>& files, const std::string& generated) {
  return files.empty() ? nlohmann::json(generated) : nlohmann::json(files);
}

Row planned_row(int level, const HalvedSteps& steps, int k, nlohmann::json labels) {
  Row row;
  row.level = level;
  row.tau = steps.tau(k);
  row.steps = steps.count(k);
  row.labels = std::move(labels);
  return row;
}

void describe_mesh(const Mesh& mesh, Row& row) {
  row.h = mesh_quality(mesh.elements, mesh.nodes).h;
  row.nodes = static_cast<int>(mesh.nodes.rows());
}

SnapshotPlan snapshot_plan(const std::string& folder, const std::vector<double>& times,
                           const std::string& flow, const Row& row) {
  if (folder.empty()) return {};
  nlohmann::json configuration = row.labels;
  configuration.update(
      {{"level", row.level}, {"h", row.h}, {"nodes", row.nodes}, {"tau", row.tau}, {"steps", row.steps}});
  return {folder + "/surfaces.pvd", times, 0, {flow, configuration.dump()}};
}

std::string run_to_end(const std::function<void()>& integrate, RunRecorder& recorder) {
  std::string status = "ok";
  try {
    integrate();
  } catch (const SingularityError& singularity) {
    status = singularity.what();
  } catch (const NumericsError& error) {
    if (recorder.empty()) throw;
    status = std::string("failed: ") + error.what();
  }
  recorder.finish();
  return status;
}

double checkpoint_seconds() {
  const char* asked = std::getenv("ESFEM_CHECKPOINT_SECONDS");
  return asked ? std::atof(asked) : 30;
}

std::optional<Checkpoint> checkpoint_in(const std::string& folder, const std::string& cell) {
  if (folder.empty()) return {};
  std::optional<Checkpoint> checkpoint = Checkpoint(
      checkpoint_file(folder), {{"cell", cell}, {"build", build_identity()}}, checkpoint_seconds(), warn);
  checkpoint->start_afresh_when_unusable();
  return checkpoint;
}

void describe_run(RunRecorder& recorder, Row& row) {
  row.series = recorder.series();
  for (const RunRecorder::Snapshot& snapshot : recorder.snapshots())
    row.more["snapshots"].push_back({{"t", snapshot.t}, {"file", snapshot.file}});
}

}  // namespace esfem
