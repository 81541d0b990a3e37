// SPDX-License-Identifier: GPL-3.0-or-later
//
// Spinodal decomposition on a sphere (PFHub benchmark 1d): the energies that others have published, and what
// they owe to the mesh and to the steps
//
// Sample runs:  build/bin/cahn_hilliard_pfhub --preset check --output pfhub.json
//               build/bin/cahn_hilliard_pfhub --degree 2 --levels 0-2 --end 300
//               build/bin/cahn_hilliard_pfhub --stepping moose --levels 0,1
//
// Writes:       results/paper/cahn_hilliard_pfhub.{json,csv,tex}, from which
//               plots/cahn_hilliard_pfhub.py draws figures/pfhub/fig1d, and c on the sphere as
//               results/paper/cells/cahn_hilliard_pfhub/CELL/surfaces.pvd
//
// Cahn-Hilliard equation on a sphere of radius 100 at rest (solver/flows/pfhub_sphere.hpp), from waves around
// c = 0.5 until it is steady, with g linearised in each step (solver/flows/linearised_cahn_hilliard.hpp).
// Stepping:
//   adaptive  BDF2, steps from 0.01 on that follow c, as far as t = 1.5e5
//   moose     backward Euler with Newton's method and the steps of the published run until its third time:
//             1, 1.1, .., 1.1^4, and then 15 of 1.1^5. Its times tell them: 6.1051 = 1 + .. + 1.1^4, and
//             14.158 and 30.263 come 5 and 15 steps of 1.1^5 later.
//
// Where linear elements have become steady the run goes on with quadratic ones on the same triangles.
//
// Expected: with its steps, its energies to 3%; with small steps the decomposition comes 3 time units later.
// The steady states of 3,000 and 6,000 linear nodes are those of their meshes: an interface is 2 sqrt 5 = 4.5
// wide, and edges of 5 or 7 pin it. On quadratic elements coarsening goes on.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/error.hpp"
#include "solver/flows/pfhub_sphere.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/time/integrate.hpp"

namespace {

using namespace esfem;
using State = CahnHilliardState;
using Flow = LinearisedCahnHilliard<PfhubSphere>;

const double steady_time = 1.5e5, early_time = 300, first_step = 0.01, largest_tolerance = 2e-3;
/// g is linearised again when c has changed by more than this in a node: else energy rises by up to 1e-3
/// where a domain vanishes, which the root mean square hardly sees.
const double linearised_again_from = 0.03, newton_tolerance = 1e-9;
/// Times of the published energies; the second and the third are rounded there.
struct PublishedTime {
  const char* name;
  double t;
};
const std::array<PublishedTime, 6> published_times = {{{"6.1051", 6.1051},
                                                       {"14.158", 14.15765},
                                                       {"30.263", 30.26275},
                                                       {"297.45", 297.45},
                                                       {"1000", 1000},
                                                       {"5006", 5006}}};

enum class Stepping { adaptive, moose };
const std::vector<std::string> known_steppings = {"adaptive", "moose"};

/// One run. Level 1 has 5,900 nodes, whatever the degree, and each level twice as many as the one before.
struct Run {
  Stepping stepping;
  int degree, level, bdf;
  int k;  ///< the tolerance of adaptive steps is 2e-3 2^-k
  double end_time;

  double tolerance() const { return largest_tolerance * std::pow(2.0, -k); }
  double edge_length() const { return degree * esfem::edge_length(9.66, level); }
  std::string name() const {
    const std::string steps = stepping == Stepping::moose ? "moose" : format("bdf%d_tol%d", bdf, k);
    return format("p%d_h%d_%s", degree, level, steps.c_str());
  }
};

struct OwnOptions {
  std::vector<std::string> steppings;
  std::optional<double> end_time;
};

/// The times of the published run until its third published energy.
std::vector<double> moose_times() {
  std::vector<double> times = {0};
  for (int n = 0; n < 20; ++n) times.push_back(times.back() + std::pow(1.1, std::min(n, 5)));
  return times;
}

std::vector<Run> preset_runs(const std::string& preset) {
  const Run moose = {Stepping::moose, 1, 1, 1, 0, moose_times().back()};
  const auto adaptive = [](int degree, int level, int k, double end) {
    return Run{Stepping::adaptive, degree, level, 2, k, end};
  };
  if (preset == "check") return {moose, adaptive(1, 1, 1, early_time)};
  return {moose,
          adaptive(1, 0, 0, steady_time),
          adaptive(1, 1, 1, steady_time),
          adaptive(1, 1, 3, early_time),
          adaptive(2, 2, 0, steady_time),
          adaptive(2, 3, 1, early_time)};
}

std::vector<Run> resolve(const Options& options, const OwnOptions& own) {
  if (!options.meshes.empty() || options.start) {
    throw InputError(
        "--mesh, --start: the meshes are those of the sphere, and adaptive steps start by themselves; "
        "expected "
        "--degree, --levels, --steps, --bdf, --stepping, --end");
  }
  if (options.bdf.value_or(2) > 2)
    throw InputError(format("--bdf: found %d, expected 1 or 2 for adaptive steps", *options.bdf));
  if (!options.degree && !options.levels && !options.steps && !options.bdf && own.steppings.empty() &&
      !own.end_time)
    return preset_runs(options.preset);
  std::vector<Run> runs;
  for (const std::string& stepping :
       own.steppings.empty() ? std::vector{known_steppings[0]} : own.steppings) {
    const bool moose = stepping == "moose";
    const std::vector<int> tolerances = moose ? range(0, 0) : options.steps.value_or(range(1, 1));
    for (const int level : options.levels.value_or(range(1, 1)))
      for (const int k : tolerances)
        runs.push_back({moose ? Stepping::moose : Stepping::adaptive, options.degree.value_or(1), level,
                        moose ? 1 : options.bdf.value_or(2), k,
                        moose          ? moose_times().back()
                        : own.end_time ? *own.end_time
                                       : steady_time});
  }
  return runs;
}

/// The number of connected parts of the surface where c > 0.5, and where c < 0.5. On a sphere there is one
/// curve less between them.
int count_domains(const SparsityPattern& neighbours, const Field& c) {
  std::vector<int> parent(neighbours.size);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int domains = neighbours.size;
  for (int j = 0; j < neighbours.size; ++j) {
    for (int k = neighbours.column_start[j]; k < neighbours.column_start[j + 1]; ++k) {
      const int i = neighbours.row[k];
      if ((c(i) > 0.5) != (c(j) > 0.5) || root(i) == root(j)) continue;
      parent[root(i)] = root(j);
      --domains;
    }
  }
  return domains;
}

/// Hermite's cubic interpolation at t of a function with values and derivatives at two times.
double interpolate(const std::array<double, 3>& before, const std::array<double, 3>& after, double t) {
  const auto [t0, f0, d0] = before;
  const auto [t1, f1, d1] = after;
  const double tau = t1 - t0, s = (t - t0) / tau, r = 1 - s;
  return r * r * (1 + 2 * s) * f0 + s * s * (1 + 2 * r) * f1 + tau * s * r * (r * d0 - s * d1);
}

/// Sees every step; records the first ones, and then every fourth.
class Observer {
 public:
  Observer(const SurfaceSpace& space, const Field& x, RunRecorder& recorder, const Run& run)
      : space_(space), recorder_(recorder), run_(run), A_(space.matrix()) {
    SymmetricMatrix M = space.matrix();
    space.assemble(x, M, A_);
  }

  void operator()(int n, const State& state) {
    // d/dt of the energy is - int M |grad mu|², and w = M mu.
    const double energy = pfhub_energy(space_, state.x, state.u), mass = state.Mu.sum();
    const std::array<double, 3> now = {state.t, energy, -A_.energy(state.w) / PfhubSphere::mobility};
    if (n == 0) first_mass_ = mass;
    mass_drift_ = std::max(mass_drift_, std::abs(mass / first_mass_ - 1));
    if (n > 0) {
      largest_rise_ = std::max(largest_rise_, energy / before_[1] - 1);
      while (energies_.size() < published_times.size() &&
             published_times[energies_.size()].t <= state.t * (1 + 1e-9))
        energies_.push_back(interpolate(before_, now, published_times[energies_.size()].t));
    }
    before_ = now;
    if (n > 200 && n % 4 != 0 && state.t < run_.end_time * (1 - 1e-9)) return;
    recorder_.record(n, state.t, state.x, {{"c", state.u}, {"mu", state.w / PfhubSphere::mobility}});
    Series& series = recorder_.series();
    series["energy"].push_back(energy);
    series["min_c"].push_back(state.u.minCoeff());
    series["max_c"].push_back(state.u.maxCoeff());
    series["domains"].push_back(count_domains(*space_.pattern(), state.u));
  }

  /// The numbers that claims are about.
  void describe(Row& row) const {
    for (std::size_t i = 0; i < energies_.size(); ++i)
      row.values[std::string("energy_at_") + published_times[i].name] = energies_[i];
    const std::vector<double>&t = row.series.at("t"), &energy = row.series.at("energy");
    row.values["initial_energy"] = energy.front();
    row.values["last_energy"] = energy.back();
    row.values["last_domains"] = row.series.at("domains").back();
    row.values["largest_rise"] = largest_rise_;
    row.values["mass_drift"] = mass_drift_;
    std::size_t i = energy.size() - 1;
    while (i > 0 && std::abs(energy[i - 1] / energy.back() - 1) < 0.01) --i;
    row.values["steady_from"] = t[i];
  }

  /// What the series cannot tell.
  nlohmann::json progress() const {
    return {{"before", before_},
            {"energies", energies_},
            {"first_mass", first_mass_},
            {"mass_drift", mass_drift_},
            {"largest_rise", largest_rise_}};
  }
  void resume(const nlohmann::json& saved) {
    before_ = saved.at("before");
    energies_ = saved.at("energies").get<std::vector<double>>();
    first_mass_ = saved.at("first_mass");
    mass_drift_ = saved.at("mass_drift");
    largest_rise_ = saved.at("largest_rise");
  }

 private:
  const SurfaceSpace& space_;
  RunRecorder& recorder_;
  const Run& run_;
  SymmetricMatrix A_;
  std::array<double, 3> before_ = {};  ///< t, energy and its derivative at the step before
  std::vector<double> energies_;       ///< at the published times
  double first_mass_ = 0, mass_drift_ = 0, largest_rise_ = -1;
};

using Observe = std::function<void(int, const State&)>;

/// Integrates with the steps of the run; what they were goes into the row.
void integrate_run(const Run& run, Flow& flow, const State& start, const Observe& observe,
                   Checkpoint* checkpoint, Row& row) {
  if (run.stepping == Stepping::moose) {
    row.steps = integrate(flow, GivenTimes{1, moose_times()}, start, observe).steps;
    return;
  }
  AdaptiveSteps grid;
  grid.controlled = "u";
  grid.order = run.bdf;
  grid.end_time = run.end_time;
  grid.tolerance = run.tolerance();
  grid.first_step = first_step;
  const StepCount done = integrate(flow, grid, start, checkpoint, observe);
  row.steps = done.steps;
  row.values["rejected_steps"] = done.rejected;
}

/// Whether the mesh alone holds a state of linear elements: goes on from it with quadratic elements on the
/// same triangles. The energy after 100 time units, when the profiles of the interfaces have become those of
/// the finer mesh, and after 5000 go into the row.
void release(const Mesh& linear, const Field& c, Row& row) {
  Mesh mesh = lagrange_mesh(linear, 2);
  project_nodes(mesh, sphere(PfhubSphere::radius));
  const Field c_fine = lagrange_values(linear, c, mesh);
  const SurfaceSpace space(mesh);
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  Flow flow(space, PfhubSphere(), at_rest, PfhubSphere::epsilon, linearised_again_from);
  AdaptiveSteps grid;
  grid.controlled = "u";
  grid.end_time = 5000;
  grid.tolerance = largest_tolerance;
  grid.first_step = first_step;
  integrate(flow, grid, pfhub_state(space, mesh.nodes, c_fine), [&](int, const State& state) {
    const double energy = pfhub_energy(space, state.x, state.u);
    if (state.t <= 100) row.values["released_energy_at_100"] = energy;
    row.values["released_energy_at_5000"] = energy;
  });
}

Row run_cell(const Run& run, Row row, const std::string& folder) {
  // 1. The sphere and the finite element space on it.
  const Surface surface = sphere(PfhubSphere::radius);
  const auto generate = [&] { return generate_mesh(surface, run.edge_length()); };
  const Mesh mesh = initial_mesh({}, 0, generate, surface, run.degree);
  const SurfaceSpace space(mesh);
  describe_mesh(mesh, row);

  // 2. The flow and its initial state.
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  const double iterate_to = run.stepping == Stepping::moose ? newton_tolerance : linearised_again_from;
  Flow flow(space, PfhubSphere(), at_rest, PfhubSphere::epsilon, iterate_to);
  const State start = pfhub_state(space, mesh.nodes, pfhub_initial_values(mesh.nodes));

  // 3. The time steps.
  RunRecorder recorder(space,
                       snapshot_plan(folder, {14.15765, 30.26275, 297.45, 1000, 5006}, "cahn_hilliard", row));
  Observer observer(space, mesh.nodes, recorder, run);
  std::optional<Checkpoint> checkpoint = checkpoint_in(folder, run.name());
  if (checkpoint) {
    attach(*checkpoint, recorder);
    checkpoint->attach([&] { return observer.progress(); },
                       [&](const nlohmann::json& saved) { observer.resume(saved); });
  }
  const Observe observe = [&](int n, const State& state) { observer(n, state); };
  row.status = run_to_end(
      [&] { integrate_run(run, flow, start, observe, checkpoint ? &*checkpoint : nullptr, row); }, recorder);
  if (checkpoint) row.seconds = checkpoint->seconds_before();

  // 4. The row of the table.
  describe_run(recorder, row);
  observer.describe(row);
  if (run.degree == 1 && run.end_time == steady_time && row.status == "ok")
    release(mesh, recorder.newest().fields[0].values, row);
  return row;
}

/// Seconds on one core: a linear system takes about 7 microseconds a node.
double estimated_cost(const Run& run) {
  const double nodes = 2950 * std::pow(2.0, run.level);
  const double systems =
      run.stepping == Stepping::moose ? 100 : 50 * std::pow(run.end_time, 0.27) * std::pow(2.0, 0.5 * run.k);
  return nodes * systems * 7e-6;
}

std::vector<Cell> cells(const std::vector<Run>& runs) {
  std::vector<Cell> list;
  for (const Run& run : runs) {
    const bool moose = run.stepping == Stepping::moose;
    Row row;
    row.level = run.level;
    row.tau = moose ? moose_times()[1] : first_step;
    row.labels = {{"degree", run.degree},
                  {"stepping", moose ? "backward Euler, MOOSE's steps" : format("BDF%d", run.bdf)}};
    if (!moose) row.labels["tolerance"] = run.tolerance();
    list.push_back(
        {run.name(), estimated_cost(run),
         [=](const Row& planned, const std::string& folder) { return run_cell(run, planned, folder); }, row});
  }
  return list;
}

nlohmann::json parameters(const std::string& preset) {
  return {{"preset", preset},
          {"radius", PfhubSphere::radius},
          {"kappa", PfhubSphere::kappa},
          {"mobility", PfhubSphere::mobility},
          {"end_time", steady_time},
          {"tau", "the first step"},
          {"meshes", "generated; each level has twice as many nodes as the one before"}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "cahn_hilliard_pfhub";
  experiment.paper = "pfhub";
  experiment.help =
      "Spinodal decomposition on a sphere (PFHub benchmark 1d): energies over time until the state is "
      "steady, and "
      "snapshots of\n"
      "the concentration. Level 1 has 5,900 nodes, whatever the degree, each level twice as many as the one "
      "before; --steps k:\n"
      "tolerance 2e-3 2^-k of the steps. No units.\n\n"
      "Example: cahn_hilliard_pfhub --degree 2 --levels 0-2 --end 300 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--stepping", known_steppings, own.steppings,
               "adaptive: BDF2 with steps that follow the solution | moose: backward Euler with the steps of "
               "the published run, to t = 30.263");
    line.positive("--end", own.end_time, "end time of adaptive steps (default: 1.5e5)");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) { return parameters(options.preset); };
  return run_experiment(experiment, argc, argv);
}
