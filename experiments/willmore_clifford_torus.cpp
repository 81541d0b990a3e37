// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow of the Clifford torus, which stays as it is: convergence in space, and how stable the
// discretisations are (kll21 §7.1, Figure 7.4)
//
// Sample runs:  build/bin/willmore_clifford_torus --preset check --output torus.json
//               build/bin/willmore_clifford_torus --torus-mesh graded --levels 0,1 --steps 2
//               build/bin/willmore_clifford_torus --runs stability --F implicit --levels 2 --steps 0-4
//               build/bin/willmore_clifford_torus --theta yes --bdf 2 --levels 0-2 --steps 3
//
// Writes:       results/paper/willmore_clifford_torus.{json,csv,tex}, from which
//               plots/willmore_clifford_torus.py draws figures/kll21/fig7_4 (errors and energy over h)
//
// The torus with radii 1 and 1/sqrt 2 is stationary under Willmore flow, with the energy 4 pi². The
// discretisation is (3.4)-(3.5): quadratic elements, BDF1 on [0, 1], projections of nu_h and z_h after each
// step, F(x, u) w extrapolated, tau = 0.2 2^-k, without the correction theta of (3.7). Meshes are finer
// around the hole: isothermal grids, and unstructured ones with edges 0.41 times as long there as outside.
//
// Beside the published runs: with theta; BDF2; F(x, u) w implicit, which is unstable for tau from 0.025 to
// 0.1.
//
// Expected orders (Theorem 4.1): h² in L^infinity(H1) for x, nu and H. There is no error in time but that of
// the projections. The damping of BDF1 is needed: BDF2 does not reach t = 1 for tau from 0.0125 to 0.05, and
// when tau is as small as 0.003 BDF1, too, lets errors grow on unstructured meshes, like exp(10t).
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/stationary_willmore.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const double major = 1, minor = std::sqrt(0.5);
const double exact_energy = 4 * pi * pi;
const HalvedSteps time_steps{1, 0.2};

/// n of the n x n isothermal grids, whose quadratic elements have 4n² nodes, by level.
const std::vector<int> grid_sizes = {8, 12, 16, 24, 32, 44};
/// Largest edge of the unstructured graded meshes of level 0: the torus is not resolved by longer ones.
const double largest_h = 0.7;
/// The same for about 1,936 nodes, and twice as many with each level.
const double accuracy_grid_size = 22, accuracy_h = 0.48;

const std::vector<std::string> known_runs = {"convergence", "stability", "accuracy"};
const std::vector<std::string> known_meshes = {"isothermal", "graded"};
const std::vector<std::string> known_F = {"extrapolated", "implicit"};
const std::vector<std::string> known_theta = {"no", "yes"};

/// One run of the grid.
struct Run {
  std::string kind, mesh, F, theta;
  int bdf = 1, level = 0, k = 0;
};

struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> runs, meshes, F, theta;
};

struct Setting {
  std::vector<Run> runs;
  int degree;
  Start start;
  std::vector<std::string> meshes;
  Quadrature rule;
};

/// Adds a method on all levels with all step sizes.
void add_runs(Run run, const std::vector<int>& levels, const std::vector<int>& steps,
              std::vector<Run>& runs) {
  for (int level : levels) {
    for (int k : steps) {
      run.level = level;
      run.k = k;
      runs.push_back(run);
    }
  }
}

std::vector<Run> preset_runs(const std::string& preset) {
  const bool paper = preset == "paper";
  const std::vector<int> grids = range(0, 5);
  std::vector<Run> runs;
  add_runs({"convergence", "isothermal", "extrapolated", "no", 1}, paper ? grids : range(0, 3),
           paper ? range(0, 6) : range(1, 2), runs);
  if (!paper) add_runs({"convergence", "isothermal", "extrapolated", "no", 1}, grids, {3}, runs);
  add_runs({"convergence", "graded", "extrapolated", "no", 1}, range(0, paper ? 3 : 1),
           paper ? range(1, 4) : range(1, 3), runs);
  if (paper) add_runs({"convergence", "graded", "extrapolated", "no", 1}, range(0, 2), {5, 6}, runs);
  add_runs({"convergence", "isothermal", "extrapolated", "yes", 1}, range(1, paper ? 5 : 3), {3}, runs);
  add_runs({"convergence", "isothermal", "extrapolated", "no", 2}, range(1, paper ? 5 : 3), {3}, runs);
  for (int bdf : {1, 2}) {
    for (const char* F : {"extrapolated", "implicit"}) {
      add_runs({"stability", "isothermal", F, "no", bdf}, {2}, paper ? range(0, 5) : range(1, 3), runs);
    }
  }
  for (const char* mesh : {"isothermal", "graded"}) {
    add_runs({"accuracy", mesh, "extrapolated", "no", 1}, {0}, {4}, runs);
  }
  return runs;
}

std::vector<std::string> given_or(const std::vector<std::string>& given, const std::string& otherwise) {
  return given.empty() ? std::vector<std::string>{otherwise} : given;
}

void require_generated_levels(const Run& run) {
  const int count = static_cast<int>(grid_sizes.size());
  if (run.mesh == "isothermal" && run.kind != "accuracy")
    require_levels({run.level}, count, "isothermal grids");
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.start = options.start.value_or(Start{});
  setting.meshes = options.meshes;
  setting.rule = quadrature_or_default(own.quadrature, setting.degree);
  const bool as_in_the_preset = !options.levels && !options.steps && !options.bdf && options.meshes.empty() &&
                                own.runs.empty() && own.meshes.empty() && own.F.empty() && own.theta.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {0});
  const std::vector<int> steps = options.steps.value_or(range(2, 3));
  for (const std::string& kind : given_or(own.runs, "convergence")) {
    for (const std::string& mesh : given_or(own.meshes, "isothermal")) {
      for (const std::string& F : given_or(own.F, "extrapolated")) {
        for (const std::string& theta : given_or(own.theta, "no")) {
          add_runs({kind, mesh, F, theta, options.bdf.value_or(1)}, levels, steps, setting.runs);
        }
      }
    }
  }
  if (options.meshes.empty()) {
    for (const Run& run : setting.runs) require_generated_levels(run);
  }
  return setting;
}

Mesh corner_mesh_of(const Run& run) {
  const bool accuracy = run.kind == "accuracy";
  if (run.mesh == "isothermal") {
    const int n = accuracy ? static_cast<int>(std::lround(accuracy_grid_size * std::pow(2, 0.5 * run.level)))
                           : grid_sizes.at(run.level);
    return isothermal_torus_grid(major, minor, n, n);
  }
  const double largest = edge_length(accuracy ? accuracy_h : largest_h, run.level);
  return generate_mesh(torus(major, minor), torus_edge_length(major, minor, largest));
}

Row run_cell(const Setting& setting, const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it.
  const Mesh mesh = initial_mesh(
      setting.meshes, run.level, [&] { return corner_mesh_of(run); }, torus(major, minor), setting.degree);
  const SurfaceSpace space(mesh, setting.rule);
  describe_mesh(mesh, row);

  // 2. The flow from exact values, with the errors of each step.
  StationaryWillmore flow;
  flow.variant.F =
      run.F == "implicit" ? WillmoreFlow::Variant::implicit : WillmoreFlow::Variant::extrapolated;
  flow.theta = run.theta == "yes";
  flow.grid = {run.bdf, row.tau, row.steps, setting.start};
  run_stationary_willmore(space, mesh, stationary_torus(major, minor), flow, exact_energy, {}, row);
  return row;
}

nlohmann::json labels(const Run& run) {
  return {{"run", run.kind}, {"projection", "projected"}, {"mesh", run.mesh},
          {"F", run.F},      {"theta", run.theta},        {"bdf", run.bdf}};
}

std::string cell_name(const Run& run) {
  return run.kind + "_" + run.mesh + "_" + run.F + (run.theta == "yes" ? "_theta" : "") +
         format("_bdf%d_h%d_tau%d", run.bdf, run.level, run.k);
}

double estimated_nodes(const Run& run) {
  if (run.kind == "accuracy") return 1936 * std::pow(2, run.level);
  if (run.mesh == "isothermal" && run.level < static_cast<int>(grid_sizes.size()))
    return 4 * std::pow(grid_sizes.at(run.level), 2);
  return 850 * std::pow(2, run.level);
}

/// Seconds on one core: a step with its errors takes about 8 microseconds a node, 30 where F is
/// implicit.
double estimated_cost(const Setting& setting, const Run& run) {
  const double nodes = estimated_nodes(run) * setting.degree * setting.degree / 4;
  return 0.1 + nodes * time_steps.count(run.k) * (run.F == "implicit" ? 30e-6 : 8e-6);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back({cell_name(run), estimated_cost(setting, run),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, row); },
                    planned_row(run.level, time_steps, run.k, labels(run))});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  const char* generated =
      "isothermal: n x n cells, n = 8, 12, 16, 24, 32, 44; graded: generated, largest edge 0.7 2^(-level/2)";
  return {{"preset", preset},
          {"major", major},
          {"minor", minor},
          {"end_time", time_steps.end_time},
          {"degree", setting.degree},
          {"start", to_string(setting.start)},
          {"quadrature", setting.rule.name},
          {"meshes", mesh_parameter(setting.meshes, generated)}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "willmore_clifford_torus";
  experiment.paper = "kll21";
  experiment.help =
      "Willmore flow of the Clifford torus with radii 1 and 1/sqrt 2 on [0, 1] (kll21 Figure 7.4): errors of "
      "position x,\n"
      "normal nu and mean curvature H over mesh width and step size, and the Willmore energy. Step sizes 0.2 "
      "2^-k, k = 0,\n"
      "1, ..; isothermal grids of n x n cells, n = 8, 12, 16, 24, 32, 44 at level 0, 1, .., graded meshes "
      "with largest edges\n"
      "0.7 2^(-j/2), level j. Lengths and times have no units: V = Lap H + Q.\n"
      "Without options for runs, meshes and methods: the runs of the preset. With one of them: all "
      "combinations, where not\n"
      "given convergence, isothermal, extrapolated, no theta, BDF1, level 0, k = 2..3.\n\n"
      "Example: willmore_clifford_torus --runs convergence --levels 0-2 --steps 2 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--runs", known_runs, own.runs,
               "convergence: Figure 7.4 | stability: the same, over tau | accuracy: about 1,936 nodes");
    line.names("--torus-mesh", known_meshes, own.meshes,
               "isothermal: uniform in isothermal coordinates | graded: unstructured, finer at the hole");
    line.names("--F", known_F, own.F, "F(x, u) w of (3.5a): extrapolated | implicit in w");
    line.names("--theta", known_theta, own.theta, "the correction (3.7)");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
