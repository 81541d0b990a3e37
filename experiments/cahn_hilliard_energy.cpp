// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Ginzburg-Landau energy of the Cahn-Hilliard equation on an ellipsoid that swells and shrinks (bk22
// §9.2, Figures 6 and 7)
//
// Sample runs:  build/bin/cahn_hilliard_energy --preset check --output energy.json
//               build/bin/cahn_hilliard_energy --levels 4,5 --end_time 0.2
//               build/bin/cahn_hilliard_energy --bdf 1 --levels 4 --steps 1 --end_time 0.2
//
// Writes:       results/paper/cahn_hilliard_energy.{json,csv,tex}, from which
//               plots/cahn_hilliard_energy.py draws figures/bk22/fig6 and fig7
//
// d•u + u div v = Lap w, w = -epsilon Lap u + (u³ - u)/epsilon with epsilon = 0.1 on {x1²/a(t) + x2² + x3² =
// 1}, a(t) = 1 + 0.25 sin(10 pi t), from u = 0.1 cos(2 pi x1) cos(2 pi x2) cos(2 pi x3): bk22 (8.3) with
// linear elements, without theta, from the interpolated u, with BDF2 and tau = 1e-4. The setting is that of
// Elliott and Ranner (2015), §6.2, who use the linearly implicit Euler method, so there are runs with BDF1,
// too.
//
// Expected: the energy does not fall monotonically, because the surface grows and shrinks: it rises until t =
// 0.009 and again from t = 0.153 on. It tends to a function of time with the period of the surface, 0.2, from
// 2,500 nodes on; with edges longer than epsilon to another one. The integral of u is constant to round-off.
#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/harness/grid.hpp"
#include "solver/analysis/energy_series.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"

namespace {

using namespace esfem;

const double epsilon = 0.1, largest_tau = 1e-4;
const EvolvingEllipsoid moving_ellipsoid{0.25, 0.2, 1};
const double paper_end = 1, figure_6_end = 0.2, settled = 0.4;
const int recorded_times = 2000;

/// Of the meshes of level 0, 1, ..: with linear elements they have 54, 120, 270, 591, 1179, 2501, 4998 and
/// 10,145 nodes. The paper says what the first and the last one have, 54 and 10,146.
const std::vector<double> edge_lengths = {0.64459, 0.47455, 0.32288, 0.21643,
                                          0.1519,  0.10475, 0.07412, 0.05203};
const int level_count = static_cast<int>(edge_lengths.size());

Block otherwise(bool) {
  return {{"end_time", paper_end},
          {"degree", 1},
          {"bdf", 2},
          {"start", "cascade"},
          {"level", range(0, level_count - 1)},
          {"step", 0}};
}

std::vector<Block> preset(bool paper) {
  if (paper) return {{{"bdf", 2}}, {{"bdf", 1}, {"level", range(3, 6)}, {"end_time", figure_6_end}}};
  return {{{"level", 1}},
          {{"level", 4}, {"end_time", figure_6_end}},
          {{"level", 5}, {"end_time", 0.05}},
          {{"bdf", 1}, {"level", 4}, {"end_time", 0.05}}};
}

HalvedSteps steps(const Choice& choice) {
  return {choice.number("end_time"), largest_tau};
}

Field initial_values(const Field& x) {
  Field u(x.rows(), 1);
  u = 0.1 * (2 * pi * x.array()).cos().rowwise().prod().matrix();
  return u;
}

/// u from interpolation and w from the second equation, (3.12).
CahnHilliardState initial_state(const SurfaceSpace& space, const Field& x) {
  return cahn_hilliard_start(space, DoubleWell(), epsilon, 0, x, initial_values(x));
}

/// The derivative of an energy at the start in the direction of w, by a central difference, over the integral
/// of w². It is 1 for the energy of which w is the variation: that with epsilon, not (2.3) as it is printed.
double variation(const SurfaceSpace& space, const CahnHilliardState& start, double epsilon_of_energy) {
  const double step = 1e-4 / start.w.cwiseAbs().maxCoeff();
  const auto energy = [&](double shift) {
    return ginzburg_landau_energy(space, start.x, start.u + shift * start.w, epsilon_of_energy);
  };
  const double norm_squared =
      start.w.cwiseProduct(cahn_hilliard_state(space, 0, start.x, start.w, {}).Mu).sum();
  return (energy(step) - energy(-step)) / (2 * step * norm_squared);
}

/// The numbers that claims are about, from the series of all steps. The energy rises with the surface at
/// first, to a maximum that is sought in [0, 0.1], and has its minimum in the first period after it.
void describe_energy(const Series& series, Row& row) {
  const std::vector<double>&t = series.at("t"), &energy = series.at("energy"), &mass = series.at("mass");
  const double end = t.back(), slack = row.tau / 2;
  for (const double time : {0.0, 0.05, 0.1, 0.2, 0.5, 1.0})
    if (time <= end + slack) row.values[format("energy_at_%g", time)] = energy[nearest(series, time)];

  double drift = 0;
  for (const double value : mass) drift = std::max(drift, std::abs(value - mass.front()));
  row.values["mass"] = mass.front();
  row.values["mass_drift"] = drift;
  row.values["min_u"] = *std::min_element(series.at("min_u").begin(), series.at("min_u").end());
  row.values["max_u"] = *std::max_element(series.at("max_u").begin(), series.at("max_u").end());

  const std::size_t top = largest_in(series, "energy", 0, std::min(0.1, end));
  row.values["first_maximum_time"] = t[top];
  row.values["first_maximum"] = energy[top];
  row.values["first_rise"] = energy[top] - energy.front();
  if (end < figure_6_end - slack) return;
  const std::size_t bottom = smallest_in(series, "energy", t[top], figure_6_end + slack);
  row.values["first_minimum_time"] = t[bottom];
  row.values["first_fall"] = energy[top] - energy[bottom];
  row.values["second_rise"] = energy[nearest(series, figure_6_end)] - energy[bottom];
  if (end < paper_end - slack) return;
  row.values["period"] = period(series, "energy", settled, 0.1, 0.3);
  row.values["aperiodicity"] = aperiodicity(series, "energy", moving_ellipsoid.period);
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The unit sphere and the finite element space on it.
  const auto generate = [&] {
    require_levels({choice.level()}, level_count, "levels");
    return generate_mesh(sphere(1), edge_lengths[choice.level()]);
  };
  const Mesh mesh = initial_mesh(choice, generate, sphere(1));
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow on nodes that follow the normal velocity of the surface.
  MovingNodes nodes(moving_ellipsoid.velocity(), mesh.nodes, row.tau / choice.start().substeps_per_step);
  const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
  CahnHilliard flow(space, DoubleWell(), motion, epsilon);

  // 3. The time steps.
  Series series;
  std::optional<Checkpoint> checkpoint = checkpoint_in(folder, row.cell);
  if (checkpoint) attach(*checkpoint, series);
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  const auto record = [&](int, const CahnHilliardState& state) {
    record_energy(space, state, epsilon, series);
  };
  const CahnHilliardState start = initial_state(space, mesh.nodes);
  integrate(flow, steps, start, checkpoint ? &*checkpoint : nullptr, record);
  if (checkpoint) row.seconds = checkpoint->seconds_before();

  // 4. The row of the table.
  row.series = thinned(series, recorded_times);
  describe_energy(series, row);
  row.values["variation"] = variation(space, start, epsilon);
  row.values["variation_as_printed"] = variation(space, start, 1);
}

/// The meshes of level l have about 54 2.11^l nodes.
double cost(const Choice& choice) {
  const double nodes = 54 * std::pow(2.11, choice.level());
  return steps(choice).count(choice.step()) * (4e-4 + 2.8e-6 * nodes);
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("cahn_hilliard_energy", "bk22", run, otherwise, preset);
  experiment.help =
      "Ginzburg-Landau energy of the Cahn-Hilliard equation, epsilon = 0.1, on the ellipsoid with a(t) = 1 + "
      "0.25 sin(10 pi t)\n"
      "(bk22 Figures 6 and 7): time series of energy, mass, min and max of u, and when the energy rises and "
      "falls. Step sizes\n"
      "1e-4 2^-k; levels 0 to 7: 54 to 10,145 nodes of linear elements. No units.\n\n"
      "Example: cahn_hilliard_energy --levels 4 --bdf 3 --end_time 0.2 --output energy.json";
  experiment.grid.axes = {{"end_time", {}, "t at the end of each run"}};
  experiment.grid.labels = {"bdf"};
  experiment.steps = steps;
  experiment.cost = cost;
  experiment.parameters = {{"epsilon", epsilon},
                           {"amplitude", moving_ellipsoid.amplitude},
                           {"period", moving_ellipsoid.period},
                           {"largest_tau", largest_tau}};
  experiment.meshes = "generated, 54 to 10,145 nodes of linear elements";
  return run_experiment(experiment, argc, argv);
}
