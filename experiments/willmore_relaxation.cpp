// SPDX-License-Identifier: GPL-3.0-or-later
//
// Willmore flow towards stationary surfaces (kll21 §7.2, Figure 7.5), and why it may miss them
//
// Sample runs:  build/bin/willmore_relaxation --preset check --output relaxation.json
//               build/bin/willmore_relaxation --surfaces ellipsoid --settings paper,relaxed
//               build/bin/willmore_relaxation --surfaces small_ellipsoid --settings relaxed --levels 0-2
//
// Writes:       results/paper/willmore_relaxation.{json,csv,tex}, from which plots/willmore_relaxation.py
// draws
//               figures/kll21/fig7_5 and figures/gallery/willmore_relaxation, and the surfaces as
//               results/paper/cells/willmore_relaxation/CELL/surfaces.pvd
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
// Expected: on a sphere H_h - 2/R is conserved, so an error that the first 1e-3 time units leave in H_h
// stays: W(H_h) levels off above 8 pi and the sphere shrinks for ever. Adaptive steps make that error small;
// the relaxation removes it, and with it a mode of nu_h that grows on the torus whatever tau is.
#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/time/integrate.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const double end_time = 4, relaxation = 100;
const int fixed_step_exponent = 8;  // tau = 0.2 2^-8

/// A surface to start from, its mesh, `scale` times as coarse as the published one, and where it tends to.
struct Case {
  std::string name;
  Surface surface;
  std::function<Mesh(const Surface&, double scale)> mesh;
  enum Limit { sphere, clifford_torus } limit;
  int nodes;                 ///< of the published mesh, about
  double largest_step;       ///< of adaptive steps: beyond it the relaxation is not stable
  double first_step = 1e-6;  ///< of adaptive steps
};

std::function<Mesh(const Surface&, double)> uniform(double edge_length) {
  return [=](const Surface& surface, double scale) { return generate_mesh(surface, scale * edge_length); };
}

/// A uniform mesh that resolves the narrowest places of this torus has 39,000 nodes.
Mesh graded(const Surface& surface, double scale) {
  return generate_mesh(surface, radial_edge_length(0.3, 0.0577 * scale, 1.7, 0.2307 * scale));
}

const std::vector<Case>& known_cases() {
  static const std::vector<Case> list = {
      {"ellipsoid", ellipsoid(2, 1, 1), uniform(0.1949), Case::sphere, 5000, 0.008},
      {"red_blood_cell", red_blood_cell(), uniform(0.1794), Case::sphere, 9000, 0.008},
      {"perturbed_torus", perturbed_torus(2, 1.2, 0.1, 3), uniform(0.26265), Case::clifford_torus, 12000,
       0.008},
      {"small_ellipsoid", ellipsoid(1, 1, 0.6), uniform(0.1292), Case::sphere, 4900, 0.005},
      {"evans_fung_cell", evans_fung_cell(), uniform(0.0924), Case::sphere, 9000, 0.005},
      {"small_torus", perturbed_torus(1, 0.6, 0.05, 3), uniform(0.1313), Case::clifford_torus, 12000, 0.002},
      // Its velocity is 2e4 at first.
      {"small_torus_4", perturbed_torus(1, 0.6, 0.1, 4), graded, Case::clifford_torus, 12000, 0.002, 1e-9},
  };
  return list;
}

std::vector<std::string> names(const std::vector<Case>& cases) {
  std::vector<std::string> list;
  for (const Case& entry : cases) list.push_back(entry.name);
  return list;
}

const std::vector<std::string> known_settings = {"paper", "implicit", "adaptive", "relaxed"};

/// One run. Each level has half as many triangles as the one before.
struct Run {
  Case start;
  std::string setting;
  int level;
  double end_time;

  bool adaptive() const { return setting == "adaptive" || setting == "relaxed"; }
};

struct OwnOptions {
  std::vector<std::string> surfaces, settings;
};

struct Setting {
  int degree;
  std::vector<Run> runs;
};

double end_of(const std::string& setting) {
  return setting == "implicit" ? 0.1 : end_time;
}

std::vector<Run> preset_runs(const std::string& preset) {
  std::vector<Run> runs;
  const auto add = [&](const std::string& name, const std::string& setting, int level, double end) {
    for (const Case& entry : known_cases())
      if (entry.name == name) runs.push_back({entry, setting, level, end});
  };
  if (preset == "paper") {
    for (const Case& entry : known_cases())
      for (const char* setting : {"paper", "adaptive", "relaxed"}) add(entry.name, setting, 0, end_time);
    add("small_ellipsoid", "implicit", 0, 0.1);
    for (const int level : {1, 2}) add("small_ellipsoid", "relaxed", level, end_time);
  } else {
    add("small_ellipsoid", "paper", 0, 0.1);
    add("small_ellipsoid", "implicit", 0, 0.1);
    add("small_ellipsoid", "adaptive", 0, end_time);
    for (const int level : {0, 1, 2}) add("small_ellipsoid", "relaxed", level, end_time);
  }
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  if (!options.meshes.empty() || options.steps || options.bdf || options.start) {
    throw InputError(
        "--mesh, --steps, --bdf, --start: surfaces and step sizes are those of the settings; expected "
        "--surfaces, --settings, --levels (evolve takes any mesh and step size)");
  }
  Setting setting;
  setting.degree = options.degree.value_or(2);
  if (!options.levels && own.surfaces.empty() && own.settings.empty()) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  for (const Case& entry : known_cases()) {
    for (const std::string& name : own.surfaces.empty() ? names(known_cases()) : own.surfaces) {
      if (name != entry.name) continue;
      for (const std::string& kind : own.settings.empty() ? known_settings : own.settings)
        for (const int level : options.levels.value_or(range(0, 0)))
          setting.runs.push_back({entry, kind, level, end_of(kind)});
    }
  }
  return setting;
}

WillmoreFlow::Variant variant(const Run& run) {
  WillmoreFlow::Variant variant;
  if (run.setting == "implicit") variant.F = WillmoreFlow::Variant::implicit;
  if (run.setting == "relaxed") variant.relaxation = relaxation;
  return variant;
}

/// Records the first steps and then every eighth, and what of the surface moves at the end.
class Observer {
 public:
  Observer(RunRecorder& recorder, const Run& run) : recorder_(recorder), run_(run) {}

  void operator()(int n, const State& state) {
    const bool last = state.t >= run_.end_time * (1 - 1e-9);
    if (n > (run_.adaptive() ? 200 : 32) && n % 8 != 0 && !last) return;
    recorder_.record(n, state.t, state.x, nodal_fields(state));
    Series& series = recorder_.series();
    if (run_.start.limit == Case::sphere) {
      series["radius"].push_back(fitted_sphere_radius(state.x));
    } else {
      const TorusRadii radii = fitted_torus_radii(state.x);
      series["major"].push_back(radii.major);
      series["minor"].push_back(radii.minor);
    }
    if (settled_.size() == 0 && state.t >= 3.5) settled_ = state.x;
    series["moved"].push_back(settled_.size() == 0 ? 0 : (state.x - settled_).rowwise().norm().maxCoeff());
  }

  /// What the series have cannot tell `settled_`, the surface at t = 3.5.
  nlohmann::json progress() const { return packed(settled_); }
  void resume(const nlohmann::json& saved) { settled_ = unpacked(saved); }

 private:
  RunRecorder& recorder_;
  const Run& run_;
  Field settled_;
};

/// The value of a series at the first step at or after time t, or at the end.
double value_at(const Series& series, const std::string& name, double t) {
  const std::vector<double>& times = series.at("t");
  const auto found = std::lower_bound(times.begin(), times.end(), t * (1 - 1e-9));
  return series.at(name)[std::min<std::size_t>(found - times.begin(), times.size() - 1)];
}

/// The numbers that claims are about. The largest rise of the energy is that between recorded steps.
void describe_end(const Run& run, Row& row) {
  const Series& series = row.series;
  const double limit = run.start.limit == Case::sphere ? 8 * pi : 4 * pi * pi;
  const auto last = [&](const std::string& name) { return series.at(name).back(); };
  const double excess = last("willmore_energy") - limit;
  row.values["willmore_excess"] = excess;
  row.values["kappa_excess"] = last("kappa_energy") - limit;
  row.values["excess_at_0.1"] = value_at(series, "willmore_energy", 0.1) - limit;
  row.errors["energy"]["excess"] = std::abs(excess);
  double rise = 0;
  const std::vector<double>& energy = series.at("willmore_energy");
  for (std::size_t i = 1; i < energy.size(); ++i) rise = std::max(rise, energy[i] - energy[i - 1]);
  row.values["largest_rise"] = rise;
  if (last("t") < end_time) return;
  row.values["moved_from_3.5"] = last("moved");
  if (run.start.limit == Case::sphere)
    row.values["radius_change_from_3"] = std::abs(last("radius") - value_at(series, "radius", 3));
  else
    row.values["ratio_of_radii_off"] = std::abs(last("major") / last("minor") - std::sqrt(2.0));
}

/// Integrates with the steps of the setting; what they were goes into the row.
void integrate_run(const Run& run, const WillmoreStart& start, WillmoreFlow& flow,
                   const std::function<void(int, const State&)>& observe, Checkpoint* checkpoint, Row& row) {
  if (run.adaptive()) {
    AdaptiveSteps grid;
    grid.controlled = "u";
    grid.end_time = run.end_time;
    grid.first_step = run.start.first_step;
    grid.largest_step = run.start.largest_step;
    const StepCount done = integrate(flow, grid, start.state, checkpoint, observe);
    row.steps = done.steps;
    row.values["rejected_steps"] = done.rejected;
  } else {
    const UniformSteps grid{2, row.tau, row.steps, parse_start("cascade")};
    integrate(flow, grid, start.state, checkpoint, observe);
  }
}

std::string cell_name(const Run& run) {
  return format("%s_%s_h%d", run.start.name.c_str(), run.setting.c_str(), run.level);
}

Row run_cell(const Setting& setting, const Run& run, Row row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Surface& surface = run.start.surface;
  const auto generate = [&] { return run.start.mesh(surface, std::pow(2.0, 0.5 * run.level)); };
  const Mesh mesh = initial_mesh({}, 0, generate, surface, setting.degree);
  const SurfaceSpace space(mesh);
  describe_mesh(mesh, row);

  // 2. The flow, from the exact normal and mean curvature.
  const WillmoreStart start =
      willmore_start_on(space, surface, mesh.nodes, WillmoreFlow::Variant::willmore, false);
  WillmoreFlow flow(space, variant(run), start.theta);

  // 3. The time steps.
  RunRecorder recorder(space, snapshot_plan(folder, {0.5, 1, 2, 3}, "willmore", row),
                       RunRecorder::of_flow_and_surface);
  Observer observer(recorder, run);
  std::optional<Checkpoint> checkpoint = checkpoint_in(folder, cell_name(run));
  if (checkpoint) {
    attach(*checkpoint, recorder);
    checkpoint->attach([&] { return observer.progress(); },
                       [&](const nlohmann::json& saved) { observer.resume(saved); });
  }
  const auto observe = [&](int n, const State& state) { observer(n, state); };
  row.status = run_to_end(
      [&] { integrate_run(run, start, flow, observe, checkpoint ? &*checkpoint : nullptr, row); }, recorder);
  if (checkpoint) row.seconds = checkpoint->seconds_before();

  // 4. The row of the table.
  describe_run(recorder, row);
  describe_end(run, row);
  return row;
}

/// Seconds on one core. A step takes about 4 microseconds a node when it factorises, as the implicit one and
/// most of the first adaptive steps do, and 1 when it does not. A run that ends early takes less.
double estimated_cost(const Run& run) {
  const double nodes = run.start.nodes * std::pow(2.0, -run.level);
  if (run.adaptive()) return nodes * (300 * 4e-6 + end_time / run.start.largest_step * 1.2e-6);
  const double steps = 5120 * run.end_time / end_time;
  return nodes * steps * (run.setting == "implicit" ? 9e-6 : 1.2e-6);
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    const HalvedSteps steps =
        run.adaptive() ? HalvedSteps{run.end_time, run.start.largest_step} : HalvedSteps{run.end_time, 0.2};
    const int k = run.adaptive() ? 0 : fixed_step_exponent;
    list.push_back(
        {cell_name(run), estimated_cost(run),
         [=](const Row& row, const std::string& folder) { return run_cell(setting, run, row, folder); },
         planned_row(run.level, steps, k, {{"surface", run.start.name}, {"setting", run.setting}})});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", end_time},
          {"degree", setting.degree},
          {"bdf", 2},
          {"tau", "0.2 2^-8; adaptive: the largest"},
          {"tolerance", AdaptiveSteps().tolerance},
          {"relaxation", relaxation},
          {"meshes", "generated; each level has half as many nodes as the one before"}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "willmore_relaxation";
  experiment.paper = "kll21";
  experiment.help =
      "Willmore flow of an ellipsoid, a red blood cell and a perturbed torus to t = 4 (kll21 Figure 7.5): "
      "energies, radii and\n"
      "snapshots, as the paper runs it, with adaptive steps, and with relaxation towards the geometry. Level "
      "0: the published\n"
      "numbers of nodes, each further level half of them. No units.\n\n"
      "Example: willmore_relaxation --surfaces small_ellipsoid --settings relaxed --levels 0-2 --output "
      "table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--surfaces", names(known_cases()), own.surfaces, "surfaces to start from");
    line.names(
        "--settings", known_settings, own.settings,
        "paper: tau = 0.2 2^-8 | implicit: the same with F implicit, to t = 0.1 | adaptive: adaptive steps | "
        "relaxed: adaptive steps and relaxation");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
