// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow by three schemes: kll21 (3.4)-(3.5), Dziuk's (2.13) of 2008, and that of
// Barrett, Garcke and Nürnberg of 2008, (2.14)
//
// Sample runs:  build/bin/willmore_competitors --preset check --output competitors.json
//               build/bin/willmore_competitors --surface sphere --flow willmore,bgn_willmore --steps 0-4
//
// Writes:       results/paper/willmore_competitors.{json,csv,tex}, from which plots/willmore_competitors.py
//               draws figures/gallery/willmore_competitors
//
// The unit sphere and the Clifford torus with radii 1 and 2^(-1/2) are stationary, so that errors are
// known; an ellipsoid (1, 1, 0.6) becomes rounder. All schemes take backward Euler steps of the same size on
// the same meshes, with elements of degree 1 and 2 (the theory of kll21 begins with 2). nu and H of the older
// schemes, which have none or only H, are those of the discrete surface. The nodes of Dziuk's scheme and of
// BGN's move along the surface, which counts as an error of x; `distance` is that of the nodes from the exact
// surface. Energies are recorded 50 times a run. Linear elements on the sphere are also run on finer meshes,
// to see whether the schemes converge.
//
// Expected: the older schemes move to a discrete surface of smaller discrete energy, kll21 remains
// closer to the initial one by a factor of 100 and more. Dziuk's scheme with elements of degree 2 needs tau
// <= h²/1000 or less, the others do not. With linear elements BGN's nodes keep sliding by the same distance
// in each step, however small the step is.
#include <cmath>
#include <optional>

#include "experiments/harness/distance.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/timed.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/flows/bgn_willmore_flow.hpp"
#include "solver/flows/dziuk_willmore_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace {

using namespace esfem;

const double minor_radius = std::sqrt(0.5), largest_tau = 1e-3;
const int recorded_steps = 50;

/// A surface to start from, its meshes, and the energy that the flow tends to. Each level of the mesh has
/// twice as many triangles as the one before.
struct Case {
  Surface surface;
  double largest_h, end_time, limit;
  std::optional<ExactEvolution> exact;  ///< of the stationary surfaces
};

const std::map<std::string, Case> cases = {
    {"sphere", {sphere(1), 0.5, 0.02, 8 * pi, stationary_sphere(1)}},
    {"clifford_torus", {torus(1, minor_radius), 0.28, 0.005, 4 * pi* pi, stationary_torus(1, minor_radius)}},
    {"ellipsoid", {ellipsoid(1, 1, 0.6), 0.35, 0.02, 8 * pi, {}}}};

const Case& case_of(const Choice& choice) {
  return cases.at(choice["surface"]);
}

HalvedSteps time_steps(const Choice& choice) {
  return {case_of(choice).end_time, largest_tau};
}

Block otherwise(bool) {
  return {{"degree", {1, 2}}, {"bdf", 1}, {"level", 0}, {"step", 3}};
}

std::vector<Block> preset(bool paper) {
  const char *torus = "clifford_torus", *bgn = "bgn_willmore";
  if (!paper)
    return {{{"surface", "sphere"}},
            {{"surface", "ellipsoid"}, {"degree", 1}},
            {{"surface", "ellipsoid"}, {"degree", 2}, {"step", 0}},
            {{"surface", torus}, {"flow", bgn}, {"degree", 1}, {"step", range(0, 2)}},
            {{"surface", torus}, {"flow", "willmore"}, {"degree", 2}}};
  return {{{"surface", "sphere"}},
          {{"surface", "sphere"}, {"degree", 1}, {"level", range(0, 2)}, {"step", 2}},
          {{"surface", "ellipsoid"}, {"degree", 1}},
          {{"surface", "ellipsoid"}, {"degree", 2}, {"step", {0, 5}}},
          {{"surface", torus}, {"flow", bgn}, {"degree", 1}, {"step", range(0, 4)}},
          {{"surface", torus}, {"step", 5}},
          {{"surface", torus}, {"degree", 2}, {"step", 0}}};
}

/// Runs the flow by backward Euler steps, about `recorded_steps` of which are recorded.
template <class Flow>
void run_flow(Flow&& flow, const typename Flow::State& initial, const Surface& surface, RunRecorder& recorder,
              std::optional<ErrorRecorder>& errors, Row& row) {
  Timed<Flow> timed{flow};
  const int every = std::max(1, row.steps / recorded_steps);
  int taken = 0;
  const auto record = [&](int n, const typename Flow::State& state) {
    taken = n;
    if (n % every != 0 && n != row.steps) return;
    recorder.record(n, state);
    if (!errors) return;
    errors->record(state);
    recorder.series()["distance"].push_back(distance(surface, state.x));
  };
  row.status = run_to_end([&] { integrate(timed, {1, row.tau, row.steps}, initial, record); }, recorder);
  if (taken > 0) row.values["seconds_per_step"] = timed.seconds / taken;
}

/// The numbers that claims are about.
void describe_end(double limit, Row& row) {
  const Series& series = row.series;
  row.values["last_t"] = series.at("t").back();
  row.values["worst_angle"] = series.at("worst_angle").back();
  for (const std::string energy : {"kappa_energy", "willmore_energy"}) {
    row.values[energy] = series.at(energy).back();
    row.values[energy + "_excess"] = series.at(energy).back() - limit;
    row.values[energy + "_rise"] = largest_rise(series.at(energy));
  }
  for (const char* name : {"x_nodal_L2", "x_nodal_H1", "distance"})
    if (series.count(name)) row.values[name] = series.at(name).back();
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it; that of BGN for P1 is lumped.
  const Case& initial = case_of(choice);
  const Surface& surface = initial.surface;
  const auto generate = [&] {
    return generate_mesh(surface, edge_length(initial.largest_h, choice.level()));
  };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const bool lumped = choice["flow"] == "bgn_willmore" && choice.degree() == 1;
  const SurfaceSpace space(mesh, lumped ? vertex_quadrature() : choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow, with what is recorded of it.
  RunRecorder recorder(space, {}, RunRecorder::of_flow_and_surface);
  std::optional<ErrorRecorder> errors;
  if (initial.exact) errors.emplace(space, *initial.exact, mesh.nodes);
  const auto go = [&](auto&& flow, const auto& state) {
    run_flow(std::move(flow), state, surface, recorder, errors, row);
  };
  if (choice["flow"] == "willmore") {
    const WillmoreStart start = willmore_start_on(space, surface, mesh.nodes, willmore_law(), false);
    go(WillmoreFlow(space, {}, start.theta), start.state);
  } else if (choice["flow"] == "dziuk_willmore") {
    go(DziukWillmoreFlow(space), dziuk_willmore_state_on(space, mesh.nodes));
  } else {
    go(BgnWillmoreFlow(space), bgn_willmore_state_on(space, mesh.nodes));
  }

  // 3. The row of the table.
  describe_run(recorder, row);
  if (errors) {
    row.errors = errors->maxima();
    for (const char* name : {"x_nodal_L2", "x_nodal_H1"}) row.series[name] = errors->series().at(name);
  }
  describe_end(initial.limit, row);
}

/// Dziuk's scheme has a system for six unknowns a node, BGN's for four.
double cost(const Choice& choice) {
  const double h = edge_length(case_of(choice).largest_h, choice.level());
  const double nodes = 25 * choice.degree() * choice.degree() / (h * h);
  return nodes * time_steps(choice).count(choice.step()) *
         (choice["flow"] == "willmore" ? 5e-6 : 40e-6 * choice.degree());
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_competitors", "kll21", run, otherwise, preset);
  experiment.help =
      "Willmore flow of the unit sphere, the Clifford torus (radii 1, 2^(-1/2)) and an ellipsoid\n"
      "(1, 1, 0.6) by three schemes: errors, energies, quality of the mesh and seconds per step. Backward\n"
      "Euler steps 0.001 2^-k, on [0, 0.02], the torus on [0, 0.005]; level j of the meshes has 2^j times\n"
      "as many triangles as level 0. No units.\n\n"
      "Example: willmore_competitors --surface sphere --flow willmore,bgn_willmore --steps 0-3";
  experiment.grid.axes = {
      {"surface", names_of(cases), "surfaces to start from"},
      {"flow",
       {"willmore", "dziuk_willmore", "bgn_willmore"},
       "willmore: kll21 (3.4)-(3.5) | dziuk_willmore: Dziuk 2008, (2.13) | bgn_willmore: Barrett, Garcke, "
       "Nürnberg 2008, (2.14)"}};
  experiment.grid.labels = {"surface", "flow", "degree"};
  const std::string why = "all schemes run with backward Euler steps on generated meshes";
  experiment.grid.refused = {{"mesh", why}, {"bdf", why}, {"start", why}};
  experiment.comparisons = {{{{"flow", "willmore"}},
                             "_over_kll21",
                             {"distance", "x_nodal_H1", "kappa_energy_excess", "worst_angle"}}};
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.known_end = [](const Choice& choice) {
    const bool ends = choice["flow"] == "dziuk_willmore" && choice.degree() == 2 && choice.step() == 0;
    return ends ? "Dziuk's scheme needs tau of about h^2/2600" : "";
  };
  experiment.parameters = {{"largest_tau", largest_tau},
                           {"end_time", {{"sphere", 0.02}, {"ellipsoid", 0.02}, {"clifford_torus", 0.005}}}};
  experiment.meshes =
      "generated, edge lengths 0.5 (sphere), 0.35 (ellipsoid), 0.28 (torus) times 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
