// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of a dumbbell up to its pinch singularity: comparison of several algorithms (kll19
// §13.2, Figures 13.3 to 13.6)
//
// Sample runs:  build/bin/mcf_dumbbell --preset check --output dumbbell.json
//               build/bin/mcf_dumbbell --flow dziuk,bgn --levels 0 --steps 1 --start cascade
//               build/bin/mcf_dumbbell --flow mean_curvature --mesh reference/independent/dumbbell_450.msh
//
// Writes:       results/paper/mcf_dumbbell.{json,csv,tex}, from which plots/mcf_dumbbell.py draws
//               figures/kll19/fig13_3 .. fig13_6, and the surfaces of each run as
//               results/paper/cells/mcf_dumbbell/CELL/surfaces.pvd (ParaView), and singular.vtu beside it,
//               the surface at which the run stops: the extrapolated one where that is already degenerate
//
// The dumbbell {x1² + x2² + 2 x3² (x3² - 199/200) = 0.04} moves by v = -H nu until its neck pinches, at T* =
// 0.082233 (reference/independent/dumbbell_axisymmetric.json). The methods are Dziuk's scheme (3.6), (5.1),
// (5.1) with normalised nu_h, (5.1) with the stabilising term of §14, (5.1) with v_h by interpolation, and
// the scheme of Barrett, Garcke and Nürnberg (2008). The paper's setting is about 10,522 nodes, BDF2 started
// by one backward Euler step, tau = 0.003; accurate starting values by substeps and smaller tau show which
// effects are due to the method itself. A run ends at the singularity (geometry/regularity.hpp).
//
// Expected: all methods pinch at T* as tau and h go to 0; no orders are measured here.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/series.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/write_vtu.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{0.12, 0.003};
const std::vector<double> snapshot_times = {0.03, 0.06, 0.072, 0.075, 0.078, 0.084};

/// Variants of (5.1).
const std::map<std::string, MeanCurvatureFlow::Variant> variants = {
    {"plain", {}},
    {"normalised", {MeanCurvatureFlow::Variant::ritz, true}},
    {"interpolated", {MeanCurvatureFlow::Variant::interpolation}},
    {"alpha1", {MeanCurvatureFlow::Variant::ritz, false, 1}},
    {"alpha10", {MeanCurvatureFlow::Variant::ritz, false, 10}},
    {"alpha100", {MeanCurvatureFlow::Variant::ritz, false, 100}}};

Block otherwise(bool) {
  return {{"flow", {"mean_curvature", "dziuk", "bgn"}},
          {"variant", "plain"},
          {"degree", 2},
          {"bdf", 2},
          {"start", "substeps:16"},
          {"level", 0},
          {"step", 0}};
}

/// Variants are those of (5.1); BGN's scheme has one step, and no start.
Block implied(const Choice& choice) {
  if (choice["flow"] == "bgn") return {{"variant", "plain"}, {"bdf", 1}, {"start", "cascade"}};
  return choice["flow"] == "dziuk" ? Block{{"variant", "plain"}} : Block();
}

/// The paper's setting, and the same with accurate starting values, smaller step sizes and other methods.
std::vector<Block> preset(bool paper) {
  const char *kll = "mean_curvature", *euler = "cascade";
  const auto all_three = [](const Block& with) {
    Block dziuk = with, both = with;
    dziuk.insert({"flow", "dziuk"});
    both.insert({{"flow", "mean_curvature"}, {"variant", {"plain", "normalised"}}});
    return std::vector<Block>{dziuk, both};
  };
  std::vector<Block> blocks = {
      {{"flow", kll}, {"variant", {"alpha1", "alpha10", "alpha100"}}, {"start", euler}, {"level", 1}},
      {{"flow", kll}, {"start", euler}, {"level", 1}, {"step", 2}},
      {{"flow", kll}, {"variant", "interpolated"}, {"step", 2}},
      {{"flow", "bgn"}, {"level", paper ? range(0, 1) : range(0, 0)}, {"step", {0, 1}}},
      {{"flow", "bgn"}, {"degree", 1}, {"level", paper ? range(0, 1) : range(0, 0)}}};
  const std::vector<int> steps = paper ? range(0, 2) : std::vector<int>{0, 2};
  for (const Block& with : {Block{{"start", euler}, {"level", 1}}, Block{{"start", euler}, {"step", 2}},
                            Block{{"step", 2}}, Block{{"level", 1}, {"step", steps}}})
    for (const Block& block : all_three(with)) blocks.push_back(block);
  return blocks;
}

/// Level 0: about 3,000 nodes of quadratic elements, edges at most as long as the local radius of curvature;
/// level 1: as published, about 10,522 nodes with edges of equal length.
Mesh corner_mesh_of_level(int level) {
  require_levels({level}, 2, "levels");
  const Surface surface = dumbbell();
  if (level == 1) return generate_mesh(surface, 0.0902);
  const double largest = 0.2;
  return generate_mesh(surface, [&](const Vec3& y) {
    const Mat3 A = surface.weingarten(y);
    return 1 / std::sqrt(1 / (largest * largest) + A.squaredNorm());
  });
}

/// For BGN's scheme with P1, linear elements between the nodes of quadratic ones.
Mesh mesh_of(const Choice& choice) {
  const bool linear = choice["flow"] == "bgn" && choice.degree() == 1;
  const auto generate = [&] { return corner_mesh_of_level(choice.level()); };
  const Mesh mesh =
      initial_mesh(choice.meshes(), choice.level(), generate, dumbbell(), linear ? 2 : choice.degree());
  return linear ? subdivide(mesh) : mesh;
}

/// The numbers that claims are about.
std::map<std::string, double> values(const Series& series) {
  std::map<std::string, double> list;
  const auto add = [&](const std::string& name, std::optional<double> value) {
    if (value) list[name] = *value;
  };
  add("pinch_time", pinch_time(series));
  for (const std::string name : {"widest_radius", "tip", "max_H", "max_nu", "worst_angle",
                                 "smallest_elements", "smallest_elements_x3"})
    if (series.count(name)) add(name + "_at_0.06", recorded_at(series, name, 0.06));
  for (const std::string name : {"widest_radius", "neck_radius"})
    add(name + "_at_0.069", recorded_at(series, name, 0.069));
  for (const std::string name : {"max_H", "max_nu", "min_nu", "worst_angle", "neck_radius", "t"})
    if (series.count(name)) add("last_" + name, series.at(name).back());
  if (series.count("max_nu"))
    add("largest_deviation_of_nu",
        std::max(largest_deviation(series.at("max_nu"), 1), largest_deviation(series.at("min_nu"), 1)));
  return list;
}

/// A scheme that keeps the surface at which it becomes singular: the extrapolated one where that is already
/// degenerate, otherwise the computed one.
template <class Scheme>
struct KeepsSingularSurface {
  using State = typename Scheme::State;
  Scheme scheme;
  double t = 0;
  Field x = {};
  bool extrapolated = false;

  void step(const BdfStep<State>& step, State& next) {
    next.x.resize(0, 3);
    try {
      scheme.step(step, next);
    } catch (const SingularityError&) {
      t = step.t;
      x = next.x;
      extrapolated = x.size() == 0;
      if (extrapolated) step.extrapolate(&State::x, x);
      throw;
    }
  }
};

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it; that of BGN for P1 is lumped.
  const std::string& flow = choice["flow"];
  const Mesh mesh = mesh_of(choice);
  const SurfaceSpace space(mesh,
                           flow == "bgn" && choice.degree() == 1 ? vertex_quadrature() : choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The time steps, until the end or the singularity.
  RunRecorder recorder(space, snapshot_plan(folder, snapshot_times, flow, row));
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  const auto record = [&](int n, const auto& state) {
    recorder.record(n, state);
    record_profile(state.x, recorder.series());
    record_node_density(space.elements(), state.x, recorder.series());
  };
  const auto go = [&](auto scheme, const auto& start) {
    KeepsSingularSurface<decltype(scheme)> flow_to_pinch{std::move(scheme)};
    row.status = run_to_end([&] { integrate(flow_to_pinch, steps, start, record); }, recorder);
    if (folder.empty() || flow_to_pinch.x.size() == 0) return;
    write_vtu(space.degree(), mesh.elements, flow_to_pinch.x, {}, {}, folder + "/singular.vtu");
    row.more["singular_surface"] = {
        {"t", flow_to_pinch.t}, {"file", "singular.vtu"}, {"extrapolated", flow_to_pinch.extrapolated}};
  };
  if (flow == "bgn") {
    go(BgnFlow(space), bgn_state_on(space, mesh.nodes));
  } else if (flow == "dziuk") {
    warn(dziuk_warning(steps.order));
    go(DziukFlow(space), dziuk_state_on(space, mesh.nodes));
  } else {
    go(MeanCurvatureFlow(space, variants.at(choice["variant"])),
       mean_curvature_state_on(dumbbell(), mesh.nodes));
  }

  // 3. The row of the table.
  describe_run(recorder, row);
  row.values = values(row.series);
}

/// Until the pinch: about 1 microsecond a node and step, 8 with BGN's scheme.
double cost(const Choice& choice) {
  const double nodes = choice.level() == 1 ? 10522 : 3000, steps = 0.083 / time_steps.tau(choice.step());
  return 1 + nodes * steps * (choice["flow"] == "bgn" ? 8e-6 : 1e-6);
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("mcf_dumbbell", "kll19", run, otherwise, preset);
  experiment.help =
      "Mean curvature flow of a dumbbell up to its pinch singularity at t = 0.082233 by several methods\n"
      "(kll19 Figures 13.3 to 13.6): time series, snapshots and the pinch time of each. Step sizes\n"
      "0.003 2^-k, k = 0, 1, ..; level 0: about 3,000 nodes, level 1: about 10,522, as published. v = -H nu "
      "has\n"
      "no units. With --output FILE.json surfaces go to cells/mcf_dumbbell/CELL/surfaces.pvd beside it.\n\n"
      "Example: mcf_dumbbell --flow mean_curvature --variant normalised --steps 2 --output dumbbell.json";
  experiment.grid.axes = {
      {"flow",
       {"mean_curvature", "dziuk", "bgn"},
       "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6) | bgn: Barrett, Garcke, Nürnberg 2008, backward "
       "Euler; with --degree 1 on triangles divided into four"},
      {"variant",
       {"plain", "normalised", "interpolated", "alpha1", "alpha10", "alpha100"},
       "of (5.1): nu_h normalised | v_h by interpolation | stabilising term of §14, alpha = 1, 10, 100"}};
  experiment.grid.labels = {"flow", "variant", "degree", "start"};
  experiment.grid.implied = implied;
  experiment.comparisons = {
      {{{"variant", "plain"}}, "_over_plain", {"pinch_time", "last_max_nu", "widest_radius_at_0.06"}},
      {{{"variant", "normalised"}}, "_over_normalised", {"pinch_time"}},
      {{{"flow", "mean_curvature"}}, "_over_kll19", {"smallest_elements_at_0.06"}},
      {nlohmann::json::object(), "_over_coarser", {"pinch_time"}, -1},
      {nlohmann::json::object(), "_over_larger_tau", {"pinch_time"}, 0, 4}};
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = cost;
  experiment.known_end = [](const Choice&) { return "the neck pinches"; };
  experiment.parameters = {{"end_time", time_steps.end_time}, {"largest_tau", time_steps.largest}};
  experiment.meshes = "generated, level 0: edge length (0.2^-2 + |A|²)^(-1/2), level 1: 0.0902";
  return run_experiment(experiment, argc, argv);
}
