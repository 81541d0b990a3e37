// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of the self-shrinking torus: convergence in time and space to an exact solution that is
// no sphere
//
// Sample runs:  build/bin/mcf_angenent_torus --preset check --output torus.json
//               build/bin/mcf_angenent_torus --flow mean_curvature --degree 3 --levels 0-1 --steps 2
//               build/bin/mcf_angenent_torus --runs order --bdf 2 --steps 2-4
//
// Writes:       results/paper/mcf_angenent_torus.{json,csv,tex}, from which plots/mcf_angenent_torus.py draws
//               figures/gallery/mcf_angenent_torus
//
// Angenent's torus shrinks by v = -H nu to sqrt(1 - t) times itself; here on [0, 0.2]. Its profile comes from
// an ordinary differential equation, its particles slide along it (surfaces/angenent_torus.hpp). (5.1) of
// kll19 and Dziuk's scheme (3.6), with nu and H from kappa = M^-1 A x, take exact starting values, quadratic
// and cubic elements, tau = 0.02 2^-k, on grids that are uniform in arclength and angle, and on unstructured
// meshes.
//
// Runs "order" measure BDF 1 to 5 on [0.1, 0.2] against the same discretisation with steps of a quarter,
// because the error in space hides that in time.
//
// Expected orders (kll19 Theorem 6.1): tau^q + h^k in L^infinity(H1) for x, v, nu, H, one more in h in L2. On
// the sphere all four superconverge in space, and nu has no error in time; here these orders are what one
// sees.
#include <algorithm>
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{0.2, 0.02};
const HalvedSteps order_steps{0.1, 0.02};  ///< of the runs "order", on [0.1, 0.2]
const int finer_by = 2;                    ///< the solutions they are measured against have tau 2^-finer_by
const int profile_cells[] = {12, 18, 24, 36, 48};  ///< of the grid, twice as many around the axis
const double largest_h = 0.66;  ///< of the coarsest unstructured mesh, at the outer equator

const std::vector<std::string> known_runs = {"convergence", "order"};
const std::vector<std::string> known_flows = {"mean_curvature", "dziuk"};
const std::vector<std::string> known_meshes = {"grid", "unstructured"};

/// One run of the table.
struct Run {
  std::string kind, flow, mesh;
  int degree, bdf, level, k;
};

struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> runs, flows, meshes;
};

struct Setting {
  std::vector<Run> runs;
  Start start;
  std::vector<std::string> files;
  std::string quadrature;
};

void add_runs(const Run& first, const std::vector<int>& levels, const std::vector<int>& steps,
              std::vector<Run>& runs) {
  for (const int level : levels)
    for (const int k : steps) {
      runs.push_back(first);
      runs.back().level = level;
      runs.back().k = k;
    }
}

std::vector<Run> preset_runs(const std::string& preset) {
  const bool paper = preset == "paper";
  const char *ours = "mean_curvature", *dziuk = "dziuk";
  std::vector<Run> runs;
  const auto add = [&](const char* kind, const char* flow, const char* mesh, int degree, int bdf,
                       const std::vector<int>& levels, const std::vector<int>& steps) {
    add_runs({kind, flow, mesh, degree, bdf, 0, 0}, levels, steps, runs);
  };
  if (paper) {
    add("convergence", ours, "grid", 2, 3, {3}, {3});
    add("convergence", ours, "grid", 2, 3, range(0, 2), {2, 3});
    add("convergence", ours, "unstructured", 2, 3, range(0, 2), {3});
    add("convergence", dziuk, "grid", 2, 2, range(0, 3), {3});
    for (const int bdf : {1, 3}) add("convergence", dziuk, "grid", 2, bdf, range(0, 2), {3});
    add("convergence", dziuk, "unstructured", 2, 2, range(0, 1), {3});
    add("convergence", ours, "grid", 3, 3, range(0, 3), {2});
    add("convergence", dziuk, "grid", 3, 2, range(0, 2), {2});
  } else {
    add("convergence", ours, "grid", 2, 3, range(0, 2), {2});
    add("convergence", dziuk, "grid", 2, 2, range(0, 2), {2});
  }
  for (const int bdf : paper ? range(1, 5) : std::vector<int>{1, 3, 5}) {
    add("order", ours, "grid", 2, bdf, {0}, paper ? range(2, 4) : range(1, 3));
    if (!paper) continue;
    add("order", ours, "grid", 3, bdf, {0}, range(1, 3));
    add("order", dziuk, "grid", 2, bdf, {0}, range(2, 4));
  }
  return runs;
}

template <class Value>
std::vector<Value> given_or(const std::vector<Value>& given, const std::vector<Value>& otherwise) {
  return given.empty() ? otherwise : given;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.start = options.start.value_or(Start{});
  setting.files = options.meshes;
  setting.quadrature = own.quadrature;
  const bool as_in_the_preset = !options.levels && !options.steps && !options.bdf && !options.degree &&
                                options.meshes.empty() && own.runs.empty() && own.flows.empty() &&
                                own.meshes.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {0});
  if (options.meshes.empty()) require_levels(levels, std::size(profile_cells), "meshes");
  const std::vector<std::string> meshes =
      options.meshes.empty() ? given_or<std::string>(own.meshes, {"grid"}) : std::vector<std::string>{"file"};
  for (const std::string& kind : given_or<std::string>(own.runs, {"convergence"}))
    for (const std::string& flow : given_or(own.flows, known_flows))
      for (const std::string& mesh : meshes)
        add_runs({kind, flow, mesh, options.degree.value_or(2), options.bdf.value_or(3), 0, 0}, levels,
                 options.steps.value_or(range(1, 3)), setting.runs);
  return setting;
}

Mesh generated(const Run& run) {
  if (run.mesh == "grid") return angenent_torus_grid(2 * profile_cells[run.level], profile_cells[run.level]);
  return generate_mesh(angenent_torus(), angenent_torus_edge_length(edge_length(largest_h, run.level)));
}

/// The torus on one mesh by one flow. exact_state(t): exact nodal values.
template <class Flow, class ExactState>
struct TorusRuns {
  const SurfaceSpace& space;
  const ExactEvolution& exact;
  const Field& x0;
  Flow flow;
  ExactState exact_state;
  int reference_bdf;  ///< of the solution with small steps
  using State = typename Flow::State;

  /// Errors against the exact solution, over all steps.
  void convergence(const UniformSteps& grid, Row& row) {
    ErrorRecorder errors(space, exact, x0);
    integrate(flow, grid, {exact_state(0.0), exact_state}, errors);
    row.errors = errors.maxima();
    row.series = errors.series();
  }

  /// Errors at the end against the same discretisation in space with small steps. It gives the starting
  /// values at t = 0.1, too: what the interpolation of the exact ones leaves in the fast modes has died out
  /// there.
  void order(const UniformSteps& grid, Row& row) {
    const int ratio = 1 << finer_by, last = static_cast<int>(std::lround(time_steps.end_time / grid.tau));
    const UniformSteps small{reference_bdf, grid.tau / ratio, ratio * last, parse_start("substeps:16")};
    const SmallSteps<Flow> solution(flow, small, exact_state(0.0), {}, ratio);
    LargestDifferences differences(space, exact.quantities);
    solution.compare(grid.order, grid.tau, last - grid.steps + grid.order,
                     [&](int n, const State& state, const State& exactly) {
                       if (n < last) return;
                       differences.add(exactly.x, state, exactly);
                     });
    row.errors = differences.errors();
  }
};
template <class Flow, class ExactState>
TorusRuns(const SurfaceSpace&, const ExactEvolution&, const Field&, Flow, ExactState, int)
    -> TorusRuns<Flow, ExactState>;

Row run_cell(const Setting& setting, const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = angenent_torus();
  const Mesh mesh = initial_mesh(
      setting.files, run.level, [&] { return generated(run); }, surface, run.degree);
  const SurfaceSpace space(mesh, quadrature_or_default(setting.quadrature, run.degree));
  describe_mesh(mesh, row);

  // 2. The time steps, with the errors of each or at the end.
  const ExactEvolution exact = shrinking_angenent_torus();
  const UniformSteps grid{run.bdf, row.tau, row.steps, setting.start};
  const auto measure = [&](auto&& runs) {
    run.kind == "order" ? runs.order(grid, row) : runs.convergence(grid, row);
  };
  if (run.flow == "dziuk")
    measure(TorusRuns{space, exact, mesh.nodes, DziukFlow(space),
                      [&](double t) { return exact_dziuk_state(exact, mesh.nodes, t); }, 3});
  else
    measure(TorusRuns{space, exact, mesh.nodes, MeanCurvatureFlow(space, {}),
                      [&](double t) { return exact_mean_curvature_state(exact, mesh.nodes, t); }, 5});
  return row;
}

std::string cell_name(const Run& run) {
  return format("%s_%s_%s_p%d_bdf%d_h%d_tau%d", run.kind.c_str(), run.flow.c_str(), run.mesh.c_str(),
                run.degree, run.bdf, run.level, run.k);
}

/// Seconds on one core: about 5 microseconds a step and node, 8 more for the errors.
double estimated_cost(const Run& run) {
  const double cells = profile_cells[std::min<std::size_t>(run.level, std::size(profile_cells) - 1)],
               nodes = 2 * cells * cells * run.degree * run.degree;
  if (run.kind == "order")
    return nodes * 5e-6 * (order_steps.count(run.k) + time_steps.count(run.k + finer_by));
  return nodes * 13e-6 * time_steps.count(run.k);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    const nlohmann::json labels = {
        {"run", run.kind}, {"flow", run.flow}, {"mesh", run.mesh}, {"degree", run.degree}, {"bdf", run.bdf}};
    list.push_back({cell_name(run), estimated_cost(run),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, row); },
                    planned_row(run.level, run.kind == "order" ? order_steps : time_steps, run.k, labels)});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", time_steps.end_time},
          {"start", to_string(setting.start)},
          {"quadrature", setting.quadrature.empty() ? "by degree" : setting.quadrature},
          {"meshes", mesh_parameter(setting.files,
                                    "grid: 2n x n cells, n = 12, 18, 24, 36, 48; unstructured: edges 0.33 to "
                                    "0.66 times 2^(-level/2)")}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "mcf_angenent_torus";
  experiment.paper = "esfem";
  experiment.help =
      "Mean curvature flow of the self-shrinking torus of Angenent on [0, 0.2]: errors of position x, "
      "velocity v, "
      "normal nu\n"
      "and mean curvature H over step size and mesh width. Step sizes 0.02 2^-k, k = 0, 1, ..; level j = 0, "
      ".., 4: "
      "grids of\n"
      "2n x n cells, n = 12, 18, 24, 36, 48, or unstructured meshes. Lengths and times have no units: v = -H "
      "nu.\n"
      "Without --runs, --flow, --triangulation, --degree, --bdf, --levels, --steps, --mesh: the runs of the "
      "preset. "
      "With "
      "one of them:\n"
      "all combinations, where not given convergence, both flows, grid, P2, BDF3, level 0, k = 1..3.\n\n"
      "Example: mcf_angenent_torus --flow mean_curvature --levels 0-2 --steps 3 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--runs", known_runs, own.runs,
               "convergence: errors against the exact solution | order: at the end, against small steps");
    line.names("--flow", known_flows, own.flows, "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6)");
    line.names("--triangulation", known_meshes, own.meshes,
               "grid: uniform in arclength and angle | unstructured");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
