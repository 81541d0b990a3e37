// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any flow on any surface or mesh, from a JSON file
//
// Sample runs:  build/bin/evolve reference/examples/sphere.json
//               build/bin/evolve reference/examples/dumbbell.json
//
// Writes the nodal values at the end and a time series, as the file says; `evolve --help` explains its keys.
#include <unistd.h>

#include <cstdio>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/evolve_config.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/library_environment.hpp"
#include "experiments/harness/provenance.hpp"
#include "solver/analysis/diagnostics.hpp"
#include "solver/analysis/table.hpp"
#include "solver/error.hpp"

namespace {

using namespace esfem;
using nlohmann::json;
using State = MeanCurvatureFlow::State;

/// N x c nodal values as [[..], ..], or [..] for one component.
json rows(const Field& field) {
  json list = json::array();
  for (int j = 0; j < field.rows(); ++j) {
    if (field.cols() == 1) {
      list.push_back(field(j, 0));
    } else {
      list.push_back(std::vector<double>(field.cols()));
      for (int l = 0; l < field.cols(); ++l) list.back()[l] = field(j, l);
    }
  }
  return list;
}

/// What a run has computed so far: written at its end, and when it fails.
struct Results {
  State last;
  Series series;
};

void write(const EvolveConfig& config, const Results& results, const json& config_json, const json& origin) {
  if (!config.series.empty()) {
    json series = results.series;
    series["config"] = config_json;
    series["provenance"] = origin;
    write_file(config.series, series.dump(1) + "\n");
  }
  if (!config.nodal.empty()) {
    const State& state = results.last;
    const json nodal = {{"t", state.t},
                        {"x", rows(state.x)},
                        {"v", rows(state.v)},
                        {"nu", rows(state.u.leftCols(3))},
                        {"H", rows(state.u.rightCols(1))},
                        {"config", config_json},
                        {"provenance", origin}};
    write_file(config.nodal, nodal.dump() + "\n");
  }
}

void say(const std::string& line) {
  std::fprintf(stderr, "evolve: %s\n", line.c_str());
}

State initial_state(const EvolveConfig& config, const SurfaceSpace& space) {
  if (config.surface) return mean_curvature_state_on(*config.surface, config.mesh.nodes);
  say("no exact surface is given: nu and H at the start are computed on the discrete surface");
  return discrete_mean_curvature_state(space, config.mesh.nodes);
}

/// The exact solution, where one is known.
std::function<State(double)> exact_solution(const EvolveConfig& config) {
  if (!config.surface || config.surface->name != "sphere") return {};
  const ExactEvolution exact = shrinking_sphere(config.surface->parameters.at("radius"));
  return [exact, x0 = config.mesh.nodes](double t) { return exact_mean_curvature_state(exact, x0, t); };
}

void run_mean_curvature(const EvolveConfig& config, Results& results) {
  const SurfaceSpace space(config.mesh, config.rule);
  const std::function<State(double)> exact = exact_solution(config);
  TimeGrid grid = config.grid;
  if (!config.start_given && !exact) grid.start = parse_start("substeps:16");
  MeanCurvatureFlow flow(space, config.mean_curvature);
  const bool terminal = isatty(STDERR_FILENO);
  integrate(flow, grid, initial_state(config, space), exact, [&](int n, const State& state) {
    record_geometry(space, state.t, state.x, results.series);
    record_curvature(space, state.x, state.u.leftCols(3), state.u.rightCols(1), results.series);
    results.last = state;
    if (terminal)
      std::fprintf(stderr, "\rstep %d of %d, t = %g%s", n, grid.steps, state.t, n == grid.steps ? "\n" : "");
  });
}

int evolve(const std::string& file, const json& origin) {
  const json config_json = read_json(file);
  const EvolveConfig config = evolve_config(config_json, file);
  if (!config.mesh_remark.empty()) say(config.mesh_remark);
  Results results;
  try {
    run_mean_curvature(config, results);
  } catch (const NumericsError&) {
    if (results.last.x.size() > 0) {
      write(config, results, config_json, origin);
      say(format("what was computed up to t = %g is written", results.last.t));
    }
    throw;
  }
  write(config, results, config_json, origin);
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  set_library_environment(argc, argv);
  return guarded_main([&] {
    CLI::App app(
        "Evolves a surface: flow, surface or mesh, and method come from a JSON file.\n"
        "Example: evolve reference/examples/sphere.json\n\n" +
            evolve_config_help(),
        "evolve");
    std::string file;
    int threads = 1;
    app.add_option("config", file, "the configuration")->required()->type_name("CONFIG.json");
    app.add_option("--threads", threads, "threads that the factorisations may use")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    if (!parse_command_line(app, argc, argv)) return static_cast<int>(exit_done);
    return evolve(file, provenance(argc, argv));
  });
}
