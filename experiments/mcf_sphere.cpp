// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of a sphere: convergence in time and space (kll19 §13.1, Figures 13.1 and 13.2)
//
// Sample runs:  build/bin/mcf_sphere --preset check --output sphere.json
//               build/bin/mcf_sphere --preset check --levels 0 --steps 2-4 --bdf 2 --start substeps:16
//               build/bin/mcf_sphere --preset check --degree 3 --levels 0 --steps 3-5
//               build/bin/mcf_sphere --preset check --flow dziuk --bdf 2
//
// Writes:       results/paper/mcf_sphere.{json,csv,tex}, from which plots/mcf_sphere.py draws
//               figures/kll19/fig13_1 (error over tau) and fig13_2 (error over h)
//
// The sphere of radius R_0 = 2 shrinks by v = -H nu on [0, 0.6], R(t) = sqrt(R_0² - 4t). The discretisation
// is (5.1): quadratic evolving surface finite elements and BDF3, exact starting values, tau = 0.2 2^-k and h
// near 0.5 2^(-j/2). Beside it, in the same table, runs Dziuk's scheme (3.6), with nu and H from kappa = M^-1
// A x; and, one or a few cells each, what the paper says or assumes of starting values and of the
// price of a step, Dziuk's scheme with BDF4, and the growth of an error in |nu_h|.
//
// Expected orders (Theorem 6.1): tau³ + h² in L^infinity(H1) for x, v, nu, H. On the sphere all four
// superconverge in space (order 3 in H1, 4 for H), and nu shows no order in time, because it is constant
// along trajectories. x and H reach order 3 in tau slowly: slopes of x between neighbouring step sizes
// are 2.3, 2.6, 2.75 from tau = 0.1 down.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const double initial_radius = 2, largest_h = 0.5;
const HalvedSteps time_steps{0.6, 0.2};

/// One run of the grid, or beside it: there `flow` says what is different.
struct Run {
  std::string flow;
  int bdf;
  Start start;
  int level, k;
};

/// What the command line says, with the preset's values where it says nothing.
struct Setting {
  int degree, bdf;
  std::vector<int> levels, dziuk_levels, steps;
  Start start;
  std::vector<std::string> meshes, flows;
  std::vector<Run> beside;
  Quadrature rule;
};

const std::vector<std::string> known_flows = {"mean_curvature", "dziuk"};

/// Options of this experiment alone.
struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> flows = known_flows;
};

/// What claims are about beside the grid, all on coarse meshes.
std::vector<Run> runs_beside_the_grid(bool paper) {
  const Start exact, cascade = parse_start("cascade"), substeps = parse_start("substeps:16");
  std::vector<Run> runs;
  for (int k : {1, 2, 3}) runs.push_back({"cascade_bdf3", 3, cascade, 0, k});
  runs.push_back({"substeps_bdf3", 3, substeps, 0, 2});
  runs.push_back({"dziuk_bdf4", 4, exact, 0, 4});
  runs.push_back({"disturbed_normal", 2, substeps, 0, 3});
  if (!paper) return runs;
  runs.push_back({"cost", 3, exact, 0, 2});
  for (int k : {1, 2, 3}) runs.push_back({"cascade_bdf5", 5, cascade, 0, k});
  runs.push_back({"substeps_bdf3", 3, substeps, 0, 3});
  runs.push_back({"dziuk_bdf4", 4, exact, 0, 5});
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  const bool paper = options.preset == "paper";
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(3);
  setting.meshes = options.meshes;
  setting.rule = quadrature_or_default(own.quadrature, setting.degree);
  setting.levels = mesh_levels(options, paper ? range(0, 4) : range(0, 2));
  setting.dziuk_levels = setting.levels;
  // The published run leaves out the most expensive mesh: it shows nothing that the others do not.
  if (paper && !options.levels && options.meshes.empty()) setting.dziuk_levels.pop_back();
  setting.steps = options.steps.value_or(paper ? range(0, 7) : range(2, 6));
  setting.start = options.start.value_or(Start{});
  setting.flows = own.flows;
  const bool as_in_the_preset = !options.degree && !options.bdf && !options.levels && !options.steps &&
                                !options.start && options.meshes.empty() && own.flows == known_flows;
  if (as_in_the_preset) setting.beside = runs_beside_the_grid(paper);
  return setting;
}

/// Runs the flow, records the errors of each step and shows its end.
template <class Flow, class ExactState>
void run_flow(Flow flow, const UniformSteps& grid, const ExactState& exact_state, ErrorRecorder& errors,
              const std::function<void(const typename Flow::State&)>& at_end) {
  using State = typename Flow::State;
  integrate(flow, grid, {exact_state(0.0), std::function<State(double)>(exact_state)},
            [&](int n, const State& state) {
              errors.record(state);
              if (n == grid.steps) at_end(state);
            });
}

/// The last state of a run of (5.1) from given initial values.
MeanCurvatureFlow::State end_of(const SurfaceSpace& space, const UniformSteps& grid,
                                const MeanCurvatureFlow::State& initial) {
  MeanCurvatureFlow flow(space, {});
  MeanCurvatureFlow::State end;
  integrate(flow, grid, initial, [&](int, const MeanCurvatureFlow::State& state) { end = state; });
  return end;
}

/// How much an error in the length of nu_h grows until the end: |nu_h| of a run whose initial normals are a
/// little too long, compared with a run where they are not.
double growth_of_length(const SurfaceSpace& space, const UniformSteps& grid,
                        const MeanCurvatureFlow::State& initial) {
  const double excess = 1e-4;
  MeanCurvatureFlow::State disturbed = initial;
  disturbed.u.leftCols(3) *= 1 + excess;
  const auto mean_length = [](const MeanCurvatureFlow::State& state) {
    return state.u.leftCols(3).rowwise().norm().mean();
  };
  return (mean_length(end_of(space, grid, disturbed)) - mean_length(end_of(space, grid, initial))) / excess;
}

/// How many times as long as one of Dziuk's scheme a run of (5.1) takes: the median of pairs of runs.
double cost_ratio(const SurfaceSpace& space, const UniformSteps& grid, const ExactEvolution& exact,
                  const Field& x0) {
  const auto seconds = [&](auto flow, const auto& exact_state) {
    using State = decltype(exact_state(0.0));
    const auto begin = std::chrono::steady_clock::now();
    integrate(flow, grid, {exact_state(0.0), std::function<State(double)>(exact_state)},
              [](int, const State&) {});
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::vector<double> ratios;
  for (int pair = 0; pair < 5; ++pair) {
    const double dziuk = seconds(DziukFlow(space), [&](double t) { return exact_dziuk_state(exact, x0, t); });
    const double kll = seconds(MeanCurvatureFlow(space, {}),
                               [&](double t) { return exact_mean_curvature_state(exact, x0, t); });
    ratios.push_back(kll / dziuk);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

/// The largest distance in a node between nu_h and the normal of Gamma_h[x].
double distance_of_normals(const SurfaceSpace& space, const MeanCurvatureFlow::State& state) {
  DiscreteCurvature curvature(space);
  curvature.compute(state.x);
  return (state.u.leftCols(3) - curvature.nu()).rowwise().norm().maxCoeff();
}

bool starts_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// A run whose errors are measured at each step.
void run_with_errors(const Run& run, const SurfaceSpace& space, const UniformSteps& grid, const Field& x0,
                     const ExactEvolution& exact, Row& row) {
  ErrorRecorder errors(space, exact, x0);
  if (starts_with(run.flow, "dziuk")) {
    if (run.flow == "dziuk") warn(dziuk_warning(grid.order));
    run_flow(
        DziukFlow(space), grid, [&](double t) { return exact_dziuk_state(exact, x0, t); }, errors,
        [](const DziukFlow::State&) {});
  } else {
    run_flow(
        MeanCurvatureFlow(space, {}), grid,
        [&](double t) { return exact_mean_curvature_state(exact, x0, t); }, errors,
        [&](const MeanCurvatureFlow::State& end) {
          row.values["distance_of_normals"] = distance_of_normals(space, end);
        });
  }
  row.errors = errors.maxima();
  row.series = errors.series();
}

Row run_cell(const Setting& setting, const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = sphere(initial_radius);
  const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, row.level)); };
  const Mesh mesh = initial_mesh(setting.meshes, row.level, generate, surface, setting.degree);
  const SurfaceSpace space(mesh, setting.rule);
  describe_mesh(mesh, row);

  // 2. The exact solution: starting values and what the errors are measured against.
  const ExactEvolution exact = shrinking_sphere(initial_radius);

  // 3. The time steps, and what is measured of them.
  const UniformSteps grid{run.bdf, row.tau, row.steps, run.start};
  if (run.flow == "disturbed_normal") {
    row.values["growth_of_length"] =
        growth_of_length(space, grid, exact_mean_curvature_state(exact, mesh.nodes, 0));
  } else if (run.flow == "cost") {
    row.values["seconds_ratio"] = cost_ratio(space, grid, exact, mesh.nodes);
  } else {
    run_with_errors(run, space, grid, mesh.nodes, exact, row);
  }
  return row;
}

/// Seconds on one core: a step with its errors takes about 9 microseconds a P2 node, a mesh about 0.2 ms a
/// vertex.
double estimated_cost(const Setting& setting, int level, int k) {
  const double vertices = 110.0 / std::pow(edge_length(largest_h, level), 2);
  const double nodes = vertices * setting.degree * setting.degree;
  return vertices * 2e-4 + nodes * time_steps.count(k) * 9e-6;
}

std::string cell_name(const Run& run) {
  const std::string prefix = run.flow == "mean_curvature" ? "" : run.flow + "_";
  return prefix + format("h%d_tau%d", run.level, run.k);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Run> runs;
  for (const std::string& flow : setting.flows) {
    for (int level : flow == "dziuk" ? setting.dziuk_levels : setting.levels) {
      for (int k : setting.steps) runs.push_back({flow, setting.bdf, setting.start, level, k});
    }
  }
  runs.insert(runs.end(), setting.beside.begin(), setting.beside.end());
  std::vector<Cell> list;
  for (const Run& run : runs) {
    list.push_back({cell_name(run), estimated_cost(setting, run.level, run.k),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, row); },
                    planned_row(run.level, time_steps, run.k, {{"flow", run.flow}})});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"initial_radius", initial_radius},
          {"end_time", time_steps.end_time},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"start", to_string(setting.start)},
          {"quadrature", setting.rule.name},
          {"meshes", mesh_parameter(setting.meshes, "generated, edge length 0.5 2^(-level/2)")},
          {"flows", setting.flows}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "mcf_sphere";
  experiment.paper = "kll19";
  experiment.help =
      "Mean curvature flow of the sphere of radius 2 on [0, 0.6]: errors of position x, velocity v, normal "
      "nu and mean\n"
      "curvature H over step size and mesh width (kll19 Figures 13.1, 13.2). Step sizes 0.2 2^-k, k = 0..7; "
      "edge\n"
      "lengths 0.5 2^(-j/2), level j = 0..4. Lengths and times have no units: v = -H nu.\n\n"
      "Example: mcf_sphere --preset check --levels 0 --steps 2-4 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--flow", known_flows, own.flows,
               "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6); both unless given");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
