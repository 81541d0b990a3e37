// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow of a sphere, which stays as it is: convergence in space, and what projections are for (kll21
// §7.1, Figures 7.1 to 7.3)
//
// Sample runs:  build/bin/willmore_sphere --preset check --output sphere.json
//               build/bin/willmore_sphere --runs convergence --projection projected --levels 0-2 --steps 2
//               build/bin/willmore_sphere --runs normals --steps 3
//               build/bin/willmore_sphere --runs convergence --bdf 3 --degree 3 --levels 0-1 --steps 2,3
//
// Writes:       results/paper/willmore_sphere.{json,csv,tex}, from which plots/willmore_sphere.py draws
//               figures/kll21/fig7_1 (errors over h without projections), fig7_2 (normals, radii and energy
//               over time) and fig7_3 (errors over h with projections)
//
// A sphere is stationary under Willmore flow. The discretisation is (3.4)-(3.5): quadratic elements and BDF2
// on [0, 1], exact starting values, tau = 0.2 2^-k, h near 0.55 2^(-j/2), without the correction theta of
// (3.7), and after each step without and with projections of nu_h and z_h.
//
// Beside the published runs: with theta and projections the discrete sphere is stationary, too. The growth
// of errors without projections on spheres of radius 1 and 1.5, until t = R⁴. Surface diffusion (1.2), which
// leaves the sphere as it is, too.
//
// Expected orders (Theorem 4.1): h² in L^infinity(H1) for x, nu and H. There is no error in time. Without
// projections errors grow like exp(8t/R⁴).
#include <cmath>
#include <map>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/stationary_willmore.hpp"
#include "solver/analysis/diagnostics.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const double largest_tau = 0.2;
const double energy_of_spheres = 8 * pi;

/// The kinds of runs, as --runs names them and as rows are labelled, and the edge lengths of their level 0 on
/// the unit sphere.
const std::map<std::string, double> largest_h = {{"convergence", 0.55}, {"normals", 0.24},
                                                 {"accuracy", 0.21},    {"theta", 0.55},
                                                 {"growth", 0.28},      {"surface_diffusion", 0.55}};
const std::vector<std::string> known_runs = {"convergence", "normals", "accuracy",
                                             "theta",       "growth",  "surface_diffusion"};
const std::vector<std::string> known_projections = {"none", "projected"};

/// One run of the grid.
struct Run {
  std::string kind, projection;
  double radius;
  int level, k;
};

struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> runs, projections;
};

struct Setting {
  std::vector<Run> runs;
  int degree, bdf;
  Start start;
  std::vector<std::string> meshes;
  Quadrature rule;
};

std::vector<double> radii(const std::string& kind) {
  return kind == "growth" ? std::vector<double>{1, 1.5} : std::vector<double>{1};
}

void add_runs(const std::string& kind, const std::vector<std::string>& projections,
              const std::vector<int>& levels, const std::vector<int>& steps, std::vector<Run>& runs) {
  for (const std::string& projection : projections) {
    for (double radius : radii(kind)) {
      for (int level : levels) {
        for (int k : steps) runs.push_back({kind, projection, radius, level, k});
      }
    }
  }
}

std::vector<Run> preset_runs(const std::string& preset) {
  const bool paper = preset == "paper";
  std::vector<Run> runs;
  add_runs("convergence", known_projections, paper ? range(0, 4) : range(0, 3),
           paper ? range(0, 6) : range(1, 3), runs);
  add_runs("normals", known_projections, {0}, {3}, runs);
  add_runs("accuracy", {"projected"}, {0}, {2}, runs);
  add_runs("theta", {"projected"}, {0, 1}, {2}, runs);
  add_runs("growth", {"none"}, {0}, {4}, runs);
  add_runs("surface_diffusion", {"none"}, range(0, paper ? 3 : 2), {2}, runs);
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(2);
  setting.start = options.start.value_or(Start{});
  setting.meshes = options.meshes;
  setting.rule = quadrature_or_default(own.quadrature, setting.degree);
  const bool as_in_the_preset = !options.levels && !options.steps && options.meshes.empty() &&
                                own.runs.empty() && own.projections.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {0});
  const std::vector<std::string> kinds =
      own.runs.empty() ? std::vector<std::string>{"convergence"} : own.runs;
  for (const std::string& kind : kinds) {
    add_runs(kind, own.projections.empty() ? known_projections : own.projections, levels,
             options.steps.value_or(range(2, 3)), setting.runs);
  }
  return setting;
}

/// The step sizes of a run; errors grow on the scale R⁴.
HalvedSteps time_steps(const Run& run) {
  return {std::pow(run.radius, 4), largest_tau};
}

void record_normals(const SurfaceSpace& space, const State& state, Series& series) {
  series["t"].push_back(state.t);
  record_normal_length(state.u.rightCols(3), series);
  const Eigen::VectorXd radius = state.x.rowwise().norm();
  series["min_radius"].push_back(radius.minCoeff());
  series["max_radius"].push_back(radius.maxCoeff());
  record_curvature(space, state.x, state.u.col(0), series);
}

/// The values of a series at the last time, and the largest distances of |nu_h| from 1 and of |x| from the
/// radius over all times.
void describe_normals(const Run& run, Row& row) {
  const auto largest = [&](const std::string& name, double exact) {
    double distance = 0;
    for (const std::string& end : {"min_" + name, "max_" + name}) {
      for (double value : row.series.at(end)) distance = std::max(distance, std::abs(value - exact));
      row.values["last_" + end] = row.series.at(end).back();
    }
    row.values["largest_deviation_of_" + name] = distance;
  };
  largest("nu", 1);
  largest("radius", run.radius);
}

/// The rate a of max ||nu_h| - 1| = c exp(a t), by least squares of the logarithm over the last 30% of the
/// time: the fastest mode has taken over by then.
double growth_rate(const Series& series, double end_time) {
  double n = 0, sum_t = 0, sum_y = 0, sum_tt = 0, sum_ty = 0;
  for (std::size_t i = 0; i < series.at("t").size(); ++i) {
    const double t = series.at("t")[i];
    if (t < 0.7 * end_time) continue;
    const double y =
        std::log(std::max(std::abs(series.at("min_nu")[i] - 1), std::abs(series.at("max_nu")[i] - 1)));
    n += 1, sum_t += t, sum_y += y, sum_tt += t * t, sum_ty += t * y;
  }
  return (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
}

Row run_cell(const Setting& setting, const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = sphere(run.radius);
  const auto generate = [&] {
    return generate_mesh(surface, edge_length(largest_h.at(run.kind) * run.radius, run.level));
  };
  const Mesh mesh = initial_mesh(setting.meshes, run.level, generate, surface, setting.degree);
  const SurfaceSpace space(mesh, setting.rule);
  describe_mesh(mesh, row);

  // 2. The flow from exact values, with the errors of each step.
  StationaryWillmore flow;
  flow.variant.project = run.projection == "projected";
  flow.theta = run.kind == "theta";
  if (run.kind == "surface_diffusion") flow.variant.law = WillmoreFlow::Variant::surface_diffusion;
  flow.grid = {setting.bdf, row.tau, row.steps, setting.start};
  const bool with_normals = run.kind == "normals" || run.kind == "growth";
  const auto observe = [&](const State& state) {
    if (with_normals) record_normals(space, state, row.series);
  };
  run_stationary_willmore(space, mesh, stationary_sphere(run.radius), flow, energy_of_spheres, observe, row);

  // 3. What is said of the normals.
  if (with_normals) describe_normals(run, row);
  if (run.kind == "growth") row.values["growth_rate"] = growth_rate(row.series, time_steps(run).end_time);
  return row;
}

nlohmann::json labels(const Run& run) {
  nlohmann::json labels = {{"run", run.kind}, {"projection", run.projection}};
  if (run.kind == "growth") labels["radius"] = run.radius;
  return labels;
}

std::string cell_name(const Run& run) {
  const std::string kind = run.kind == "growth" ? format("growth_radius%g", run.radius) : run.kind;
  return kind + "_" + run.projection + format("_h%d_tau%d", run.level, run.k);
}

/// Seconds on one core: a step with its errors takes about 8 microseconds a node, a mesh about 0.2 ms a
/// vertex.
double estimated_cost(const Setting& setting, const Run& run) {
  const double vertices = 27.5 / std::pow(edge_length(largest_h.at(run.kind), run.level), 2);
  const double nodes = vertices * setting.degree * setting.degree;
  return 0.1 + vertices * 2e-4 + nodes * time_steps(run).count(run.k) * 8e-6;
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back({cell_name(run), estimated_cost(setting, run),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, row); },
                    planned_row(run.level, time_steps(run), run.k, labels(run))});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", 1},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"start", to_string(setting.start)},
          {"quadrature", setting.rule.name},
          {"meshes", mesh_parameter(setting.meshes, "generated, edge length 0.55 2^(-level/2)")}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "willmore_sphere";
  experiment.paper = "kll21";
  experiment.help =
      "Willmore flow of the unit sphere on [0, 1], without and with projections of nu_h and z_h (kll21 "
      "Figures 7.1 to 7.3):\n"
      "errors of position x, normal nu and mean curvature H over mesh width and step size, and the Willmore "
      "energy. Step\n"
      "sizes 0.2 2^-k, k = 0, 1, ..; edge lengths 0.55 2^(-j/2), level j = 0, 1, .. (normals 0.24, accuracy "
      "0.21, growth\n"
      "0.28 at level 0, times the radius). Lengths and times have no units: V = Lap H + Q.\n"
      "Without --runs, --projection, --levels, --steps, --mesh: the runs of the preset. With one of them: "
      "all\n"
      "combinations, where not given convergence, both projections, level 0, k = 2..3.\n\n"
      "Example: willmore_sphere --runs convergence --levels 0-2 --steps 2 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--runs", known_runs, own.runs,
               "convergence: Figures 7.1, 7.3 | normals: Figure 7.2 | accuracy: as convergence, about "
               "2,500 nodes | theta: with the correction (3.7) | growth: of errors until R⁴, R = 1, "
               "1.5 | surface_diffusion: instead of Willmore flow");
    line.names("--projection", known_projections, own.projections, "of nu_h and z_h after each step");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
