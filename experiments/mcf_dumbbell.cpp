// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of a dumbbell up to its pinch singularity: several algorithms side by side (kll19
// §13.2, Figures 13.3 to 13.6)
//
// Sample runs:  build/bin/mcf_dumbbell --preset check --output dumbbell.json
//               build/bin/mcf_dumbbell --methods dziuk,bgn --levels 0 --steps 1 --start cascade
//               build/bin/mcf_dumbbell --methods kll --mesh reference/independent/dumbbell_450.msh
//
// Writes:       results/paper/mcf_dumbbell.{json,csv,tex}, from which plots/mcf_dumbbell.py draws
// figures/kll19/fig13_3 ..
//               fig13_6, and the surfaces of each run as results/paper/cells/mcf_dumbbell/CELL/surfaces.pvd
//               (ParaView)
//
// The dumbbell {x1² + x2² + 2 x3² (x3² - 199/200) = 0.04} moves by v = -H nu until its neck pinches, at T* =
// 0.082233 (reference/independent/dumbbell_axisymmetric.json). The methods are Dziuk's scheme (3.6), (5.1),
// (5.1) with normalised nu_h, (5.1) with the stabilising term of §14, (5.1) with v_h by interpolation, and
// the scheme of Barrett, Garcke and Nürnberg (2008). The paper's setting is about 10,522 nodes, BDF2 started
// by one backward Euler step, tau = 0.003; a good start by substeps and smaller tau show what is due to the
// method itself. A run ends by itself at the singularity (flows/regularity.hpp).
//
// Expected: all methods pinch at T* as tau and h go to 0; no orders are measured here.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/error.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{0.12, 0.003};
const std::vector<double> snapshot_times = {0.03, 0.06, 0.072};

const std::vector<std::string> known_methods = {
    "dziuk",        "kll", "kll_normalised", "kll_interpolated", "kll_alpha1", "kll_alpha10",
    "kll_alpha100", "bgn", "bgn_p1"};

bool starts_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// One run of the grid.
struct Run {
  std::string method;
  Start start;
  int level, k;
};

struct Setting {
  std::vector<Run> runs;
  int degree, bdf;
  std::vector<std::string> meshes;
};

/// Whether the method takes starting values: the scheme of BGN has one step.
bool has_start(const std::string& method) {
  return !starts_with(method, "bgn");
}

/// All runs of some methods with one start.
void add_runs(const std::vector<std::string>& methods, const Start& start, const std::vector<int>& levels,
              const std::vector<int>& steps, std::vector<Run>& runs) {
  for (const std::string& method : methods) {
    for (int level : levels) {
      for (int k : steps) runs.push_back({method, start, level, k});
    }
  }
}

/// The runs of a preset: the paper's setting, and what a good start, smaller step sizes and other methods
/// make of it.
std::vector<Run> preset_runs(const std::string& preset) {
  const Start one_euler_step = parse_start("cascade"), good = parse_start("substeps:16");
  const std::vector<std::string> three = {"dziuk", "kll", "kll_normalised"};
  const std::vector<std::string> stabilised = {"kll_alpha1", "kll_alpha10", "kll_alpha100"};
  std::vector<Run> runs;
  add_runs(three, one_euler_step, {1}, {0}, runs);
  add_runs(stabilised, one_euler_step, {1}, {0}, runs);
  add_runs({"kll"}, one_euler_step, {1}, {2}, runs);
  add_runs(three, one_euler_step, {0}, {2}, runs);
  add_runs(three, good, {0}, {2}, runs);
  add_runs({"kll_interpolated"}, good, {0}, {2}, runs);
  add_runs(three, good, {1}, {0, 2}, runs);
  add_runs({"bgn"}, one_euler_step, {0}, {0, 1}, runs);
  add_runs({"bgn_p1"}, one_euler_step, {0}, {0}, runs);
  if (preset == "paper") {
    add_runs(three, good, {1}, {1}, runs);
    add_runs({"bgn"}, one_euler_step, {1}, {0, 1}, runs);
    add_runs({"bgn_p1"}, one_euler_step, {1}, {0}, runs);
  }
  return runs;
}

Setting resolve(const Options& options, const std::vector<std::string>& methods) {
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(2);
  setting.meshes = options.meshes;
  const bool as_in_the_preset =
      !options.levels && !options.steps && !options.start && options.meshes.empty() && methods.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {0});
  if (options.meshes.empty()) require_levels(levels, 2, "levels");
  const Start start = options.start.value_or(parse_start("substeps:16"));
  if (start.kind == Start::exact) {
    throw InputError(
        "--start exact: no exact solution of the dumbbell is known; expected cascade or substeps:K");
  }
  add_runs(methods.empty() ? known_methods : methods, start, levels,
           options.steps.value_or(std::vector<int>{0}), setting.runs);
  return setting;
}

/// Level 0: about 3,000 nodes of quadratic elements, edges at most as long as the local radius of curvature;
/// level 1: as published, about 10,522 nodes with edges of equal length.
Mesh corner_mesh_of_level(int level) {
  const Surface surface = dumbbell();
  if (level == 1) return generate_mesh(surface, 0.0902);
  const double largest = 0.2;
  return generate_mesh(surface, [&](const Vec3& y) {
    const Mat3 A = surface.weingarten(y);
    return 1 / std::sqrt(1 / (largest * largest) + A.squaredNorm());
  });
}

/// For bgn_p1, linear elements between the nodes of quadratic ones.
Mesh mesh_of(const Setting& setting, const Run& run) {
  const bool linear = run.method == "bgn_p1";
  const auto generate = [&] { return corner_mesh_of_level(run.level); };
  const Mesh mesh =
      initial_mesh(setting.meshes, run.level, generate, dumbbell(), linear ? 2 : setting.degree);
  return linear ? subdivide(mesh) : mesh;
}

/// Appends how the nodes have spread: of ten rings of equal height |x3|, from the neck to the tip, the one
/// whose triangles (between the corners) have the smallest mean area. "smallest_elements" is this area over
/// that of all, "smallest_elements_x3" the middle of the ring over |x3| of the widest circle.
void record_node_density(const Connectivity& elements, const Field& x, Series& series) {
  const int rings = 10;
  const double tip = x.col(2).cwiseAbs().maxCoeff();
  std::vector<double> area(rings, 0), count(rings, 0);
  for (Eigen::Index e = 0; e < elements.rows(); ++e) {
    const Vec3 a = x.row(elements(e, 0)), b = x.row(elements(e, 1)), c = x.row(elements(e, 2));
    const int ring = std::min(rings - 1, static_cast<int>(rings * std::abs((a + b + c)[2] / 3) / tip));
    area[ring] += (b - a).cross(c - a).norm() / 2;
    count[ring] += 1;
  }
  const double mean_of_all = std::accumulate(area.begin(), area.end(), 0.0) / elements.rows();
  double smallest = mean_of_all, x3 = 0;
  for (int ring = 0; ring < rings; ++ring) {
    if (count[ring] == 0 || area[ring] / count[ring] >= smallest) continue;
    smallest = area[ring] / count[ring];
    x3 = (ring + 0.5) / rings * tip;
  }
  Eigen::Index widest;
  x.leftCols(2).rowwise().norm().maxCoeff(&widest);
  series["smallest_elements"].push_back(smallest / mean_of_all);
  series["smallest_elements_x3"].push_back(x3 / std::abs(x(widest, 2)));
}

/// Runs a flow until its end, or until it is singular or fails; returns the status of the row.
template <class Flow>
std::string run_flow(Flow flow, const SurfaceSpace& space, const typename Flow::State& initial,
                     const UniformSteps& grid, RunRecorder& recorder) {
  const auto record = [&](int n, const typename Flow::State& state) {
    recorder.record(n, state.t, state.x, nodal_fields(state));
    record_profile(state.x, recorder.series());
    record_node_density(space.elements(), state.x, recorder.series());
  };
  return run_to_end([&] { integrate(flow, grid, initial, record); }, recorder);
}

MeanCurvatureFlow::Variant variant_of(const std::string& method) {
  MeanCurvatureFlow::Variant variant;
  variant.normalise = method == "kll_normalised";
  if (method == "kll_interpolated") variant.velocity = MeanCurvatureFlow::Variant::interpolation;
  const std::string stabilised = "kll_alpha";
  if (starts_with(method, stabilised)) variant.stabilise = std::stod(method.substr(stabilised.size()));
  return variant;
}

/// The value of a series at the recorded time nearest to t; nothing when the run ended before.
std::optional<double> value_at(const Series& series, const std::string& name, double t) {
  const std::vector<double>& times = series.at("t");
  const auto nearest = std::min_element(
      times.begin(), times.end(), [t](double a, double b) { return std::abs(a - t) < std::abs(b - t); });
  if (std::abs(*nearest - t) > 1e-9) return {};
  return series.at(name)[nearest - times.begin()];
}

/// The numbers that claims are about.
std::map<std::string, double> values(const Series& series) {
  std::map<std::string, double> list;
  const auto add = [&](const std::string& name, std::optional<double> value) {
    if (value) list[name] = *value;
  };
  add("pinch_time", pinch_time(series));
  for (const char* name : {"widest_radius", "tip", "max_H", "max_nu", "worst_angle", "smallest_elements",
                           "smallest_elements_x3"}) {
    if (series.count(name)) add(std::string(name) + "_at_0.06", value_at(series, name, 0.06));
  }
  for (const char* name : {"widest_radius", "neck_radius"})
    add(std::string(name) + "_at_0.069", value_at(series, name, 0.069));
  for (const char* name : {"max_H", "max_nu", "min_nu", "worst_angle", "neck_radius", "t"}) {
    if (series.count(name)) add(std::string("last_") + name, series.at(name).back());
  }
  if (series.count("max_nu")) {
    double deviation = 0;
    for (double length : series.at("max_nu")) deviation = std::max(deviation, std::abs(length - 1));
    for (double length : series.at("min_nu")) deviation = std::max(deviation, std::abs(length - 1));
    add("largest_deviation_of_nu", deviation);
  }
  return list;
}

/// What tells the rows of the table apart beside mesh and step size.
nlohmann::json labels(const Run& run) {
  return {{"method", run.method}, {"start", has_start(run.method) ? to_string(run.start) : "none"}};
}

Row run_cell(const Setting& setting, const Run& run, Row row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Mesh mesh = mesh_of(setting, run);
  const SurfaceSpace space(mesh,
                           run.method == "bgn_p1" ? vertex_quadrature() : default_quadrature(mesh.degree));
  describe_mesh(mesh, row);

  // 2. The time steps, until the end or the singularity.
  const bool bgn = !has_start(run.method);
  const std::string flow = bgn ? "bgn" : run.method == "dziuk" ? "dziuk" : "mean_curvature";
  const UniformSteps grid{bgn ? 1 : setting.bdf, row.tau, row.steps, run.start};
  RunRecorder recorder(space, snapshot_plan(folder, snapshot_times, flow, row));
  if (bgn) {
    row.status = run_flow(BgnFlow(space), space, bgn_state_on(space, mesh.nodes), grid, recorder);
  } else if (run.method == "dziuk") {
    warn(dziuk_warning(grid.order));
    row.status = run_flow(DziukFlow(space), space, dziuk_state_on(space, mesh.nodes), grid, recorder);
  } else {
    row.status = run_flow(MeanCurvatureFlow(space, variant_of(run.method)), space,
                          mean_curvature_state_on(dumbbell(), mesh.nodes), grid, recorder);
  }

  // 3. The row of the table.
  describe_run(recorder, row);
  row.values = values(row.series);
  return row;
}

std::string cell_name(const Run& run) {
  std::string start = to_string(run.start);
  start.erase(std::remove(start.begin(), start.end(), ':'), start.end());
  return run.method + (has_start(run.method) ? "_" + start : "") + format("_h%d_tau%d", run.level, run.k);
}

/// Seconds on one core until the pinch: a step with what is recorded of it takes about 5 microseconds a node,
/// one of BGN's scheme 60.
double estimated_cost(const Run& run) {
  const double nodes = run.level == 1 ? 10522 : 3000;
  const double steps = 0.083 / time_steps.tau(run.k);
  return 1 + nodes * steps * (!has_start(run.method) ? 60e-6 : 5e-6);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back(
        {cell_name(run), estimated_cost(run),
         [=](const Row& row, const std::string& folder) { return run_cell(setting, run, row, folder); },
         planned_row(run.level, time_steps, run.k, labels(run))});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  const char* generated =
      "generated, level 0: edge length (0.2^-2 + kappa_1² + kappa_2²)^(-1/2), level 1: 0.0902";
  return {{"preset", preset},
          {"end_time", time_steps.end_time},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"meshes", mesh_parameter(setting.meshes, generated)},
          {"largest_tau", time_steps.largest}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> methods;
  Experiment experiment;
  experiment.stem = "mcf_dumbbell";
  experiment.paper = "kll19";
  experiment.help =
      "Mean curvature flow of a dumbbell up to its pinch singularity at t = 0.082233 by several methods "
      "(kll19 Figures\n"
      "13.3 to 13.6): time series, snapshots and the pinch time of each. Step sizes 0.003 2^-k, k = 0, 1, "
      "..; level 0: about\n"
      "3,000 nodes, level 1: about 10,522, as published. Lengths and times have no units: v = -H nu.\n"
      "Without --methods, --levels, --steps, --start, --mesh: the runs of the preset. With one of them: all "
      "combinations,\n"
      "where not given of all methods, level 0, k = 0, start substeps:16.\n"
      "With --output FILE.json the surfaces go to cells/mcf_dumbbell/CELL/surfaces.pvd beside it.\n\n"
      "Example: mcf_dumbbell --methods kll_normalised --levels 1 --steps 2 --output dumbbell.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--methods", known_methods, methods,
               "dziuk: (3.6) | kll: (5.1) | kll_normalised | kll_interpolated: velocity | kll_alpha1, "
               "10, 100: with the stabilising "
               "term of §14 | "
               "bgn, bgn_p1: Barrett, Garcke, Nürnberg 2008, BDF1, P1: on triangles cut into four");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, methods)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, methods), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
