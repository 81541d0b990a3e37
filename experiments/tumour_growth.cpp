// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth of a tumour: a surface that is moved by what reacts and diffuses on it, without a formula for either
//
// Sample runs:  build/bin/tumour_growth --preset check --output tumour.json
//               build/bin/tumour_growth --levels 0 --steps 1 --gamma 100
//
// Writes:       results/paper/tumour_growth.{json,csv,tex}, from which plots/tumour_growth.py draws
//               figures/gallery/tumour_growth, and the surfaces as
//               results/paper/cells/tumour_growth/CELL/surfaces.pvd
//
// Schnakenberg's kinetics of an activator u_1 and a substrate u_2 on the unit sphere, which grows where there
// is activator (solver/flows/tumour_growth.hpp): nick18 (2.7)-(2.9) for two species, discretised by
// (2.19)-(2.21) with quadratic elements and BDF2. It starts from the steady state without space, disturbed by
// at most 1%, by the same function of space on every mesh.
//
// Expected: the steady state is unstable (Turing), a pattern appears, and the sphere loses its shape. No
// orders.
#include "solver/flows/tumour_growth.hpp"

#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/error.hpp"
#include "solver/mesh/mesh.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{5, 0.01};
const int disturbance_seed = 1;

struct Setting {
  int degree, bdf;
  std::vector<int> levels, steps;
  Start start;
  double gamma;
};

Setting resolve(const Options& options, double gamma) {
  if (!options.meshes.empty())
    throw InputError("--mesh: the tumour starts from a sphere; expected --levels (evolve takes any surface)");
  const bool paper = options.preset == "paper";
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.bdf = options.bdf.value_or(2);
  setting.levels = options.levels.value_or(paper ? range(0, 1) : range(0, 0));
  setting.steps = options.steps.value_or(paper ? std::vector<int>{1} : std::vector<int>{0});
  setting.start = options.start.value_or(parse_start("substeps:16"));
  if (setting.start.kind == Start::exact)
    throw InputError("--start exact: there is no exact solution; expected cascade or substeps:K");
  setting.gamma = gamma;
  return setting;
}

Row run_cell(const Setting& setting, Row row, const std::string& folder) {
  // 1. The unit sphere and the finite element space on it: 2,562 nodes at level 0, 10,242 at level 1
  // (quadratic elements).
  const auto generate = [&] { return icosphere(1, 3 + row.level); };
  const Mesh mesh = initial_mesh({}, row.level, generate, sphere(1), setting.degree);
  const SurfaceSpace space(mesh);
  describe_mesh(mesh, row);

  // 2. The flow and its disturbed steady state.
  TumourGrowth::Kinetics kinetics;
  kinetics.gamma = setting.gamma;
  const CoupledDiffusionParameters parameters = tumour_growth_parameters();
  CoupledDiffusion<TumourGrowth> flow(space, TumourGrowth(kinetics), parameters, {});
  const CoupledDiffusionState initial =
      tumour_growth_state(space, mesh.nodes, kinetics, 0.01, disturbance_seed);

  // 3. The time steps.
  const UniformSteps grid{setting.bdf, row.tau, row.steps, setting.start};
  RunRecorder recorder(space, snapshot_plan(folder, {2, 3, 4}, "coupled_diffusion", row));
  integrate(flow, grid, initial, [&](int n, const CoupledDiffusionState& state) {
    recorder.record(n, state.t, state.x, nodal_fields(state));
    Series& series = recorder.series();
    series["min_u1"].push_back(state.u.col(0).minCoeff());
    series["max_u1"].push_back(state.u.col(0).maxCoeff());
    series["mass_u1"].push_back(state.Mu.col(0).sum());
    series["mass_u2"].push_back(state.Mu.col(1).sum());
  });
  recorder.finish();

  // 4. The row of the table.
  describe_run(recorder, row);
  row.values["contrast"] = row.series["max_u1"].back() - row.series["min_u1"].back();
  row.values["area_ratio"] = row.series["area"].back() / row.series["area"].front();
  row.values["last_worst_angle"] = row.series["worst_angle"].back();
  return row;
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (int level : setting.levels) {
    for (int k : setting.steps) {
      const double nodes = 2562 * std::pow(4, level);
      list.push_back(
          {format("h%d_tau%d", level, k), nodes * time_steps.count(k) * 4e-6,
           [=](const Row& row, const std::string& folder) { return run_cell(setting, row, folder); },
           planned_row(level, time_steps, k)});
    }
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", time_steps.end_time},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"gamma", setting.gamma},
          {"seed", disturbance_seed},
          {"start", to_string(setting.start)}};
}

}  // namespace

int main(int argc, char** argv) {
  double gamma = TumourGrowth::Kinetics().gamma;
  Experiment experiment;
  experiment.stem = "tumour_growth";
  experiment.paper = "esfem";
  experiment.help =
      "Growth of a tumour from the unit sphere to t = 5: time series and snapshots of a surface that grows "
      "where there is\n"
      "activator. Step sizes 0.01 2^-k; level 0: 2,562 nodes, level 1: 10,242. No units.\n\n"
      "Example: tumour_growth --levels 0 --steps 1 --output tumour.json";
  experiment.add_options = [&](CommandLine& line) {
    line.positive("--gamma", gamma, "size of the tumour: factor of the kinetics");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, gamma)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, gamma), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
