// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any flow on any surface or mesh, from a JSON file
//
// Sample runs:  build/bin/evolve reference/examples/sphere.json
//               build/bin/evolve reference/examples/dumbbell.json
//               build/bin/evolve reference/examples/tumour.json
//
// Writes the nodal values at the end, a time series and snapshots, as the file says; `evolve --help` explains
// its keys.
#include <unistd.h>

#include <cstdio>
#include <optional>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/evolve_config.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/library_environment.hpp"
#include "experiments/harness/provenance.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/analysis/table.hpp"
#include "solver/error.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/coupled_diffusion.hpp"
#include "solver/flows/dziuk_flow.hpp"

namespace {

using namespace esfem;
using nlohmann::json;

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

void write(const EvolveConfig& config, RunRecorder& recorder, const std::string& status,
           const json& config_json, const json& origin) {
  if (!config.series.empty()) {
    json series = recorder.series();
    series["status"] = status;
    series["config"] = config_json;
    series["provenance"] = origin;
    write_file(config.series, series.dump(1) + "\n");
  }
  if (!config.nodal.empty()) {
    const RunRecorder::Surface& newest = recorder.newest();
    json nodal = {{"t", newest.t}, {"x", rows(newest.x)}, {"config", config_json}, {"provenance", origin}};
    for (const PointField& field : newest.fields) nodal[field.name] = rows(field.values);
    write_file(config.nodal, nodal.dump() + "\n");
  }
  recorder.finish();
}

template <class State>
using ExactState = std::function<State(double)>;

/// Integrates from `initial` and records every step. exact: the exact solution, where one is known.
template <class Flow, class State = typename Flow::State>
void run_flow(Flow flow, const EvolveConfig& config, const State& initial, const ExactState<State>& exact,
              RunRecorder& recorder) {
  TimeGrid grid = config.grid;
  if (!config.start_given && !exact) grid.start = parse_start("substeps:16");
  const bool terminal = isatty(STDERR_FILENO);
  integrate(flow, grid, initial, exact, [&](int n, const State& state) {
    recorder.record(n, state.t, state.x, point_fields(state));
    if (terminal)
      std::fprintf(stderr, "\rstep %d of %d, t = %g%s", n, grid.steps, state.t, n == grid.steps ? "\n" : "");
  });
}

/// A sphere has an exact solution under mean curvature flow.
std::optional<ExactEvolution> exact_solution(const EvolveConfig& config) {
  if (!config.surface || config.surface->name != "sphere") return {};
  return shrinking_sphere(config.surface->parameters.at("radius"));
}

void run_mean_curvature(const EvolveConfig& config, const SurfaceSpace& space, RunRecorder& recorder) {
  using State = MeanCurvatureFlow::State;
  const Field& x0 = config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_solution(config);
  ExactState<State> exact_state;
  if (exact) exact_state = [&](double t) { return exact_mean_curvature_state(*exact, x0, t); };
  if (!config.surface)
    warn("no exact surface is given: nu and H at the start are computed on the discrete surface");
  run_flow(MeanCurvatureFlow(space, config.mean_curvature), config,
           config.surface ? mean_curvature_state_on(*config.surface, x0)
                          : discrete_mean_curvature_state(space, x0),
           exact_state, recorder);
}

void run_dziuk(const EvolveConfig& config, const SurfaceSpace& space, RunRecorder& recorder) {
  using State = DziukFlow::State;
  const Field& x0 = config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_solution(config);
  ExactState<State> exact_state;
  if (exact) exact_state = [&](double t) { return exact_dziuk_state(*exact, x0, t); };
  warn(dziuk_warning(config.grid.order));
  run_flow(DziukFlow(space), config, dziuk_state_on(space, x0), exact_state, recorder);
}

void run_bgn(const EvolveConfig& config, const SurfaceSpace& space, RunRecorder& recorder) {
  run_flow(BgnFlow(space), config, bgn_state_on(space, config.mesh.nodes), {}, recorder);
}

void run_growing_sphere(const EvolveConfig& config, const SurfaceSpace& space, RunRecorder& recorder) {
  const EvolveConfig::Coupled& coupled = config.coupled;
  const ExactEvolution exact = growing_sphere();
  const ExactState<CoupledDiffusionState> exact_state = [&](double t) {
    return exact_growing_sphere_state(space, exact, config.mesh.nodes, t);
  };
  const GrowingSphereProblem problem(coupled.parameters, coupled.variant.law, coupled.coupling);
  run_flow(CoupledDiffusion(space, problem, coupled.parameters, coupled.variant), config, exact_state(0),
           exact_state, recorder);
}

void run_tumour_growth(const EvolveConfig& config, const SurfaceSpace& space, RunRecorder& recorder) {
  const EvolveConfig::Coupled& coupled = config.coupled;
  const CoupledDiffusionState initial =
      tumour_growth_state(space, config.mesh.nodes, coupled.kinetics, coupled.disturbance, coupled.seed);
  run_flow(CoupledDiffusion(space, TumourGrowth(coupled.kinetics), coupled.parameters, coupled.variant),
           config, initial, {}, recorder);
}

int evolve(const std::string& file, const json& origin) {
  const json config_json = read_json(file);
  const EvolveConfig config = evolve_config(config_json, file);
  warn(config.mesh_remark);
  const SurfaceSpace space(config.mesh, config.rule);
  RunRecorder recorder(space, config.snapshots);
  try {
    if (config.flow == "mean_curvature") run_mean_curvature(config, space, recorder);
    if (config.flow == "dziuk") run_dziuk(config, space, recorder);
    if (config.flow == "bgn") run_bgn(config, space, recorder);
    if (config.flow == "coupled_diffusion") {
      const bool is_sphere = config.coupled.problem == EvolveConfig::Coupled::growing_sphere;
      is_sphere ? run_growing_sphere(config, space, recorder) : run_tumour_growth(config, space, recorder);
    }
  } catch (const NumericsError& error) {
    if (!recorder.empty()) {
      write(config, recorder, error.what(), config_json, origin);
      warn(format("what was computed up to t = %g is written", recorder.newest().t));
    }
    throw;
  }
  write(config, recorder, "ok", config_json, origin);
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
