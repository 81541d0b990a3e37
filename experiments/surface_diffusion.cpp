// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surface diffusion of an ellipsoid to a sphere of the same volume (kll21 (1.2))
//
// Sample runs:  build/bin/surface_diffusion --preset check --output diffusion.json
//               build/bin/surface_diffusion --settings paper,unprojected --levels 2 --steps 0-3
//               build/bin/surface_diffusion --settings relaxed --levels 0-2 --output relaxed.json
//
// Writes:       results/paper/surface_diffusion.{json,csv,tex}, from which plots/surface_diffusion.py draws
//               figures/gallery/surface_diffusion, and the surfaces as
//               results/paper/cells/surface_diffusion/CELL/surfaces.pvd
//
// The ellipsoid with half axes 2, 1, 1 evolves by V = Delta H on [0, 0.8]: kll21 (3.4)-(3.5) with Q = 0,
// quadratic elements and BDF2. It is the longer one of the two that willmore_relaxation has, (1, 1, 0.6)
// being round to the eye from the start. The volume is constant, the area decreases, and the limit is the
// sphere of radius 2^(1/3). Close to a sphere of radius R the ellipsoidal modes decay by exp(-24 t/R⁴).
// Settings:
//   paper        tau = 0.01 2^-k, projections after each step (§7.1)
//   unprojected  the same without projections
//   adaptive     adaptive BDF2, tau from 1e-6 to 0.008, tolerance 1e-3
//   accurate     the same with tau <= 0.00125, tolerance 2.5e-5: what is left is the error in space
//   relaxed      as adaptive, with the relaxation lambda = 100 of H_h and nu_h towards the geometry
//
// Expected: the scheme conserves int V = 0, not the volume, because nu_h is not the normal of Gamma_h. The
// volume drifts with tau² and, in space, faster than h². Without projections |nu_h| grows, and the drift
// is 30 times as large. The surface stops when H_h is constant, which it is before it is round; with the
// relaxation it becomes round at the rate of the theory.
#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/time/integrate.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const double largest_h = 0.5, limit_radius = std::cbrt(2.0), relaxation = 100;
const HalvedSteps time_steps{0.8, 0.01};

Surface initial_surface() {
  return ellipsoid(2, 1, 1);
}

const std::vector<std::string> known_settings = {"paper", "unprojected", "adaptive", "accurate", "relaxed"};

/// One run; k is the exponent of a fixed step size.
struct Run {
  std::string setting;
  int level, k;

  bool adaptive() const { return setting != "paper" && setting != "unprojected"; }
  double tolerance() const { return setting == "accurate" ? 2.5e-5 : 1e-3; }
  /// The step size, or the largest one.
  HalvedSteps steps() const {
    if (!adaptive()) return time_steps;
    return {time_steps.end_time, setting == "accurate" ? 0.00125 : 0.008};
  }
};

struct Setting {
  int degree, bdf;
  Start start;
  std::vector<std::string> meshes;
  std::vector<Run> runs;
};

/// Adaptive runs have no step size of their own.
void add_runs(const std::vector<std::string>& settings, const std::vector<int>& levels,
              const std::vector<int>& steps, std::vector<Run>& runs) {
  for (const std::string& setting : settings) {
    for (int level : levels) {
      for (int k : steps) {
        const Run run{setting, level, k};
        if (!run.adaptive() || k == steps.front()) runs.push_back(run);
      }
    }
  }
}

std::vector<Run> preset_runs(const std::string& preset) {
  std::vector<Run> runs;
  if (preset == "paper") {
    add_runs({"paper"}, range(0, 2), range(0, 3), runs);
    add_runs({"unprojected"}, {2}, range(0, 3), runs);
    add_runs({"adaptive", "accurate", "relaxed"}, range(0, 2), {0}, runs);
  } else {
    add_runs({"paper", "unprojected"}, {1}, range(0, 2), runs);
    add_runs({"accurate"}, {0}, {0}, runs);
    add_runs({"adaptive", "relaxed"}, {1}, {0}, runs);
  }
  return runs;
}

Setting resolve(const Options& options, const std::vector<std::string>& settings) {
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(2);
  setting.start = options.start.value_or(parse_start("substeps:16"));
  setting.meshes = options.meshes;
  if (setting.start.kind == Start::exact)
    throw InputError(
        "--start exact: no exact solution from an ellipsoid is known; expected cascade or substeps:K");
  if (!options.levels && !options.steps && options.meshes.empty() && settings.empty())
    setting.runs = preset_runs(options.preset);
  else
    add_runs(settings.empty() ? known_settings : settings, mesh_levels(options, {0}),
             options.steps.value_or(std::vector<int>{2}), setting.runs);
  return setting;
}

WillmoreFlow::Variant variant(const Run& run) {
  WillmoreFlow::Variant variant;
  variant.law = WillmoreFlow::Variant::surface_diffusion;
  variant.project = run.setting != "unprojected";
  if (run.setting == "relaxed") variant.relaxation = relaxation;
  return variant;
}

/// Appends the radius of the fitted sphere and the difference of the largest and the smallest distance of a
/// node from the centre, which stays where it is by symmetry.
void record_roundness(const Field& x, Series& series) {
  const Eigen::VectorXd distance = x.rowwise().norm();
  series["radius"].push_back(fitted_sphere_radius(x));
  series["elongation"].push_back(distance.maxCoeff() - distance.minCoeff());
}

/// The first step at or after time t, or the last one.
std::size_t index_at(const Series& series, double t) {
  const std::vector<double>& times = series.at("t");
  const auto found = std::lower_bound(times.begin(), times.end(), t * (1 - 1e-9));
  return std::min<std::size_t>(found - times.begin(), times.size() - 1);
}

/// lambda of elongation = c exp(-lambda t) through the steps at two times.
double decay_rate(const Series& series, double from, double to) {
  const std::size_t i = index_at(series, from), j = index_at(series, to);
  const std::vector<double>&elongation = series.at("elongation"), &t = series.at("t");
  return std::log(elongation[i] / elongation[j]) / (t[j] - t[i]);
}

/// The numbers that claims are about.
void describe_end(Row& row) {
  const Series& series = row.series;
  double drift = 0, rise = 0;
  const std::vector<double>&volume = series.at("volume"), &area = series.at("area");
  for (const double V : volume) drift = std::max(drift, std::abs(V / volume[0] - 1));
  for (std::size_t i = 1; i < area.size(); ++i) rise = std::max(rise, area[i] - area[i - 1]);
  row.errors["volume"]["drift"] = drift;
  row.values["volume_drift"] = drift;
  row.values["largest_area_rise"] = rise;
  if (series.at("t").back() < time_steps.end_time * (1 - 1e-9)) return;
  row.values["radius_off"] = std::abs(series.at("radius").back() / limit_radius - 1);
  row.values["elongation"] = series.at("elongation").back();
  row.values["area_off"] = std::abs(area.back() / (4 * pi * limit_radius * limit_radius) - 1);
  row.values["decay_rate"] = decay_rate(series, 0.5, 0.8);
  row.values["max_nu"] = series.at("max_nu").back();
}

/// Integrates with the steps of the setting; what they were goes into the row.
void integrate_run(const Setting& setting, const Run& run, const WillmoreStart& start, WillmoreFlow& flow,
                   const std::function<void(int, const State&)>& observe, Checkpoint* checkpoint, Row& row) {
  if (run.adaptive()) {
    AdaptiveSteps grid;
    grid.controlled = "u";
    grid.end_time = time_steps.end_time;
    grid.largest_step = row.tau;
    grid.tolerance = run.tolerance();
    const StepCount done = integrate(flow, grid, start.state, checkpoint, observe);
    row.steps = done.steps;
    row.values["rejected_steps"] = done.rejected;
  } else {
    integrate(flow, {setting.bdf, row.tau, row.steps, setting.start}, start.state, checkpoint, observe);
  }
}

std::string cell_name(const Run& run) {
  return format("%s_h%d", run.setting.c_str(), run.level) + (run.adaptive() ? "" : format("_tau%d", run.k));
}

Row run_cell(const Setting& setting, const Run& run, Row row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = initial_surface();
  const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, run.level)); };
  const Mesh mesh = initial_mesh(setting.meshes, run.level, generate, surface, setting.degree);
  const SurfaceSpace space(mesh);
  describe_mesh(mesh, row);

  // 2. The flow, from the exact normal and mean curvature.
  const WillmoreStart start =
      willmore_start_on(space, surface, mesh.nodes, WillmoreFlow::Variant::surface_diffusion, false);
  WillmoreFlow flow(space, variant(run), start.theta);

  // 3. The time steps.
  RunRecorder recorder(space, snapshot_plan(folder, {0.01, 0.05, 0.1, 0.2}, "surface_diffusion", row));
  const auto observe = [&](int n, const State& state) {
    recorder.record(n, state.t, state.x, nodal_fields(state));
    record_roundness(state.x, recorder.series());
  };
  std::optional<Checkpoint> checkpoint = checkpoint_in(folder, cell_name(run));
  if (checkpoint) attach(*checkpoint, recorder);
  row.status = run_to_end(
      [&] { integrate_run(setting, run, start, flow, observe, checkpoint ? &*checkpoint : nullptr, row); },
      recorder);
  if (checkpoint) row.seconds = checkpoint->seconds_before();

  // 4. The row of the table.
  describe_run(recorder, row);
  describe_end(row);
  return row;
}

/// Seconds on one core: a step with what is recorded of it takes about 5 microseconds a node.
double estimated_cost(const Run& run) {
  const double nodes = 740 * std::pow(2.0, run.level), steps = run.steps().count(run.adaptive() ? 0 : run.k);
  return 1.5 * nodes * steps * 5e-6;
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back(
        {cell_name(run), estimated_cost(run),
         [=](const Row& row, const std::string& folder) { return run_cell(setting, run, row, folder); },
         planned_row(run.level, run.steps(), run.adaptive() ? 0 : run.k, {{"setting", run.setting}})});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"initial_surface", initial_surface().name},
          {"end_time", time_steps.end_time},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"start", to_string(setting.start)},
          {"largest_tau", time_steps.largest},
          {"tau", "adaptive: the largest"},
          {"tolerance", "1e-3; accurate: 2.5e-5"},
          {"relaxation", relaxation},
          {"meshes", mesh_parameter(setting.meshes, "generated, edge length 0.5 2^(-level/2)")}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> settings;
  Experiment experiment;
  experiment.stem = "surface_diffusion";
  experiment.paper = "kll21";
  experiment.help =
      "Surface diffusion V = Delta H of the ellipsoid with half axes 2, 1, 1 to t = 0.8 (kll21 (1.2)): area, "
      "volume,\n"
      "radius and snapshots, with fixed steps tau = 0.01 2^-k with and without projections, with adaptive "
      "steps, and with\n"
      "relaxation towards the geometry. Edge lengths 0.5 2^(-j/2), level j = 0, 1, ..; --steps is of the "
      "fixed steps.\n"
      "Without --settings, --levels, --steps, --mesh: the runs of the preset. No units.\n\n"
      "Example: surface_diffusion --settings relaxed --levels 0-2 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--settings", known_settings, settings,
               "paper: fixed steps | unprojected: fixed steps, no projections | adaptive: adaptive "
               "steps | accurate: "
               "small adaptive steps | relaxed: adaptive steps and relaxation");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, settings)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, settings), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
