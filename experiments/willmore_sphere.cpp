// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow of a sphere, which is stationary: convergence in space, and the effect of projections (kll21
// §7.1, Figures 7.1 to 7.3)
//
// Sample runs:  build/bin/willmore_sphere --preset check --output sphere.json
//               build/bin/willmore_sphere --projection projected --levels 0-2 --steps 2
//               build/bin/willmore_sphere --run normals --steps 3
//               build/bin/willmore_sphere --bdf 3 --degree 3 --levels 0-1 --steps 2,3
//
// Writes:       results/paper/willmore_sphere.{json,csv,tex}, from which plots/willmore_sphere.py draws
//               figures/kll21/fig7_1 (errors over h without projections), fig7_2 (normals, radii and energy
//               over time) and fig7_3 (errors over h with projections)
//
// A sphere is stationary under Willmore flow. The discretisation is (3.4)-(3.5): quadratic elements and BDF2
// on [0, 1], exact starting values, tau = 0.2 2^-k, h near 0.55 2^(-j/2), without the correction theta of
// (3.7), and after each step without and with projections of nu_h and z_h.
//
// Beside the published runs: with theta and projections the discrete sphere is stationary, too. Surface
// diffusion (1.2), for which the sphere is stationary, too. And a nearly round sphere, whose mode l = 2
// decays at the rate 24.
//
// Expected orders (Theorem 4.1): h² in L^infinity(H1) for x, nu and H. There is no error in time. Without
// projections errors grow like exp(8t) (willmore_projection).
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/nearly_round_runs.hpp"
#include "experiments/harness/stationary_willmore.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/problems/nearly_round_sphere.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const double exact_energy = 8 * pi;

/// Edge lengths of level 0 on the unit sphere.
const std::map<std::string, double> largest_h = {
    {"convergence", 0.55}, {"normals", 0.24}, {"accuracy", 0.21}, {"nearly_round", 0.4}};

HalvedSteps time_steps(const Choice& choice) {
  return choice["run"] == "nearly_round" ? HalvedSteps{0.05, 5e-4} : HalvedSteps{1, 0.2};
}

Block otherwise(bool) {
  return {{"run", "convergence"}, {"flow", "willmore"}, {"theta", "no"},      {"degree", 2}, {"bdf", 2},
          {"start", "exact"},     {"level", 0},         {"step", range(2, 3)}};
}

std::vector<Block> preset(bool paper) {
  return {{{"level", range(0, paper ? 4 : 3)}, {"step", paper ? range(0, 6) : range(1, 3)}},
          {{"run", "normals"}, {"step", 3}},
          {{"run", "accuracy"}, {"projection", "projected"}, {"step", 2}},
          {{"run", "nearly_round"},
           {"flow", {"willmore", "surface_diffusion"}},
           {"projection", "none"},
           {"step", 0}},
          {{"theta", "yes"}, {"projection", "projected"}, {"level", {0, 1}}, {"step", 2}},
          {{"flow", "surface_diffusion"},
           {"projection", "none"},
           {"level", range(0, paper ? 3 : 2)},
           {"step", 2}}};
}

void record_normals(const SurfaceSpace& space, const State& state, Series& series) {
  series["t"].push_back(state.t);
  record_normal_length(state.u.rightCols(3), series);
  const Eigen::VectorXd radius = state.x.rowwise().norm();
  series["min_radius"].push_back(radius.minCoeff());
  series["max_radius"].push_back(radius.maxCoeff());
  record_curvature(space, state.x, state.u.col(0), series);
}

/// The values of |nu_h| and |x| at the last time, and their largest distances from 1 over all times.
void describe_normals(Row& row) {
  for (const std::string name : {"nu", "radius"}) {
    const std::vector<double>&least = row.series.at("min_" + name), &most = row.series.at("max_" + name);
    row.values["last_min_" + name] = least.back();
    row.values["last_max_" + name] = most.back();
    row.values["largest_deviation_of_" + name] =
        std::max(largest_deviation(least, 1), largest_deviation(most, 1));
  }
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it.
  const bool nearly_round = choice["run"] == "nearly_round";
  const Surface surface = nearly_round ? nearly_round_sphere() : sphere(1);
  const auto generate = [&] {
    return generate_mesh(surface, edge_length(largest_h.at(choice["run"]), choice.level()));
  };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow from exact values, with the errors of each step.
  StationaryWillmore setting;
  setting.variant.projection = projection_of(choice["projection"]);
  if (choice["flow"] == "surface_diffusion") setting.variant.law = surface_diffusion_law();
  setting.theta = choice["theta"] == "yes";
  setting.grid = {choice.bdf(), row.tau, row.steps,
                  nearly_round ? parse_start("substeps:16") : choice.start()};
  if (nearly_round)
    return measure_willmore_decay(space, mesh.nodes, setting.variant, setting.theta, setting.grid, row);
  const bool with_normals = choice["run"] == "normals";
  const auto observe = [&](const State& state) {
    if (with_normals) record_normals(space, state, row.series);
  };
  run_stationary_willmore(space, mesh, stationary_sphere(1), setting, exact_energy, observe, row);

  // 3. What is said of the normals.
  if (with_normals) describe_normals(row);
}

/// A step with its errors takes about 8 microseconds a node, a mesh about 0.2 ms a vertex.
double cost(const Choice& choice) {
  const double vertices = 27.5 / std::pow(edge_length(largest_h.at(choice["run"]), choice.level()), 2);
  const double nodes = vertices * choice.degree() * choice.degree();
  return 0.1 + vertices * 2e-4 + nodes * time_steps(choice).count(choice.step()) * 8e-6;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_sphere", "kll21", run, otherwise, preset);
  experiment.help =
      "Willmore flow of the unit sphere on [0, 1], without and with projections of nu_h and z_h (kll21\n"
      "Figures 7.1 to 7.3): errors of position x, normal nu and mean curvature H over mesh width and step "
      "size,\n"
      "and the Willmore energy. Step sizes 0.2 2^-k, k = 0, 1, ..; edge lengths 0.55 2^(-j/2), level j = 0, "
      "1,\n"
      ".. (normals 0.24, accuracy 0.21 at level 0). Lengths and times have no units: V = Lap H + Q.\n\n"
      "Example: willmore_sphere --levels 0-2 --steps 2 --output table.json";
  experiment.grid.axes = {
      {"run", names_of(largest_h),
       "convergence: Figures 7.1, 7.3 | normals: Figure 7.2 | accuracy: as convergence, about 2,500 nodes | "
       "nearly_round: decay of the mode l = 2, on [0, 0.05]"},
      {"flow", {"willmore", "surface_diffusion"}, "willmore: kll21 (1.1) | surface_diffusion: (1.2)"},
      {"projection", {"none", "projected"}, "of nu_h and z_h after each step"},
      {"theta", {"no", "yes"}, "the correction (3.7)"}};
  experiment.grid.labels = {"run", "flow", "projection", "theta"};
  experiment.comparisons = {
      {{{"projection", "projected"}}, "_over_projected", {"largest_deviation_of_radius", "willmore_excess"}}};
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.known_end = [](const Choice& choice) {
    const bool grows = choice["flow"] == "willmore" && choice["projection"] == "none" && choice.level() == 0;
    return grows ? "without projection |nu_h| - 1 grows like exp(8t)" : "";
  };
  experiment.parameters = {{"end_time", 1}};
  experiment.meshes = "generated, edge length 0.55 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
