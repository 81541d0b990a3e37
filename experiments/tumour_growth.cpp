// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth of a tumour: surface evolution coupled to reaction and diffusion on the surface, without an exact
// solution
//
// Sample runs:  build/bin/tumour_growth --preset check --output tumour.json
//               build/bin/tumour_growth --levels 0 --steps 1 --gamma 100
//
// Writes:       results/paper/tumour_growth.{json,csv,tex}, from which plots/tumour_growth.py draws
//               figures/gallery/tumour_growth, and the surfaces as
//               results/paper/cells/tumour_growth/CELL/surfaces.pvd
//
// Schnakenberg's kinetics of an activator u_1 and a substrate u_2 on the unit sphere, which grows where there
// is activator (solver/problems/tumour_growth.hpp): nick18 (2.7)-(2.9) for two species, discretised by
// (2.19)-(2.21) with quadratic elements and BDF2. It starts from the steady state without space, disturbed by
// at most 1%, by the same function of space on every mesh.
//
// Expected: the steady state is unstable (Turing), a pattern appears, and the surface does not remain a
// sphere. No orders.
#include "solver/problems/tumour_growth.hpp"

#include <cmath>

#include "experiments/harness/grid.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{5, 0.01};
const int disturbance_seed = 1;

Block otherwise(bool paper) {
  return {{"gamma", TumourGrowth::Kinetics().gamma},
          {"degree", 2},
          {"bdf", 2},
          {"start", "substeps:16"},
          {"level", paper ? range(0, 1) : range(0, 0)},
          {"step", paper ? 1 : 0}};
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The unit sphere and the finite element space on it: 2,562 nodes at level 0, 10,242 at level 1
  // (quadratic elements).
  const auto generate = [&] { return icosphere(1, 3 + choice.level()); };
  const Mesh mesh = initial_mesh(choice, generate, sphere(1));
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow and its disturbed steady state.
  TumourGrowth::Kinetics kinetics;
  kinetics.gamma = choice.number("gamma");
  CoupledDiffusion<TumourGrowth> flow(space, TumourGrowth(kinetics), tumour_growth_parameters(), {});
  const CoupledDiffusionState initial =
      tumour_growth_state(space, mesh.nodes, kinetics, 0.01, disturbance_seed);

  // 3. The time steps.
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  RunRecorder recorder(space, snapshot_plan(folder, {2, 3, 4}, "coupled_diffusion", row));
  run_recorded(flow, steps, initial, folder, recorder, row, [&](int n, const CoupledDiffusionState& state) {
    recorder.record(n, state);
    Series& series = recorder.series();
    series["min_u1"].push_back(state.u.col(0).minCoeff());
    series["max_u1"].push_back(state.u.col(0).maxCoeff());
    series["mass_u1"].push_back(state.Mu.col(0).sum());
    series["mass_u2"].push_back(state.Mu.col(1).sum());
  });

  // 4. The numbers that claims are about.
  row.values["contrast"] = row.series["max_u1"].back() - row.series["min_u1"].back();
  row.values["area_ratio"] = row.series["area"].back() / row.series["area"].front();
  row.values["last_worst_angle"] = row.series["worst_angle"].back();
}

double cost(const Choice& choice) {
  const double nodes = 2562 * std::pow(4, choice.level());
  return nodes * time_steps.count(choice.step()) * 4e-6;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("tumour_growth", "esfem", run, otherwise);
  experiment.help =
      "Growth of a tumour from the unit sphere to t = 5: time series and snapshots of a surface that grows "
      "where there is\nactivator. Step sizes 0.01 2^-k; level 0: 2,562 nodes, level 1: 10,242. No units.\n\n"
      "Example: tumour_growth --levels 0 --steps 1 --output tumour.json";
  experiment.grid.axes = {{"gamma", {}, "size of the tumour: factor of the kinetics"}};
  experiment.grid.refused = {
      {"mesh", "the tumour starts from a sphere; expected --levels (evolve takes any surface)"}};
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = cost;
  experiment.parameters = {{"end_time", time_steps.end_time}, {"seed", disturbance_seed}};
  return run_experiment(experiment, argc, argv);
}
