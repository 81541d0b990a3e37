// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow towards stationary surfaces (kll21 §7.2, Figure 7.5), and why it may miss them
//
// Sample runs:  build/bin/willmore_relaxation --preset check --output relaxation.json
//               build/bin/willmore_relaxation --surface small_ellipsoid --setting relaxed --levels 0-2
//
// Writes:       results/paper/willmore_relaxation.{json,csv,tex}, and surfaces as surfaces.pvd of each cell;
//               plots/willmore_relaxation.py draws figures/{kll21/fig7_5,gallery/willmore_relaxation}
//
// An ellipsoid, a red blood cell and a periodically perturbed torus evolve under Willmore flow, V = Delta H +
// Q, on [0, 4]: kll21 (3.4)-(3.5) with quadratic elements, BDF2 and projections. The energy 1/2 int H² must
// fall to 8 pi (a sphere) and 4 pi² (the Clifford torus). The paper gives neither formulas nor sizes of its
// surfaces, so there are two sets: three large ones, and four of size one, where the flow is R⁴ times as
// fast. Settings:
//   paper     tau = 0.2 2^-8, F extrapolated
//   implicit  the same with F implicit, as far as t = 0.1
//   adaptive  adaptive BDF2, tau from 1e-6 (1e-9) to 0.002, 0.005 or 0.008
//   relaxed   the same with the relaxation lambda = 100 of H_h and nu_h towards the geometry of the surface
//
// Expected: on a sphere H_h - 2/R is conserved, so the error of H_h after the first 1e-3 time units
// remains: W(H_h) levels off above 8 pi and the sphere shrinks for ever. Adaptive steps make that error
// small; the relaxation removes it, and with it a mode of nu_h that grows on the torus whatever tau is.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

const double end_time = 4, short_time = 0.1, tolerance = 1e-3, relaxation = 100;

/// A surface to start from, its mesh and steps, and where it tends to.
struct Case {
  Surface surface;
  double largest_h;  ///< of level 0, a mesh with as many nodes as the published one
  int nodes;         ///< about
  enum Limit { sphere, torus } limit;
  double largest_step;       ///< of adaptive steps: beyond it the relaxation is not stable
  double first_step = 1e-6;  ///< of adaptive steps; the velocity of small_torus_4 is 2e4 at first
};

const std::map<std::string, Case> cases = {
    {"ellipsoid", {ellipsoid(2, 1, 1), 0.1949, 5000, Case::sphere, 0.008}},
    {"red_blood_cell", {red_blood_cell(), 0.1794, 9000, Case::sphere, 0.008}},
    {"perturbed_torus", {perturbed_torus(2, 1.2, 0.1, 3), 0.26265, 12000, Case::torus, 0.008}},
    {"small_ellipsoid", {ellipsoid(1, 1, 0.6), 0.1292, 4900, Case::sphere, 0.005}},
    {"evans_fung_cell", {evans_fung_cell(), 0.0924, 9000, Case::sphere, 0.005}},
    {"small_torus", {perturbed_torus(1, 0.6, 0.05, 3), 0.1313, 12000, Case::torus, 0.002}},
    {"small_torus_4", {perturbed_torus(1, 0.6, 0.1, 4), 0.2307, 12000, Case::torus, 0.002, 1e-9}}};

const std::map<std::string, bool> adaptive = {
    {"paper", false}, {"implicit", false}, {"adaptive", true}, {"relaxed", true}};

/// Each level has half as many triangles as the one before. A uniform mesh that resolves the narrowest places
/// of small_torus_4 has 39,000 nodes.
Mesh generated(const Choice& choice) {
  const Surface& surface = cases.at(choice["surface"]).surface;
  const double scale = std::pow(2.0, 0.5 * choice.level()),
               largest_h = scale * cases.at(choice["surface"]).largest_h;
  if (choice["surface"] == "small_torus_4")
    return generate_mesh(surface, radial_edge_length(0.3, 0.0577 * scale, 1.7, largest_h));
  return generate_mesh(surface, largest_h);
}

/// The step size of a run, or the largest one, until its end.
HalvedSteps time_steps(const Choice& choice) {
  return {choice["setting"] == "implicit" ? short_time : choice.number("end_time"),
          adaptive.at(choice["setting"]) ? cases.at(choice["surface"]).largest_step : 0.2 / 256};
}

Block otherwise(bool) {
  return {{"end_time", end_time}, {"degree", 2}, {"bdf", 2}, {"start", "cascade"}, {"level", 0}};
}

std::vector<Block> preset(bool paper) {
  const Block implicit = {{"surface", "small_ellipsoid"}, {"setting", "implicit"}};
  const Block relaxed = {{"surface", "small_ellipsoid"}, {"setting", "relaxed"}, {"level", range(0, 2)}};
  if (paper) return {implicit, relaxed, {{"setting", {"paper", "adaptive", "relaxed"}}}};
  return {implicit,
          relaxed,
          {{"surface", "small_ellipsoid"}, {"setting", "adaptive"}},
          {{"surface", "small_ellipsoid"}, {"setting", "paper"}, {"end_time", short_time}}};
}

/// Records the first steps and then every eighth, and the motion of the surface at the end.
struct Observer {
  const Choice& choice;
  RunRecorder& recorder;
  Field settled = {};  ///< the surface at t = 3.5

  void operator()(int n, const WillmoreFlow::State& state) {
    const int first_steps = adaptive.at(choice["setting"]) ? 200 : 32;
    if (n > first_steps && n % 8 != 0 && state.t < time_steps(choice).end_time * (1 - 1e-9)) return;
    recorder.record(n, state);
    Series& series = recorder.series();
    if (cases.at(choice["surface"]).limit == Case::sphere) {
      series["radius"].push_back(fitted_sphere_radius(state.x));
    } else {
      const TorusRadii radii = fitted_torus_radii(state.x);
      series["major"].push_back(radii.major);
      series["minor"].push_back(radii.minor);
    }
    if (settled.size() == 0 && state.t >= 3.5) settled = state.x;
    series["moved"].push_back(settled.size() == 0 ? 0 : (state.x - settled).rowwise().norm().maxCoeff());
  }

  nlohmann::json progress() const { return packed(settled); }
  void resume(const nlohmann::json& saved) { settled = unpacked(saved); }
};

/// The numbers that claims are about. The largest rise of the energy is that between recorded steps.
void describe_end(Case::Limit limit, Row& row) {
  const Series& series = row.series;
  const double energy = limit == Case::sphere ? 8 * pi : 4 * pi * pi;
  const auto last = [&](const std::string& name) { return series.at(name).back(); };
  row.values["willmore_excess"] = last("willmore_energy") - energy;
  row.values["kappa_excess"] = last("kappa_energy") - energy;
  row.values["excess_at_0.1"] = value_at(series, "willmore_energy", 0.1) - energy;
  row.errors["energy"]["excess"] = std::abs(row.values["willmore_excess"]);
  row.values["largest_rise"] = largest_rise(series.at("willmore_energy"));
  if (last("t") < end_time) return;
  row.values["moved_from_3.5"] = last("moved");
  if (limit == Case::sphere)
    row.values["radius_change_from_3"] = std::abs(last("radius") - value_at(series, "radius", 3));
  else
    row.values["ratio_of_radii_off"] = std::abs(last("major") / last("minor") - std::sqrt(2.0));
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Case& initial = cases.at(choice["surface"]);
  const auto generate = [&] { return generated(choice); };
  const Mesh mesh = initial_mesh(choice, generate, initial.surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow, from the exact normal and mean curvature.
  WillmoreFlow::Variant variant;
  if (choice["setting"] == "implicit") variant.F = WillmoreFlow::Variant::implicit;
  if (choice["setting"] == "relaxed") variant.relaxation = relaxation;
  const WillmoreStart start = willmore_start_on(space, initial.surface, mesh.nodes, variant.law, false);
  WillmoreFlow flow(space, variant, start.theta);

  // 3. The time steps, and the row of the table.
  RunRecorder recorder(space, snapshot_plan(folder, {0.5, 1, 2, 3}, "willmore", row),
                       RunRecorder::of_flow_and_surface);
  Observer observe{choice, recorder};
  const auto go = [&](auto steps) { run_recorded(flow, steps, start.state, folder, recorder, row, observe); };
  if (adaptive.at(choice["setting"]))
    go(AdaptiveSteps{"u", 2, time_steps(choice).end_time, tolerance, initial.first_step, row.tau});
  else
    go(UniformSteps{choice.bdf(), row.tau, row.steps, choice.start()});
  describe_end(initial.limit, row);
}

/// A step takes about 4 microseconds a node when it factorises, as the implicit one and most of the first
/// adaptive steps do, and 1 when it does not. A run that ends early takes less.
double cost(const Choice& choice) {
  const double nodes = cases.at(choice["surface"]).nodes * std::pow(2.0, -choice.level());
  if (adaptive.at(choice["setting"]))
    return nodes * (300 * 4e-6 + end_time / time_steps(choice).largest * 1.2e-6);
  return nodes * time_steps(choice).count(0) * (choice["setting"] == "implicit" ? 9e-6 : 1.2e-6);
}

std::string known_end(const Choice& choice) {
  const std::string &surface = choice["surface"], &setting = choice["setting"];
  const bool is_torus = surface == "small_torus" || surface == "small_torus_4";
  const bool ends =
      setting == "paper" ? is_torus || surface == "evans_fung_cell" : setting == "adaptive" && is_torus;
  return ends ? "without relaxation H_h deviates from the surface, until elements degenerate" : "";
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_relaxation", "kll21", run, otherwise, preset);
  experiment.help =
      "Willmore flow of an ellipsoid, a red blood cell and a perturbed torus to t = 4 (kll21 Figure 7.5):\n"
      "energies, radii and snapshots, with the paper's steps, with adaptive steps, and with relaxation to\n"
      "the geometry. Level 0: the published numbers of nodes, each further level half of them. No units.\n\n"
      "Example: willmore_relaxation --surface small_ellipsoid --setting relaxed --levels 0-2";
  experiment.grid.axes = {{"surface", names_of(cases), "surfaces to start from"},
                          {"setting", names_of(adaptive),
                           "paper: tau = 0.2 2^-8 | implicit: F implicit, to t = 0.1 | adaptive: adaptive "
                           "steps | relaxed: with relaxation"}};
  experiment.grid.labels = {"surface", "setting"};
  const std::string why = "surfaces and steps are those of --surface and --setting (evolve takes any)";
  experiment.grid.refused = {{"mesh", why}, {"step", why}, {"bdf", why}, {"start", why}};
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.known_end = known_end;
  experiment.parameters = {{"end_time", end_time},
                           {"tau", "0.2 2^-8; adaptive: the largest"},
                           {"tolerance", tolerance},
                           {"relaxation", relaxation}};
  experiment.meshes = "generated; each level has half as many nodes as the one before";
  return run_experiment(experiment, argc, argv);
}
