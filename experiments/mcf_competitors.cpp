// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow by three schemes side by side, error against time: kll19 (5.1), Dziuk's (3.6), and that
// of Barrett, Garcke and Nürnberg
//
// Sample runs:  build/bin/mcf_competitors --preset check --output competitors.json
//               build/bin/mcf_competitors --surface sphere --flow mean_curvature,bgn --levels 0 --steps 0-2
//
// Writes:       results/paper/mcf_competitors.{json,csv,tex}, from which plots/mcf_competitors.py draws
//               figures/gallery/mcf_competitors
//
// The sphere of radius 2 on [0, 0.6] and the self-shrinking torus on [0, 0.2], whose solutions are known. All
// schemes run on the same meshes with quadratic elements, (5.1) and Dziuk's with BDF 1 to 3 and exact
// starting values, BGN's, which is of first order, also with linear elements and lumped masses, as published.
// Seconds are the CPU time of the steps alone; errors are recorded at about 12 times during the run.
// The nodes of BGN's scheme slide along the surface, which counts as an error of x; `distance` is that of the
// nodes from the exact surface (root mean square), the largest recorded value.
//
// Expected: BGN's scheme, of order 1 in time and with a system for four unknowns a node, is the least
// accurate per second. Between the others it depends on the quantity. Dziuk's steps take half as long.
// Its nodes stay as close to the surface, on the sphere even closer; but if the surface is not a sphere
// they slide, and its normals and curvatures, those of the discrete surface, are 10 to 100 times less
// accurate.
#include <cmath>

#include "experiments/harness/distance.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/mean_curvature_flows.hpp"
#include "experiments/harness/timed.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace {

using namespace esfem;

const int recorded_steps = 12;

/// A surface to start from, its solution, meshes and step sizes. Each level of the mesh has twice as many
/// triangles as the one before.
struct Case {
  ExactEvolution exact;
  HalvedSteps time_steps;
  double largest_h, vertices;  ///< of level 0
};

const Case& case_of(const Choice& choice) {
  static const std::map<std::string, Case> cases = {
      {"sphere", {shrinking_sphere(2), {0.6, 0.05}, 0.5, 440}},
      {"angenent_torus", {shrinking_angenent_torus(), {0.2, 0.02}, 0.66, 715}}};
  return cases.at(choice["surface"]);
}

Block otherwise(bool) {
  return {{"surface", {"sphere", "angenent_torus"}},
          {"flow", {"mean_curvature", "dziuk", "bgn"}},
          {"degree", 2},
          {"bdf", 2},
          {"level", 0},
          {"step", range(0, 2)}};
}

std::vector<Block> preset(bool paper) {
  const std::vector<int> some = paper ? range(0, 2) : range(1, 1), many = paper ? range(0, 3) : some;
  const std::vector<int> two = paper ? range(0, 1) : range(0, 0), three = paper ? range(0, 2) : two;
  std::vector<Block> blocks = {{{"flow", "mean_curvature"}, {"bdf", 3}, {"level", three}, {"step", many}},
                               {{"flow", "dziuk"}, {"bdf", 3}, {"level", three}, {"step", many}},
                               {{"flow", "dziuk"}, {"bdf", 2}, {"level", two}, {"step", some}},
                               {{"flow", "bgn"}, {"step", many}},
                               {{"flow", "bgn"}, {"degree", 1}, {"level", two}, {"step", many}}};
  if (paper) blocks.push_back({{"flow", {"mean_curvature", "dziuk"}}, {"bdf", 1}, {"step", many}});
  return blocks;
}

/// Runs the flow from exact_state(0), and fills in errors, distance and seconds.
template <class Flow, class ExactState>
void measure(const SurfaceSpace& space, const ExactEvolution& exact, const Field& x0, Flow& flow,
             const ExactState& exact_state, int bdf, Row& row) {
  Timed<Flow> timed{flow};
  ErrorRecorder errors(space, exact, x0);
  const int every = std::max(1, row.steps / recorded_steps);
  double farthest = 0;
  integrate(timed, UniformSteps{bdf, row.tau, row.steps}, {exact_state(0.0), exact_state},
            [&](int n, const auto& state) {
              if (n % every != 0 && n != row.steps) return;
              errors.record(state);
              farthest = std::max(farthest, distance(exact.surface(state.t), state.x));
            });
  row.errors = errors.maxima();
  row.values = {{"distance", farthest},
                {"seconds_of_steps", timed.seconds},
                {"seconds_per_step", timed.seconds / (row.steps - bdf + 1)}};
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it; that of BGN for P1 is lumped.
  const ExactEvolution& exact = case_of(choice).exact;
  const Surface surface = exact.surface(0);
  const double h = edge_length(case_of(choice).largest_h, choice.level());
  const auto generate = [&] {
    return choice["surface"] == "sphere" ? generate_mesh(surface, h)
                                         : generate_mesh(surface, angenent_torus_edge_length(h));
  };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const bool lumped = choice["flow"] == "bgn" && choice.degree() == 1;
  const SurfaceSpace space(mesh, lumped ? vertex_quadrature() : choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The time steps, some with their errors.
  with_mean_curvature_flow(choice["flow"], space, exact, mesh.nodes, [&](auto flow, const auto& exact_state) {
    measure(space, exact, mesh.nodes, flow, exact_state, choice.bdf(), row);
  });
}

/// BGN's scheme has a system for four unknowns a node.
double cost(const Choice& choice) {
  const Case& start = case_of(choice);
  const double nodes = start.vertices * choice.degree() * choice.degree() * std::pow(2, choice.level());
  const double steps = start.time_steps.count(choice.step());
  return nodes * (2e-4 + steps * (choice["flow"] == "bgn" ? 30e-6 * choice.degree() : 4e-6) +
                  std::min<double>(steps, recorded_steps) * 8e-6);
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("mcf_competitors", "esfem", run, otherwise, preset);
  experiment.help =
      "Mean curvature flow of the sphere of radius 2 on [0, 0.6] and the self-shrinking torus on [0, 0.2]\n"
      "by three schemes: errors, distance of the nodes from the exact surface, and seconds of the steps.\n"
      "Step sizes 0.05 2^-k and 0.02 2^-k; level j of the meshes has 2^j times as many triangles as\n"
      "level 0. No units.\n\n"
      "Example: mcf_competitors --surface sphere --flow mean_curvature,bgn --steps 0-3 --output table.json";
  experiment.grid.axes = {
      {"surface", {"sphere", "angenent_torus"}, "surfaces to start from"},
      {"flow",
       {"mean_curvature", "dziuk", "bgn"},
       "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6) | bgn: Barrett, Garcke, Nürnberg 2008, of order 1"}};
  experiment.grid.labels = {"surface", "flow", "degree", "bdf"};
  experiment.grid.implied = [](const Choice& choice) {
    return choice["flow"] == "bgn" ? Block{{"bdf", 1}} : Block();  // a scheme of first order
  };
  const std::string why = "all schemes run on generated meshes from exact starting values";
  experiment.grid.refused = {{"mesh", why}, {"start", why}};
  const nlohmann::json kll19 = {{"flow", "mean_curvature"}, {"bdf", 3}},
                       euler = {{"flow", "dziuk"}, {"bdf", 1}};
  experiment.comparisons = {{kll19, "_over_kll19", {"distance", "x_nodal_L2", "nu_nodal_H1", "H_nodal_L2"}},
                            {euler, "_over_dziuk_bdf1", {"x_nodal_L2"}},
                            {nlohmann::json::object(), "_over_larger_tau", {"distance"}, 0, 4}};
  experiment.steps = [](const Choice& choice) { return case_of(choice).time_steps; };
  experiment.cost = cost;
  experiment.parameters = {{"start", "exact"},
                           {"end_time", {{"sphere", 0.6}, {"angenent_torus", 0.2}}},
                           {"largest_tau", {{"sphere", 0.05}, {"angenent_torus", 0.02}}}};
  experiment.meshes = "generated, edge lengths 0.5 (sphere), 0.33 to 0.66 (torus) times 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
