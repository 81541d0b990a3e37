// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surface diffusion of an ellipsoid to a sphere of the same volume (kll21 (1.2))
//
// Sample runs:  build/bin/surface_diffusion --preset check --output diffusion.json
//               build/bin/surface_diffusion --setting paper,unprojected --levels 2 --steps 0-3
//               build/bin/surface_diffusion --setting relaxed --levels 0-2 --output relaxed.json
//
// Writes:       results/paper/surface_diffusion.{json,csv,tex}, from which plots/surface_diffusion.py draws
//               figures/gallery/surface_diffusion, and the surfaces as
//               results/paper/cells/surface_diffusion/CELL/surfaces.pvd
//
// The ellipsoid with half axes 2, 1, 1 evolves by V = Delta H on [0, 0.8]: kll21 (3.4)-(3.5) with Q = 0,
// quadratic elements and BDF2. It is the longer one of the two of willmore_relaxation; (1, 1, 0.6) looks
// round from the start. The volume is constant, the area decreases, and the limit is the
// sphere of radius 2^(1/3). Close to a sphere of radius R the ellipsoidal modes decay by exp(-24 t/R⁴).
// Settings:
//   paper        tau = 0.01 2^-k, projections after each step (§7.1)
//   unprojected  the same without projections
//   adaptive     adaptive BDF2, tau from 1e-6 to 0.008, tolerance 1e-3
//   accurate     the same with tau <= 0.00125, tolerance 2.5e-5: the remaining error is that in space
//   relaxed      as adaptive, with the relaxation lambda = 100 of H_h and nu_h towards the geometry
//
// Expected: the scheme conserves int V = 0, not the volume, because nu_h is not the normal of Gamma_h. The
// volume drifts with tau² and, in space, faster than h². Without projections |nu_h| grows, and the drift
// is 30 times as large. The surface stops when H_h is constant, which happens before it is round; with
// the relaxation it becomes round at the rate of the theory.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const double largest_h = 0.5, end_time = 0.8, limit_radius = std::cbrt(2.0);
const double first_tau = 1e-6, relaxation = 100;

Surface initial_surface() {
  return ellipsoid(2, 1, 1);
}

struct Setting {
  double largest_tau, tolerance;  ///< of adaptive steps; no tolerance: equal steps
  bool project = true;
  double relaxation = 0;
};

const std::map<std::string, Setting> settings = {{"paper", {0.01, 0}},
                                                 {"unprojected", {0.01, 0, false}},
                                                 {"adaptive", {0.008, 1e-3}},
                                                 {"accurate", {0.00125, 2.5e-5}},
                                                 {"relaxed", {0.008, 1e-3, true, relaxation}}};

HalvedSteps time_steps(const Choice& choice) {
  return {end_time, settings.at(choice["setting"]).largest_tau};
}

Block otherwise(bool) {
  return {{"degree", 2}, {"bdf", 2}, {"start", "substeps:16"}, {"level", 0}, {"step", 0}};
}

std::vector<Block> preset(bool paper) {
  if (!paper)
    return {{{"setting", {"paper", "unprojected"}}, {"level", 1}, {"step", range(0, 2)}},
            {{"setting", "accurate"}},
            {{"setting", {"adaptive", "relaxed"}}, {"level", 1}}};
  return {{{"setting", "paper"}, {"level", range(0, 2)}, {"step", range(0, 3)}},
          {{"setting", "unprojected"}, {"level", 2}, {"step", range(0, 3)}},
          {{"setting", {"adaptive", "accurate", "relaxed"}}, {"level", range(0, 2)}}};
}

/// Appends the radius of the fitted sphere and the difference of the largest and the smallest distance of a
/// node from the centre, which stays where it is by symmetry.
void record_roundness(const Field& x, Series& series) {
  const Eigen::VectorXd distance = x.rowwise().norm();
  series["radius"].push_back(fitted_sphere_radius(x));
  series["elongation"].push_back(distance.maxCoeff() - distance.minCoeff());
}

/// The numbers that claims are about.
void describe_end(Row& row) {
  const Series& series = row.series;
  const std::vector<double>&volume = series.at("volume"), &area = series.at("area");
  double drift = 0;
  for (const double V : volume) drift = std::max(drift, std::abs(V / volume[0] - 1));
  row.errors["volume"]["drift"] = drift;
  row.values["volume_drift"] = drift;
  row.values["largest_area_rise"] = largest_rise(area);
  if (series.at("t").back() < end_time * (1 - 1e-9)) return;
  row.values["radius_off"] = std::abs(series.at("radius").back() / limit_radius - 1);
  row.values["elongation"] = series.at("elongation").back();
  row.values["area_off"] = std::abs(area.back() / (4 * pi * limit_radius * limit_radius) - 1);
  row.values["decay_rate"] = decay_rate(series, "elongation", 0.5, 0.8);
  row.values["max_nu"] = series.at("max_nu").back();
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = initial_surface();
  const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, choice.level())); };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow, from the exact normal and mean curvature.
  const Setting& setting = settings.at(choice["setting"]);
  WillmoreFlow::Variant variant;
  variant.law = surface_diffusion_law();
  variant.projection = setting.project ? WillmoreFlow::Variant::after_steps : WillmoreFlow::Variant::none;
  variant.relaxation = setting.relaxation;
  const WillmoreStart start = willmore_start_on(space, surface, mesh.nodes, variant.law, false);
  WillmoreFlow flow(space, variant, start.theta);

  // 3. The time steps.
  RunRecorder recorder(space, snapshot_plan(folder, {0.01, 0.05, 0.1, 0.2}, "surface_diffusion", row));
  const auto observe = [&](int n, const State& state) {
    recorder.record(n, state);
    record_roundness(state.x, recorder.series());
  };
  const auto go = [&](auto steps) { run_recorded(flow, steps, start.state, folder, recorder, row, observe); };
  if (setting.tolerance > 0)
    go(AdaptiveSteps{"u", 2, end_time, setting.tolerance, first_tau, row.tau});
  else
    go(UniformSteps{choice.bdf(), row.tau, row.steps, choice.start()});

  // 4. The row of the table.
  describe_end(row);
}

/// A step with its records takes about 5 microseconds a node.
double cost(const Choice& choice) {
  const double nodes = 740 * std::pow(2.0, choice.level()), steps = time_steps(choice).count(choice.step());
  return 1.5 * nodes * steps * 5e-6;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("surface_diffusion", "kll21", run, otherwise, preset);
  experiment.help =
      "Surface diffusion V = Delta H of the ellipsoid with half axes 2, 1, 1 to t = 0.8 (kll21 (1.2)):\n"
      "area, volume, radius and snapshots, with fixed steps 0.01 2^-k with and without projections, with\n"
      "adaptive steps of at most 0.008 2^-k (accurate: 0.00125 2^-k), and with relaxation towards the\n"
      "geometry. Edge lengths 0.5 2^(-j/2), level j = 0, 1, .. No units.\n\n"
      "Example: surface_diffusion --setting relaxed --levels 0-2 --output table.json";
  experiment.grid.axes = {
      {"setting", names_of(settings),
       "paper: fixed steps | unprojected: fixed steps, no projections | adaptive: adaptive steps | accurate: "
       "small adaptive steps | relaxed: adaptive steps and relaxation"}};
  experiment.grid.labels = {"setting"};
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.parameters = {{"initial_surface", initial_surface().name},
                           {"end_time", end_time},
                           {"largest_tau", 0.01},
                           {"tau", "adaptive: the largest"},
                           {"tolerance", "1e-3; accurate: 2.5e-5"},
                           {"relaxation", relaxation}};
  experiment.meshes = "generated, edge length 0.5 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
