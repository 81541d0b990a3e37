// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tangential motion of minimal deformation rate: how long a mesh stays good
//
// Sample runs:  build/bin/tangential_motion --preset check --output tangential.json
//               build/bin/tangential_motion --surface dumbbell --flow mean_curvature --levels 0 --steps 0
//               build/bin/tangential_motion --surface torus --flow willmore --levels 0
//
// Writes:       results/paper/tangential_motion.{json,csv,tex}, from which plots/tangential_motion.py draws
//               figures/gallery/{tangential_motion,tangential_motion_willmore}
//
// Mean curvature flow of three surfaces on which nodes that move along the normal alone come close to each
// other: the dumbbell of kll19 §13.2 until shortly before its pinch at t = 0.0822, the Evans-Fung red blood
// cell, and the ellipsoid with half axes 4, 1, 1. The schemes are kll19 (5.1), the same with the velocity of
// minimal deformation rate (Hu, Li 2022: of all velocities with normal part -H the one with the least int
// |grad v|²), Dziuk's, and that of Barrett, Garcke and Nürnberg, all with quadratic elements on the same
// meshes. BDF2 with accurate starting values; BGN's scheme has order 1. A run ends at the singularity, or
// where its mesh has degenerated (geometry/regularity.hpp).
//
// Willmore flow, kll21 (3.4)-(3.5), of a torus with radii 1 and 0.6 and three waves, by adaptive BDF2: each
// with and without the velocity of minimal deformation rate and the relaxation lambda = 100 of H_h and nu_h
// towards the geometry of the surface. It tends to the Clifford torus with the energy 4 pi², the least of all
// tori.
//
// Expected: with minimal deformation rate angles and radius ratios stay larger than without, and the surface
// is the same up to the errors of the schemes; no orders are measured here (all_orders). Where nu_h and H_h
// leave the surface, as under Willmore flow without relaxation, this velocity only delays the end.
#include <cmath>
#include <map>

#include "experiments/harness/grid.hpp"
#include "solver/analysis/series.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;

/// Of adaptive steps, and of the relaxation in "willmore_relaxed".
const double tolerance = 1e-3, first_step = 1e-6, relaxation = 100;

/// A surface to start from, its meshes, and its step sizes, of the torus the largest ones. Edges are at most
/// as long as the local radius of curvature; each level of the mesh has twice as many triangles as the one
/// before.
struct Case {
  Surface surface;
  double largest_h;
  HalvedSteps time_steps;
  std::vector<double> times;  ///< at which claims look at the mesh
};

const std::map<std::string, Case> cases = {
    {"dumbbell", {dumbbell(), 0.2, {0.081, 0.001}, {0.03, 0.06, 0.075}}},
    {"red_blood_cell", {red_blood_cell(), 0.4, {0.42, 0.004}, {0.2, 0.32, 0.4}}},
    {"ellipsoid", {ellipsoid(4, 1, 1), 0.6, {0.45, 0.005}, {0.2, 0.3, 0.4}}},
    {"torus", {perturbed_torus(1, 0.6, 0.05, 3), 0.35, {0.6, 0.002}, {0.1, 0.3, 0.5}}}};

const Case& case_of(const Choice& choice) {
  return cases.at(choice["surface"]);
}

bool is_willmore(const Choice& choice) {
  return choice["flow"] == "willmore" || choice["flow"] == "willmore_relaxed";
}

/// Times and step sizes of the torus are those of Willmore flow.
bool belongs_together(const Choice& choice) {
  return is_willmore(choice) == (choice["surface"] == "torus");
}

Block otherwise(bool) {
  return {{"flow", {"mean_curvature", "dziuk", "bgn", "willmore", "willmore_relaxed"}},
          {"tangential", {"none", "minimal_deformation"}},
          {"degree", 2},
          {"bdf", 2},
          {"level", 0},
          {"step", 0}};
}

/// BGN's scheme is of first order; the older schemes have their own tangential motion.
Block implied(const Choice& choice) {
  if (choice["flow"] == "mean_curvature" || is_willmore(choice)) return {};
  Block block = {{"tangential", "none"}};
  if (choice["flow"] == "bgn") block.insert({"bdf", 1});
  return block;
}

/// Check: of BGN's scheme, which takes longest, the ellipsoid alone; of Willmore flow the run that
/// degenerates first, and the one that keeps its mesh.
std::vector<Block> preset(bool paper) {
  if (paper) return {{{"level", 1}}};
  return {{{"flow", {"mean_curvature", "dziuk"}}},
          {{"flow", "bgn"}, {"surface", "ellipsoid"}},
          {{"flow", "willmore"}, {"tangential", "none"}},
          {{"flow", "willmore_relaxed"}, {"tangential", "minimal_deformation"}}};
}

/// The numbers that claims are about: mesh and surface at the first steps from some times on, and at the end.
std::map<std::string, double> values(const Case& from, const Series& series) {
  const double end = series.at("t").back();
  std::map<std::string, double> list = {{"last_t", end},
                                        {"last_energy", series.at("willmore_energy").back()}};
  for (const std::string name : {"worst_angle", "worst_radius_ratio", "area"})
    for (const double t : from.times)
      if (t <= end * (1 + 1e-9)) list[name + format("_at_%g", t)] = value_at(series, name, t);
  return list;
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Case& from = case_of(choice);
  const auto generate = [&] {
    return generate_mesh(from.surface, edge_length(from.largest_h, choice.level()), 1);
  };
  const Mesh mesh = initial_mesh(choice, generate, from.surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The time steps, until the end or the singularity.
  RunRecorder recorder(
      space, snapshot_plan(folder, from.times, is_willmore(choice) ? "willmore" : choice["flow"], row));
  const auto go = [&](auto flow, const auto& steps, const auto& start) {
    run_recorded(flow, steps, {start}, folder, recorder, row,
                 [&](int n, const auto& state) { recorder.record(n, state); });
  };
  const UniformSteps uniform{choice.bdf(), row.tau, row.steps,
                             parse_start(choice.bdf() > 1 ? "substeps:16" : "cascade")};
  const auto tangential = choice["tangential"] == "none" ? MeanCurvatureFlow::Variant::none
                                                         : MeanCurvatureFlow::Variant::minimal_deformation;
  if (choice["flow"] == "bgn") {
    go(BgnFlow(space), uniform, bgn_state_on(space, mesh.nodes));
  } else if (choice["flow"] == "dziuk") {
    go(DziukFlow(space), uniform, dziuk_state_on(space, mesh.nodes));
  } else if (choice["flow"] == "mean_curvature") {
    MeanCurvatureFlow::Variant variant;
    variant.tangential = tangential;
    go(MeanCurvatureFlow(space, variant), uniform, mean_curvature_state_on(from.surface, mesh.nodes));
  } else {
    WillmoreFlow::Variant variant;
    variant.tangential = tangential;
    if (choice["flow"] == "willmore_relaxed") variant.relaxation = relaxation;
    go(WillmoreFlow(space, variant),
       AdaptiveSteps{"u", choice.bdf(), from.time_steps.end_time, tolerance, first_step, row.tau},
       willmore_start_on(space, from.surface, mesh.nodes, variant.law, false).state);
  }

  // 3. The row of the table.
  row.values.merge(values(from, row.series));
}

/// BGN's scheme has a system for four unknowns a node; Willmore flow factorises in most of its first 250
/// steps.
double cost(const Choice& choice) {
  static const std::map<std::string, double> vertices = {
      {"dumbbell", 700}, {"red_blood_cell", 500}, {"ellipsoid", 300}, {"torus", 600}};
  const bool slides = choice["tangential"] == "minimal_deformation";
  const double nodes = 4 * vertices.at(choice["surface"]) * std::pow(2, choice.level());
  if (is_willmore(choice)) return 0.5 + nodes * 400 * (slides ? 9e-6 : 2.5e-6);
  const double of_step = choice["flow"] == "bgn" ? 16e-6 : slides ? 5e-6 : 1.2e-6;
  return 0.5 + nodes * case_of(choice).time_steps.count(choice.step()) * of_step;
}

std::string known_end(const Choice& choice) {
  if (choice["flow"] == "willmore") return "nu_h and H_h leave the surface, until the mesh degenerates";
  return "the mesh degenerates";
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("tangential_motion", "esfem", run, otherwise, preset);
  experiment.help =
      "Mean curvature flow of the dumbbell, the Evans-Fung red blood cell and the ellipsoid (4, 1, 1), and\n"
      "Willmore flow of a torus: the smallest angle and the worst radius ratio of the mesh over time, for\n"
      "schemes with and without tangential motion. Step sizes 0.001 2^-k, 0.004 2^-k, 0.005 2^-k, of the\n"
      "torus at most 0.002 2^-k; level j of the meshes has 2^j times as many triangles as level 0. No "
      "units.\n\n"
      "Example: tangential_motion --surface ellipsoid --flow mean_curvature --levels 0 --steps 0-1";
  experiment.grid.axes = {
      {"surface", names_of(cases), "surfaces to start from"},
      {"flow",
       {"mean_curvature", "dziuk", "bgn", "willmore", "willmore_relaxed"},
       "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6) | bgn: Barrett, Garcke, Nürnberg 2008, of order 1 | "
       "willmore: kll21 (3.4)-(3.5), of the torus | willmore_relaxed: with relaxation"},
      {"tangential",
       {"none", "minimal_deformation"},
       "none: v = -H nu | minimal_deformation: Hu, Li 2022; with mean_curvature, willmore, "
       "willmore_relaxed"}};
  experiment.grid.labels = {"surface", "flow", "tangential"};
  experiment.grid.implied = implied;
  experiment.grid.admits = belongs_together;
  experiment.grid.refused = {{"start", "starting values are those of 16 substeps"}};
  experiment.comparisons = {{{{"flow", "mean_curvature"}, {"tangential", "none"}}, "_over_none", {"last_t"}}};
  experiment.steps = [](const Choice& choice) { return case_of(choice).time_steps; };
  experiment.cost = cost;
  experiment.known_end = known_end;
  experiment.parameters = {{"start", "substeps:16"}, {"tolerance", tolerance}, {"relaxation", relaxation}};
  experiment.meshes =
      "generated, graded by curvature, edges 0.2 (dumbbell), 0.4 (red blood cell), 0.6 (ellipsoid), 0.35";
  return run_experiment(experiment, argc, argv);
}
