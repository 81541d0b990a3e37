// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow of the Clifford torus, which is stationary: convergence in space, and stability of the
// discretisations (kll21 §7.1, Figure 7.4)
//
// Sample runs:  build/bin/willmore_clifford_torus --preset check --output torus.json
//               build/bin/willmore_clifford_torus --triangulation graded --levels 0,1 --steps 2
//               build/bin/willmore_clifford_torus --run stability --F implicit --levels 2 --steps 0-4
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
// Expected orders (Theorem 4.1): h² in L^infinity(H1) for x, nu and H. The only error in time is that of
// the projections. The damping of BDF1 is needed: BDF2 does not reach t = 1 for tau from 0.0125 to 0.05, and
// when tau is as small as 0.003 BDF1, too, lets errors grow on unstructured meshes, like exp(10t).
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/stationary_willmore.hpp"
#include "solver/constants.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_evolution.hpp"

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

Block otherwise(bool) {
  return {{"run", "convergence"}, {"triangulation", "isothermal"},
          {"F", "extrapolated"},  {"theta", "no"},
          {"degree", 2},          {"bdf", 1},
          {"start", "exact"},     {"level", 0},
          {"step", range(2, 3)}};
}

std::vector<Block> preset(bool paper) {
  std::vector<Block> blocks = {
      {{"level", range(0, paper ? 5 : 3)}, {"step", paper ? range(0, 6) : range(1, 2)}},
      {{"triangulation", "graded"}, {"level", range(0, paper ? 3 : 1)}, {"step", range(1, paper ? 4 : 3)}},
      {{"theta", "yes"}, {"level", range(1, paper ? 5 : 3)}, {"step", 3}},
      {{"bdf", 2}, {"level", range(1, paper ? 5 : 3)}, {"step", 3}},
      {{"run", "stability"},
       {"F", {"extrapolated", "implicit"}},
       {"bdf", {1, 2}},
       {"level", 2},
       {"step", paper ? range(0, 5) : range(1, 3)}},
      {{"run", "accuracy"}, {"triangulation", {"isothermal", "graded"}}, {"step", 4}}};
  if (paper)
    blocks.push_back({{"triangulation", "graded"}, {"level", range(0, 2)}, {"step", {5, 6}}});
  else
    blocks.push_back({{"level", range(0, 5)}, {"step", 3}});
  return blocks;
}

Mesh generated(const Choice& choice) {
  const bool accuracy = choice["run"] == "accuracy";
  const int level = choice.level();
  if (choice["triangulation"] == "graded") {
    const double largest = edge_length(accuracy ? accuracy_h : largest_h, level);
    return generate_mesh(torus(major, minor), torus_edge_length(major, minor, largest));
  }
  if (!accuracy) require_levels({level}, static_cast<int>(grid_sizes.size()), "isothermal grids");
  const int n = accuracy ? static_cast<int>(std::lround(accuracy_grid_size * std::pow(2, 0.5 * level)))
                         : grid_sizes[level];
  return isothermal_torus_grid(major, minor, n, n);
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it.
  const Mesh mesh = initial_mesh(
      choice, [&] { return generated(choice); }, torus(major, minor));
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow from exact values, with the errors of each step.
  StationaryWillmore setting;
  if (choice["F"] == "implicit") setting.variant.F = WillmoreFlow::Variant::implicit;
  setting.theta = choice["theta"] == "yes";
  setting.grid = {choice.bdf(), row.tau, row.steps, choice.start()};
  run_stationary_willmore(space, mesh, stationary_torus(major, minor), setting, exact_energy, {}, row);
}

double estimated_nodes(const Choice& choice) {
  if (choice["run"] == "accuracy") return 1936 * std::pow(2, choice.level());
  if (choice["triangulation"] == "isothermal" && choice.level() < static_cast<int>(grid_sizes.size()))
    return 4 * std::pow(grid_sizes[choice.level()], 2);
  return 850 * std::pow(2, choice.level());
}

/// A step with its errors takes about 8 microseconds a node, 30 where F is implicit.
double cost(const Choice& choice) {
  const double nodes = estimated_nodes(choice) * choice.degree() * choice.degree() / 4;
  return 0.1 + nodes * time_steps.count(choice.step()) * (choice["F"] == "implicit" ? 30e-6 : 8e-6);
}

std::string known_end(const Choice& choice) {
  if (choice["triangulation"] != "isothermal" || choice["run"] == "accuracy") return "";
  const int k = choice.step();
  if (choice["F"] == "implicit" && k >= 1 && k <= 3) return "implicit F is unstable for 0.02 < tau <= 0.1";
  if (choice.bdf() == 2 && k >= 1 && k <= 4) return "BDF2 is unstable for 0.01 < tau <= 0.1";
  return choice.level() == 0 && k <= 2 ? "256 nodes do not resolve the torus" : "";
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_clifford_torus", "kll21", run, otherwise, preset);
  experiment.help =
      "Willmore flow of the Clifford torus with radii 1 and 1/sqrt 2 on [0, 1] (kll21 Figure 7.4): errors of "
      "position x,\n"
      "normal nu and mean curvature H over mesh width and step size, and the Willmore energy. Step sizes 0.2 "
      "2^-k, k = 0,\n"
      "1, ..; isothermal grids of n x n cells, n = 8, 12, 16, 24, 32, 44 at level 0, 1, .., graded meshes "
      "with largest edges\n"
      "0.7 2^(-j/2), level j. Lengths and times have no units: V = Lap H + Q.\n\n"
      "Example: willmore_clifford_torus --levels 0-2 --steps 2 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"convergence", "stability", "accuracy"},
       "convergence: Figure 7.4 | stability: the same, over tau | accuracy: about 1,936 nodes"},
      {"triangulation",
       {"isothermal", "graded"},
       "isothermal: uniform in isothermal coordinates | graded: unstructured, finer at the hole"},
      {"F", {"extrapolated", "implicit"}, "F(x, u) w of (3.5a): extrapolated | implicit in w"},
      {"theta", {"no", "yes"}, "the correction (3.7)"}};
  experiment.grid.labels = {"run", "triangulation", "F", "theta", "bdf"};
  experiment.comparisons = {{{{"triangulation", "graded"}}, "_over_graded", {"x_nodal_H1"}}};
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = cost;
  experiment.known_end = known_end;
  experiment.parameters = {{"major", major}, {"minor", minor}, {"end_time", time_steps.end_time}};
  experiment.meshes =
      "isothermal: n x n cells, n = 8, 12, 16, 24, 32, 44; graded: generated, largest edge 0.7 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
