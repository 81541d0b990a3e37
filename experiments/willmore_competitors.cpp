// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow by three schemes side by side: kll21 (3.4)-(3.5), Dziuk's (2.13) of 2008, and that of
// Barrett, Garcke and Nürnberg of 2008, (2.14)
//
// Sample runs:  build/bin/willmore_competitors --preset check --output competitors.json
//               build/bin/willmore_competitors --surfaces sphere --schemes kll21,bgn --degree 2 --steps 0-4
//
// Writes:       results/paper/willmore_competitors.{json,csv,tex}, from which plots/willmore_competitors.py
// draws
//               figures/gallery/willmore_competitors
//
// The unit sphere and the Clifford torus with radii 1 and 2^(-1/2) stay where they are, so that errors are
// known; an ellipsoid (1, 1, 0.6) becomes rounder. All schemes take backward Euler steps of the same size on
// the same meshes, with elements of degree 1 and 2 (the theory of kll21 begins with 2). nu and H of the older
// schemes, which have none or only H, are those of the discrete surface. The nodes of Dziuk's scheme and of
// BGN's move along the surface, which counts as an error of x; `distance` is that of the nodes from the exact
// surface. Energies are recorded 50 times a run. Linear elements on the sphere also on finer meshes: do the
// schemes converge?
//
// Expected: the older schemes move to a discrete surface of smaller discrete energy, kll21 stays where it is,
// nearer by a factor of 100 and more. Dziuk's scheme with elements of degree 2 needs tau <= h²/1000 or less,
// the others do not. With linear elements BGN's nodes go on sliding by the same way in each step, however
// small it is.
#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/harness/distance.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/timed.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/bgn_willmore_flow.hpp"
#include "solver/flows/dziuk_willmore_flow.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const double minor_radius = std::sqrt(0.5);
const int recorded_steps = 50;

/// A surface to start from, its meshes and step sizes, and the energy that the flow tends to.
struct Case {
  std::string name;
  Surface surface;
  double largest_h;
  HalvedSteps time_steps;
  double limit;
  std::optional<ExactEvolution> exact;  ///< of the surfaces that stay where they are
};

std::vector<Case> known_cases() {
  return {
      {"sphere", sphere(1), 0.5, {0.02, 1e-3}, 8 * pi, stationary_sphere(1)},
      {"clifford_torus",
       torus(1, minor_radius),
       0.28,
       {0.005, 1e-3},
       4 * pi * pi,
       stationary_torus(1, minor_radius)},
      {"ellipsoid", ellipsoid(1, 1, 0.6), 0.35, {0.02, 1e-3}, 8 * pi, {}},
  };
}

template <class Range>
std::vector<std::string> names(const Range& cases) {
  std::vector<std::string> list;
  for (const auto& entry : cases) list.push_back(entry.name);
  return list;
}

const std::vector<std::string> known_schemes = {"kll21", "dziuk", "bgn"};

/// One run. Each level of the mesh has twice as many triangles as the one before; k is the exponent of the
/// step size.
struct Run {
  Case start;
  std::string scheme;
  int degree, level, k;
};

struct OwnOptions {
  std::vector<std::string> surfaces, schemes;
};

struct Setting {
  std::vector<Run> runs;
};

void add_runs(const std::vector<std::string>& surfaces, const std::vector<std::string>& schemes,
              const std::vector<int>& degrees, const std::vector<int>& levels, const std::vector<int>& steps,
              std::vector<Run>& runs) {
  for (const Case& start : known_cases()) {
    if (std::find(surfaces.begin(), surfaces.end(), start.name) == surfaces.end()) continue;
    for (const std::string& scheme : schemes)
      for (const int degree : degrees)
        for (const int level : levels)
          for (const int k : steps) runs.push_back({start, scheme, degree, level, k});
  }
}

std::vector<Run> preset_runs(const std::string& preset) {
  std::vector<Run> runs;
  const std::vector<std::string> bgn = {"bgn"}, kll21 = {"kll21"}, all = known_schemes;
  const auto add = [&](const char* surface, const std::vector<std::string>& schemes, int degree, int k) {
    add_runs({surface}, schemes, {degree}, {0}, {k}, runs);
  };
  add("sphere", all, 1, 3);
  add("sphere", all, 2, 3);
  add("ellipsoid", all, 1, 3);
  add("ellipsoid", all, 2, 0);
  for (const int k : range(0, preset == "paper" ? 4 : 2)) add("clifford_torus", bgn, 1, k);
  if (preset == "paper") {
    add("ellipsoid", all, 2, 5);
    add("clifford_torus", all, 1, 5);
    add("clifford_torus", all, 2, 5);
    add("clifford_torus", all, 2, 0);
    add_runs({"sphere"}, all, {1}, range(0, 2), {2}, runs);  // whether the schemes converge
  } else {
    add("clifford_torus", kll21, 2, 3);
  }
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  if (!options.meshes.empty() || options.bdf || options.start) {
    throw InputError(
        "--mesh, --bdf, --start: all schemes run with backward Euler steps on generated meshes; expected "
        "--surfaces, --schemes, --degree, --levels, --steps");
  }
  Setting setting;
  if (!options.levels && !options.steps && !options.degree && own.surfaces.empty() && own.schemes.empty())
    setting.runs = preset_runs(options.preset);
  else
    add_runs(own.surfaces.empty() ? names(known_cases()) : own.surfaces,
             own.schemes.empty() ? known_schemes : own.schemes,
             options.degree ? std::vector<int>{*options.degree} : std::vector<int>{1, 2},
             options.levels.value_or(range(0, 0)), options.steps.value_or(std::vector<int>{3}), setting.runs);
  return setting;
}

/// Runs the flow by backward Euler steps, about `recorded_steps` of which are recorded.
template <class Flow>
void run_flow(Flow&& flow, const typename Flow::State& initial, const SurfaceSpace& space,
              const Surface& surface, ErrorRecorder* errors, RunRecorder& recorder, Row& row) {
  using State = typename Flow::State;
  Timed<Flow> timed{flow};
  const int every = std::max(1, row.steps / recorded_steps);
  int taken = 0;
  row.status = run_to_end(
      [&] {
        integrate(timed, {1, row.tau, row.steps, Start{}}, initial, [&](int n, const State& state) {
          taken = n;
          if (n % every != 0 && n != row.steps) return;
          recorder.record(n, state.t, state.x, nodal_fields(state));
          if (!errors) return;
          errors->record(state);
          recorder.series()["distance"].push_back(distance(surface, state.x));
        });
      },
      recorder);
  if (taken > 0) row.values["seconds_per_step"] = timed.seconds / taken;
}

/// The numbers that claims are about.
void describe_end(const Run& run, Row& row) {
  const Series& series = row.series;
  row.values["last_t"] = series.at("t").back();
  row.values["worst_angle"] = series.at("worst_angle").back();
  for (const std::string energy : {"kappa_energy", "willmore_energy"}) {
    const std::vector<double>& values = series.at(energy);
    double rise = 0;
    for (std::size_t i = 1; i < values.size(); ++i) rise = std::max(rise, values[i] - values[i - 1]);
    row.values[energy] = values.back();
    row.values[energy + "_excess"] = values.back() - run.start.limit;
    row.values[energy + "_rise"] = rise;
  }
  for (const char* name : {"x_nodal_L2", "x_nodal_H1", "distance"})
    if (series.count(name)) row.values[name] = series.at(name).back();
}

Row run_cell(const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it; that of BGN for P1 is lumped.
  const Surface& surface = run.start.surface;
  const auto generate = [&] { return generate_mesh(surface, edge_length(run.start.largest_h, run.level)); };
  const Mesh mesh = initial_mesh({}, 0, generate, surface, run.degree);
  const bool lumped = run.scheme == "bgn" && run.degree == 1;
  const SurfaceSpace space(mesh, lumped ? vertex_quadrature() : default_quadrature(run.degree));
  describe_mesh(mesh, row);

  // 2. The flow, with what is recorded of it.
  RunRecorder recorder(space, {}, RunRecorder::of_flow_and_surface);
  std::optional<ErrorRecorder> errors;
  if (run.start.exact) errors.emplace(space, *run.start.exact, mesh.nodes);
  ErrorRecorder* recorded_errors = errors ? &*errors : nullptr;
  if (run.scheme == "kll21") {
    const WillmoreStart start =
        willmore_start_on(space, surface, mesh.nodes, WillmoreFlow::Variant::willmore, false);
    run_flow(WillmoreFlow(space, {}, start.theta), start.state, space, surface, recorded_errors, recorder,
             row);
  } else if (run.scheme == "dziuk") {
    run_flow(DziukWillmoreFlow(space), dziuk_willmore_state_on(space, mesh.nodes), space, surface,
             recorded_errors, recorder, row);
  } else {
    run_flow(BgnWillmoreFlow(space), bgn_willmore_state_on(space, mesh.nodes), space, surface,
             recorded_errors, recorder, row);
  }

  // 3. The row of the table.
  describe_run(recorder, row);
  if (errors) {
    row.errors = errors->maxima();
    for (const char* name : {"x_nodal_L2", "x_nodal_H1"}) row.series[name] = errors->series().at(name);
  }
  describe_end(run, row);
  return row;
}

std::string cell_name(const Run& run) {
  return format("%s_%s_p%d_h%d_tau%d", run.start.name.c_str(), run.scheme.c_str(), run.degree, run.level,
                run.k);
}

/// Seconds on one core: Dziuk's scheme has a system for six unknowns a node, BGN's for four.
double estimated_cost(const Run& run) {
  const double h = edge_length(run.start.largest_h, run.level),
               nodes = 25 * run.degree * run.degree / (h * h);
  return nodes * run.start.time_steps.count(run.k) * (run.scheme == "kll21" ? 5e-6 : 40e-6 * run.degree);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back(
        {cell_name(run), estimated_cost(run),
         [=](const Row& row, const std::string&) { return run_cell(run, row); },
         planned_row(run.level, run.start.time_steps, run.k,
                     {{"surface", run.start.name}, {"scheme", run.scheme}, {"degree", run.degree}})});
  }
  return list;
}

nlohmann::json parameters(const std::string& preset) {
  return {
      {"preset", preset},
      {"bdf", 1},
      {"largest_tau", 1e-3},
      {"end_time", {{"sphere", 0.02}, {"ellipsoid", 0.02}, {"clifford_torus", 0.005}}},
      {"meshes", "generated, edge lengths 0.5 (sphere), 0.35 (ellipsoid), 0.28 (torus) times 2^(-level/2)"}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "willmore_competitors";
  experiment.paper = "kll21";
  experiment.help =
      "Willmore flow of the unit sphere, the Clifford torus (radii 1, 2^(-1/2)) and an ellipsoid (1, 1, 0.6) "
      "by "
      "three schemes:\n"
      "errors, energies, quality of the mesh and seconds per step. Backward Euler steps tau = 0.001 2^-k, on "
      "[0, 0.02], the torus\n"
      "on [0, 0.005]; level j of the meshes has 2^j times as many triangles as level 0. No units.\n"
      "Without --surfaces, --schemes, --degree, --levels, --steps: the runs of the preset.\n\n"
      "Example: willmore_competitors --surfaces sphere --schemes kll21,bgn --steps 0-3 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--surfaces", names(known_cases()), own.surfaces, "surfaces to start from");
    line.names("--schemes", known_schemes, own.schemes,
               "kll21: (3.4)-(3.5) | dziuk: Dziuk 2008, (2.13) | bgn: Barrett, Garcke, Nürnberg 2008, "
               "(2.14)");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) { return parameters(options.preset); };
  return run_experiment(experiment, argc, argv);
}
