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
// A x.
//
// Expected orders (Theorem 6.1): tau³ + h² in L^infinity(H1) for x, v, nu, H. On the sphere all four
// superconverge in space (order 3 in H1, 4 for H), and nu shows no order in time, because it is constant
// along trajectories. x and H reach order 3 in tau slowly: slopes of x between neighbouring step sizes
// are 2.3, 2.6, 2.75 from tau = 0.1 down.
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/discrete_curvature.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const double initial_radius = 2, end_time = 0.6, largest_tau = 0.2, largest_h = 0.5;

double step_size(int k) {
  return largest_tau * std::pow(2.0, -k);
}
int step_count(int k) {
  return static_cast<int>(std::lround(end_time / step_size(k)));
}
double edge_length(int level) {
  return largest_h * std::pow(2.0, -0.5 * level);
}

/// What the command line says, with the preset's values where it says nothing.
struct Setting {
  int degree, bdf;
  std::vector<int> levels, dziuk_levels, steps;
  Start start;
  std::vector<std::string> meshes, flows;
  Quadrature rule;
};

const std::vector<std::string> known_flows = {"mean_curvature", "dziuk"};

/// Options of this experiment alone.
struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> flows = known_flows;
};

std::vector<int> range(int first, int last) {
  std::vector<int> list;
  for (int i = first; i <= last; ++i) list.push_back(i);
  return list;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  const bool paper = options.preset == "paper";
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(3);
  setting.meshes = options.meshes;
  const int meshes = static_cast<int>(setting.meshes.size());
  setting.levels = options.levels.value_or(meshes ? range(0, meshes - 1) : paper ? range(0, 4) : range(0, 2));
  setting.dziuk_levels = setting.levels;
  // The published run leaves out the dearest mesh: it shows nothing that the others do not.
  if (paper && !options.levels && !meshes) setting.dziuk_levels.pop_back();
  setting.steps = options.steps.value_or(paper ? range(0, 7) : range(2, 6));
  setting.start = options.start.value_or(Start{});
  setting.rule =
      own.quadrature.empty() ? default_quadrature(setting.degree) : parse_quadrature(own.quadrature);
  setting.flows = own.flows;
  for (int level : setting.levels) {
    if (meshes && level >= meshes) {
      throw InputError(
          format("--levels: found %d, expected less than %d, the number of --mesh files", level, meshes));
    }
  }
  return setting;
}

/// The initial triangulation of the sphere with curved elements.
Mesh initial_mesh(const Setting& setting, int level) {
  const Surface surface = sphere(initial_radius);
  Mesh mesh = setting.meshes.empty() ? generate_mesh(surface, edge_length(level))
                                     : mesh_from_file(setting.meshes[level]);
  mesh = lagrange_mesh(mesh, setting.degree);
  project_nodes(mesh, surface);
  return mesh;
}

/// x, v, nu, H side by side, the columns of the error tables.
Field columns(const MeanCurvatureFlow::State& state, DiscreteCurvature&) {
  return table_columns(state);
}
Field columns(const DziukFlow::State& state, DiscreteCurvature& curvature) {
  curvature.compute(state.x);
  Field all(state.x.rows(), 10);
  all << state.x, state.v, curvature.nu(), curvature.H();
  return all;
}

/// Runs the flow and records the errors of each step.
template <class Flow, class ExactState>
void run_flow(Flow flow, const SurfaceSpace& space, const TimeGrid& grid, const ExactState& exact_state,
              ErrorRecorder& errors) {
  using State = typename Flow::State;
  DiscreteCurvature curvature(space);
  integrate(flow, grid, exact_state(0.0), std::function<State(double)>(exact_state),
            [&](int, const State& state) { errors.record(state.t, columns(state, curvature)); });
}

Row run(const Setting& setting, const std::string& flow, int level, int k) {
  // 1. The initial surface and the finite element space on it.
  const Mesh mesh = initial_mesh(setting, level);
  const SurfaceSpace space(mesh, setting.rule);

  // 2. The exact solution: starting values and what the errors are measured against.
  const ExactEvolution exact = shrinking_sphere(initial_radius);
  ErrorRecorder errors(space, exact, mesh.nodes);

  // 3. The time steps, with the errors of each.
  const TimeGrid grid{setting.bdf, step_size(k), step_count(k), setting.start};
  if (flow == "dziuk") {
    warn(dziuk_warning(grid.order));
    const auto state = [&](double t) { return exact_dziuk_state(exact, mesh.nodes, t); };
    run_flow(DziukFlow(space), space, grid, state, errors);
  } else {
    const auto state = [&](double t) { return exact_mean_curvature_state(exact, mesh.nodes, t); };
    run_flow(MeanCurvatureFlow(space, {}), space, grid, state, errors);
  }

  // 4. The row of the table.
  Row row;
  row.level = level;
  row.h = mesh_quality(mesh.elements, mesh.nodes).h;
  row.nodes = space.dofs();
  row.tau = grid.tau;
  row.steps = grid.steps;
  row.errors = errors.maxima();
  row.series = errors.series();
  row.more["flow"] = flow;
  return row;
}

/// Seconds on one core: a step with its errors takes about 9 microseconds a P2 node, a mesh about 0.2 ms a
/// vertex.
double estimated_cost(const Setting& setting, int level, int k) {
  const double vertices = 110.0 / std::pow(edge_length(level), 2);
  const double nodes = vertices * setting.degree * setting.degree;
  return vertices * 2e-4 + nodes * step_count(k) * 9e-6;
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const std::string& flow : setting.flows) {
    const std::string prefix = flow == "dziuk" ? "dziuk_" : "";
    for (int level : flow == "dziuk" ? setting.dziuk_levels : setting.levels) {
      for (int k : setting.steps) {
        Cell cell{format("%sh%d_tau%d", prefix.c_str(), level, k), estimated_cost(setting, level, k),
                  [=](const std::string&) { return run(setting, flow, level, k); }};
        cell.planned.level = level;
        cell.planned.tau = step_size(k);
        cell.planned.steps = step_count(k);
        cell.planned.more["flow"] = flow;
        list.push_back(cell);
      }
    }
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  nlohmann::json meshes = setting.meshes;
  if (setting.meshes.empty()) {
    meshes = "generated, edge length 0.5 2^(-level/2)";
  }
  return {{"preset", preset},
          {"initial_radius", initial_radius},
          {"end_time", end_time},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"start", to_string(setting.start)},
          {"quadrature", setting.rule.name},
          {"meshes", meshes},
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
  experiment.add_options = [&](CLI::App& app) {
    app.add_option("--flow", own.flows, "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6); both unless given")
        ->check(CLI::IsMember(known_flows))
        ->delimiter(',')
        ->type_name("LIST")
        ->group("Method (not given: as in the preset)");
    app.add_option("--quadrature", own.quadrature,
                   "rule on each element: conical:N (N x N Gauss points) | degree:D (symmetric)")
        ->type_name("RULE")
        ->group("Method (not given: as in the preset)");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
