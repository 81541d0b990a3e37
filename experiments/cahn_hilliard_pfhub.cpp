// SPDX-License-Identifier: GPL-3.0-or-later
//
// Spinodal decomposition on a sphere (PFHub benchmark 1d): the published energies, and how they depend on
// the mesh and on the steps
//
// Sample runs:  build/bin/cahn_hilliard_pfhub --preset check --output pfhub.json
//               build/bin/cahn_hilliard_pfhub --degree 2 --levels 0-2 --end_time 300
//               build/bin/cahn_hilliard_pfhub --stepping moose --tolerance 1e-9 --levels 0,1
//
// Writes:       results/paper/cahn_hilliard_pfhub.{json,csv,tex}, from which
//               plots/cahn_hilliard_pfhub.py draws figures/pfhub/fig1d, and c on the sphere as
//               results/paper/cells/cahn_hilliard_pfhub/CELL/surfaces.pvd
//
// Cahn-Hilliard equation on a sphere of radius 100 at rest (solver/problems/pfhub_sphere.hpp), from waves
// around c = 0.5 until it is steady, with g linearised in each step
// (solver/flows/linearised_cahn_hilliard.hpp). Stepping:
//   adaptive  BDF2, steps from 0.01 on that follow c, as far as t = 1.5e5
//   moose     backward Euler with Newton's method and the steps of the published run until its third time:
//             1, 1.1, .., 1.1^4, and then 15 of 1.1^5. They follow from its times: 6.1051 = 1 + .. + 1.1^4,
//             and 14.158 and 30.263 come 5 and 15 steps of 1.1^5 later.
//
// When a run with linear elements has become steady, it continues with quadratic ones on the same triangles.
//
// Expected: with its steps, its energies to 3%; with small steps the decomposition is 3 time units later.
// The steady states with 3,000 and 6,000 linear nodes are caused by the meshes: an interface is 2 sqrt 5
// = 4.5 wide, and edges of 5 or 7 pin it. On quadratic elements coarsening continues.
#include <algorithm>
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/pfhub_observer.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = CahnHilliardState;
using Flow = LinearisedCahnHilliard<PfhubSphere>;

const double steady_time = 1.5e5, early_time = 300, first_step = 0.01, largest_tolerance = 2e-3;
/// g is linearised again when c has changed by more than this in a node: else energy rises by up to 1e-3
/// where a domain vanishes, which the root mean square hardly shows.
const double linearised_again_from = 0.03;

bool is_adaptive(const Choice& choice) {
  return choice["stepping"] == "adaptive";
}

double end_time(const Choice& choice) {
  return is_adaptive(choice) ? choice.number("end_time") : moose_times().back();
}

Block otherwise(bool) {
  return {{"stepping", "adaptive"},
          {"end_time", steady_time},
          {"degree", 1},
          {"bdf", 2},
          {"level", 1},
          {"tolerance", largest_tolerance / 2}};
}

std::vector<Block> preset(bool paper) {
  std::vector<Block> blocks = {{{"stepping", "moose"}}};
  if (!paper) {
    blocks.push_back({{"end_time", early_time}});
    return blocks;
  }
  const std::vector<Block> adaptive = {
      {{"level", 0}, {"tolerance", largest_tolerance}},
      {{"level", 1}},
      {{"level", 1}, {"tolerance", largest_tolerance / 8}, {"end_time", early_time}},
      {{"degree", 2}, {"level", 2}, {"tolerance", largest_tolerance}},
      {{"degree", 2}, {"level", 3}, {"end_time", early_time}}};
  blocks.insert(blocks.end(), adaptive.begin(), adaptive.end());
  return blocks;
}

/// MOOSE's steps are those of backward Euler; the tolerance is that of Newton's method.
Block implied(const Choice& choice) {
  return is_adaptive(choice) ? Block() : Block{{"bdf", 1}, {"tolerance", 1e-9}};
}

AdaptiveSteps adaptive_steps(int bdf, double end_time, double tolerance) {
  AdaptiveSteps steps;
  steps.controlled = "u";
  steps.order = bdf;
  steps.end_time = end_time;
  steps.tolerance = tolerance;
  steps.first_step = first_step;
  return steps;
}

/// Tests whether a state of linear elements is steady only because of the mesh: continues from it with
/// quadratic elements on the same triangles. The energy after 100 time units, when the profiles of the
/// interfaces have become those of the finer mesh, and after 5000 go into the row.
void release(const Mesh& linear, const Field& c, Row& row) {
  Mesh mesh = lagrange_mesh(linear, 2);
  project_nodes(mesh, sphere(PfhubSphere::radius));
  const Field c_fine = lagrange_values(linear, c, mesh);
  const SurfaceSpace space(mesh);
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  Flow flow(space, PfhubSphere(), at_rest, PfhubSphere::epsilon, linearised_again_from);
  const AdaptiveSteps steps = adaptive_steps(2, 5000, largest_tolerance);
  integrate(flow, steps, pfhub_state(space, mesh.nodes, c_fine), [&](int, const State& state) {
    const double energy = pfhub_energy(space, state.x, state.u);
    if (state.t <= 100) row.values["released_energy_at_100"] = energy;
    row.values["released_energy_at_5000"] = energy;
  });
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The sphere and the finite element space on it. Level 1 has 5,900 nodes, whatever the degree.
  const Surface surface = sphere(PfhubSphere::radius);
  const auto generate = [&] {
    return generate_mesh(surface, choice.degree() * edge_length(9.66, choice.level()));
  };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow and its initial state.
  const bool adaptive = is_adaptive(choice);
  const double tolerance = choice.number("tolerance");
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  Flow flow(space, PfhubSphere(), at_rest, PfhubSphere::epsilon,
            adaptive ? linearised_again_from : tolerance);
  const State start = pfhub_state(space, mesh.nodes, pfhub_initial_values(mesh.nodes));

  // 3. The time steps.
  const std::vector<double> shown = {14.15765, 30.26275, 297.45, 1000, 5006};
  RunRecorder recorder(space, snapshot_plan(folder, shown, "cahn_hilliard", row));
  PfhubObserver observer(space, mesh.nodes, recorder, end_time(choice));
  if (adaptive)
    run_recorded(flow, adaptive_steps(choice.bdf(), end_time(choice), tolerance), start, folder, recorder,
                 row, observer);
  else
    run_recorded(flow, GivenTimes{1, moose_times()}, start, folder, recorder, row, observer);

  // 4. The numbers that claims are about.
  observer.describe(row);
  if (adaptive && choice.degree() == 1 && end_time(choice) == steady_time && row.status == "ok")
    release(mesh, recorder.newest().fields[0].values, row);
}

/// A linear system takes about 7 microseconds a node.
double cost(const Choice& choice) {
  const double nodes = 2950 * std::pow(2.0, choice.level());
  const double systems = is_adaptive(choice) ? 50 * std::pow(end_time(choice), 0.27) *
                                                   std::sqrt(largest_tolerance / choice.number("tolerance"))
                                             : 100;
  return nodes * systems * 7e-6;
}

bool has_adaptive_order(const Choice& choice) {
  if (choice.bdf() > 2)
    throw InputError(format("--bdf: found %d, expected 1 or 2 for adaptive steps", choice.bdf()));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("cahn_hilliard_pfhub", "pfhub", run, otherwise, preset);
  experiment.help =
      "Spinodal decomposition on a sphere (PFHub benchmark 1d): energies over time until the state is "
      "steady, and snapshots of\n"
      "the concentration. Level 1 has 5,900 nodes, whatever the degree, each level twice as many as the one "
      "before. No units.\n\n"
      "Example: cahn_hilliard_pfhub --degree 2 --levels 0-2 --end_time 300 --output table.json";
  experiment.grid.axes = {
      {"stepping",
       {"adaptive", "moose"},
       "adaptive: BDF2 with steps that follow the solution | moose: backward Euler with the steps of the "
       "published run, to t = 30.263"},
      {"tolerance", {}, "of adaptive steps; moose: of c in Newton's method"},
      {"end_time", {}, "of adaptive steps"}};
  experiment.grid.labels = {"stepping", "degree", "bdf", "tolerance"};
  experiment.grid.implied = implied;
  experiment.grid.refused = {{"mesh", "the meshes are those of the sphere; expected --levels"},
                             {"start", "the steps start with backward Euler by themselves; expected --bdf"},
                             {"step", "the steps follow the solution; expected --tolerance"}};
  experiment.grid.admits = has_adaptive_order;
  experiment.steps = [](const Choice& choice) {  // how many there are is not known beforehand
    return HalvedSteps{0, is_adaptive(choice) ? first_step : moose_times()[1]};
  };
  experiment.cost = cost;
  experiment.parameters = {{"radius", PfhubSphere::radius},
                           {"kappa", PfhubSphere::kappa},
                           {"mobility", PfhubSphere::mobility},
                           {"tau", "the first step"}};
  experiment.meshes = "generated; each level has twice as many nodes as the one before";
  return run_experiment(experiment, argc, argv);
}
