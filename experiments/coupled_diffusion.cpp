// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surface evolution coupled to diffusion on the surface: convergence in time and space (nick18 §7, Figures 1
// to 5)
//
// Sample runs:  build/bin/coupled_diffusion --preset check --output coupled.json
//               build/bin/coupled_diffusion --runs convergence --bdf 2 --levels 0 --steps 1-4
//               build/bin/coupled_diffusion --runs difference --levels 0 --steps 1-3
//
// Writes:       results/paper/coupled_diffusion.{json,csv,tex}, from which plots/coupled_diffusion.py draws
//               figures/nick18/fig1 .. fig5
//
// A sphere of radius r(t) = 1 + sin(pi t)/2 carries u = exp(-t²) x1 x2 x3; f and g are chosen so that these
// solve
//   d•u + u div v - Lap u = f(u),   v - Lap v + H nu = g(u) nu   (2.7)-(2.8)
// on [0, 1]. The discretisation is (2.19)-(2.21): quadratic elements and BDF3, exact starting values, tau =
// 0.1 2^-k and h near 0.378 2^(-j/2). Errors are those at t = 1.
//
// Beside the published runs: the extrapolation as (2.18) prints it; g coupled as printed (0/0 on three
// planes) and not coupled at all; the difference between (2.19) and (7.2) for BDF 2, 3 and 4; the dynamic
// velocity law; the orders of BDF 1 to 5 against a solution of the same discretisation with small steps.
//
// Expected orders (Theorem 2.1): tau³ + h² in H1, one more in h in L2.
#include "solver/flows/coupled_diffusion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/growing_sphere.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = CoupledDiffusionState;

const double largest_h = 0.378;
const HalvedSteps time_steps{1, 0.1};
const int reference_k = 7;  ///< step size of the solution that the orders of BDF 1 to 5 are measured against

/// The kinds of runs, as --runs names them and as rows are labelled.
const std::vector<std::string> known_runs = {"convergence", "extrapolation", "quotient", "none", "difference",
                                             "cost",        "growth",        "dynamic",  "order"};

/// One run of the grid.
struct Run {
  std::string kind;
  int bdf, level, k;
};

struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> runs;
};

struct Setting {
  std::vector<Run> runs;
  int degree;
  Start start;
  std::vector<std::string> meshes;
  Quadrature rule;
};

void add_runs(const std::string& kind, const std::vector<int>& orders, const std::vector<int>& levels,
              const std::vector<int>& steps, std::vector<Run>& runs) {
  for (int bdf : orders) {
    for (int level : levels) {
      for (int k : steps) runs.push_back({kind, bdf, level, k});
    }
  }
}

std::vector<Run> preset_runs(const std::string& preset) {
  const bool paper = preset == "paper";
  std::vector<Run> runs;
  if (paper) {
    add_runs("convergence", {3}, {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4, 5}, runs);
    add_runs("difference", {3}, {0, 1, 2, 3}, {0, 1, 2, 3, 4, 5}, runs);
    add_runs("dynamic", {3}, {0, 1, 2, 3}, {1, 2, 3, 4}, runs);
    add_runs("cost", {3}, {0}, {2}, runs);
  } else {
    add_runs("convergence", {3}, {0, 1, 2, 3}, {1, 2, 3, 4}, runs);
    add_runs("difference", {3}, {0, 1}, {1, 2, 3, 4}, runs);
    add_runs("dynamic", {3}, {0, 1, 2}, {1, 2, 3, 4}, runs);
  }
  add_runs("quotient", {3}, {0, 1}, {3}, runs);
  add_runs("none", {3}, {0, 1}, {3}, runs);
  add_runs("extrapolation", {3}, {0}, {1, 2, 3, 4}, runs);
  add_runs("growth", {3}, {0}, {3}, runs);
  add_runs("difference", {2, 4}, {0, 1}, {1, 2, 3, 4}, runs);
  // Where each order shows: small errors end at round-off times the growth of f.
  add_runs("order", {1, 3}, {0}, {3, 4, 5}, runs);
  add_runs("order", {2, 4}, {0}, {2, 3, 4}, runs);
  add_runs("order", {5}, {0}, {1, 2, 3}, runs);
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.degree = options.degree.value_or(2);
  setting.start = options.start.value_or(Start{});
  setting.meshes = options.meshes;
  setting.rule = quadrature_or_default(own.quadrature, setting.degree);
  const bool as_in_the_preset =
      !options.levels && !options.steps && !options.bdf && options.meshes.empty() && own.runs.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {0});
  const std::vector<std::string> kinds =
      own.runs.empty() ? std::vector<std::string>{"convergence"} : own.runs;
  for (const std::string& kind : kinds) {
    add_runs(kind, {options.bdf.value_or(3)}, levels, options.steps.value_or(range(1, 4)), setting.runs);
  }
  return setting;
}

/// (2.19)-(2.21) with x̃ and ũ as (2.18) is printed, sum gamma_j x^{n-p+j}: backwards.
class ExtrapolationAsPrinted {
 public:
  using State = CoupledDiffusionState;

  ExtrapolationAsPrinted(const SurfaceSpace& space, const CoupledDiffusionParameters& parameters)
      : space_(space),
        problem_(parameters, CoupledDiffusionVariant::regularised),
        scheme_(space, 1, parameters, {}, {}) {}

  void step(const BdfStep<State>& step, State& next) {
    std::array<const State*, max_bdf_order> oldest_first = {};
    for (int j = 0; j < step.order; ++j) oldest_first[j] = &step.past(step.order - 1 - j);
    scheme_.extrapolate({step.t, step.tau, step.order, bdf_weights(step.order), oldest_first});
    Field loads;
    const auto f_and_g = [&](const PointData<1>& p, Integrand<4, 0>& load) {
      Pack f[1];
      problem_.f(next.t, p, f);
      load.value[0] = f[0];
      const Pack g = problem_.g(next.t, p);
      for (int i = 0; i < 3; ++i) load.value[1 + i] = g * p.normal[i];
    };
    space_.assemble_load<1, 4, 0>(scheme_.x_tilde(), scheme_.u_tilde(), f_and_g, loads);
    scheme_.advance(step, loads, next);
  }

 private:
  const SurfaceSpace& space_;
  GrowingSphereProblem problem_;
  CoupledDiffusionScheme scheme_;
};

/// The growing sphere on one mesh.
struct GrowingSphereRuns {
  const SurfaceSpace& space;
  const Field& x0;
  ExactEvolution exact = growing_sphere();

  State exact_state(double t) const { return exact_growing_sphere_state(space, exact, x0, t); }

  using Starts = std::function<State(double)>;

  /// Runs from the exact initial values and calls observe(n, state) at each step. starts: the starting values
  /// of BDF.
  template <class Observer>
  void run(const UniformSteps& grid, CoupledDiffusionVariant variant, GrowingSphereProblem::Coupling coupling,
           const Starts& starts, Observer&& observe) const {
    const CoupledDiffusionParameters parameters;
    CoupledDiffusion<GrowingSphereProblem> flow(
        space, GrowingSphereProblem(parameters, variant.law, coupling), parameters, variant);
    integrate(flow, grid, {exact_state(0), starts}, observe);
  }

  /// The state at the end with the extrapolation as printed.
  State end_of_printed(const UniformSteps& grid) const {
    ExtrapolationAsPrinted flow(space, {});
    State end;
    integrate(flow, grid, {exact_state(0), Starts([&](double t) { return exact_state(t); })},
              [&](int, const State& state) { end = state; });
    return end;
  }

  /// The state at the end.
  State end_of(const UniformSteps& grid, CoupledDiffusionVariant variant, const Starts& starts,
               GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive) const {
    State end;
    run(grid, variant, coupling, starts, [&](int n, const State& state) {
      if (n == grid.steps) end = state;
    });
    return end;
  }

  /// The same with exact starting values.
  State end_of(const UniformSteps& grid, CoupledDiffusionVariant variant,
               GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive) const {
    return end_of(
        grid, variant, [&](double t) { return exact_state(t); }, coupling);
  }
};

/// The state at the end with one of the mass matrices, and how long it took.
State timed_end_of(const GrowingSphereRuns& runs, const UniformSteps& grid,
                   CoupledDiffusionVariant::Mass mass, double& seconds) {
  CoupledDiffusionVariant variant;
  variant.mass = mass;
  const auto begin = std::chrono::steady_clock::now();
  State end = runs.end_of(grid, variant);
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return end;
}

/// (7.2) beside (2.19): the difference in u, how large it is beside the error of (2.19), how large the error
/// of (7.2) is beside that, and how much longer (7.2) takes.
void run_difference(const GrowingSphereRuns& runs, const UniformSteps& grid, Row& row) {
  double extrapolated = 0, reassembled = 0;
  const State one = timed_end_of(runs, grid, CoupledDiffusionVariant::extrapolated, extrapolated);
  const State two = timed_end_of(runs, grid, CoupledDiffusionVariant::reassembled, reassembled);
  row.values["seconds_ratio"] = reassembled / extrapolated;

  const Field u = runs.exact_state(time_steps.end_time).u;
  Field differences(u.rows(), 3);
  differences << one.u - two.u, one.u - u, two.u - u;
  LargestDifferences norms(runs.space, {{"difference", 1}, {"extrapolated", 1}, {"reassembled", 1}});
  norms.add(runs.exact.trajectories(runs.x0, time_steps.end_time), differences);
  const auto H1 = [&](const char* name) { return norms.errors().at(name).at("nodal_H1"); };
  row.errors["u_difference"] = norms.errors().at("difference");
  row.values["difference_over_error"] = H1("difference") / H1("extrapolated");
  row.values["error_ratio"] = H1("reassembled") / H1("extrapolated");
}

/// How many times as long as (2.19) a run of (7.2) takes: the median of pairs of runs.
void run_cost(const GrowingSphereRuns& runs, const UniformSteps& grid, Row& row) {
  std::vector<double> ratios;
  for (int pair = 0; pair < 5; ++pair) {
    double extrapolated = 0, reassembled = 0;
    timed_end_of(runs, grid, CoupledDiffusionVariant::extrapolated, extrapolated);
    timed_end_of(runs, grid, CoupledDiffusionVariant::reassembled, reassembled);
    ratios.push_back(reassembled / extrapolated);
  }
  std::sort(ratios.begin(), ratios.end());
  row.values["seconds_ratio"] = ratios[ratios.size() / 2];
}

/// How much a constant error of u grows until the end, relative to u: by the load f, which the manufactured
/// solution needs. exp(t²) undoes the decay of u.
void run_growth(const GrowingSphereRuns& runs, UniformSteps grid, Row& row) {
  const double excess = 1e-5;
  grid.start = parse_start("substeps:16");
  const CoupledDiffusionParameters parameters;
  const auto mean_u_from = [&](double added) {
    CoupledDiffusion<GrowingSphereProblem> flow(
        runs.space,
        GrowingSphereProblem(parameters, CoupledDiffusionVariant::regularised, GrowingSphereProblem::none),
        parameters, {});
    const State exact = runs.exact_state(0);
    State end;
    integrate(flow, grid, coupled_diffusion_state(runs.space, 0, exact.x, exact.v, exact.u.array() + added),
              [&](int, const State& state) { end = state; });
    return end.u.mean();
  };
  const double end_time = time_steps.end_time;
  row.values["growth_of_constants"] =
      (mean_u_from(excess) - mean_u_from(0)) / excess * std::exp(end_time * end_time);
}

/// Errors at the end against the solution of the same discretisation in space, by BDF5 and small steps.
void run_order(const GrowingSphereRuns& runs, const UniformSteps& grid, Row& row) {
  const UniformSteps small{5, time_steps.tau(reference_k), time_steps.count(reference_k),
                           parse_start("substeps:128")};
  const CoupledDiffusionParameters parameters;
  CoupledDiffusion<GrowingSphereProblem> flow(
      runs.space, GrowingSphereProblem(parameters, CoupledDiffusionVariant::regularised), parameters, {});
  const SmallSteps reference(flow, small, runs.exact_state(0), {}, small.steps / grid.steps);
  LargestDifferences differences(runs.space, runs.exact.quantities);
  reference.compare(grid.order, grid.tau, grid.order, [&](int n, const State& state, const State& exact) {
    if (n < grid.steps) return;
    differences.add(runs.exact.trajectories(runs.x0, time_steps.end_time), state, exact);
  });
  row.errors = differences.errors();
}

/// Errors against the exact solution at the end.
void run_convergence(const GrowingSphereRuns& runs, const std::string& kind, const UniformSteps& grid,
                     Row& row) {
  CoupledDiffusionVariant variant;
  if (kind == "dynamic") variant.law = CoupledDiffusionVariant::dynamic;
  const auto coupling = kind == "quotient" ? GrowingSphereProblem::quotient
                        : kind == "none"   ? GrowingSphereProblem::none
                                           : GrowingSphereProblem::additive;
  const State end =
      kind == "extrapolation" ? runs.end_of_printed(grid) : runs.end_of(grid, variant, coupling);
  ErrorRecorder errors(runs.space, runs.exact, runs.x0);
  errors.record(end);
  row.errors = errors.maxima();
  row.series = errors.series();
}

nlohmann::json labels(const Run& run) {
  return {{"run", run.kind}, {"bdf", run.bdf}};
}

Row run_cell(const Setting& setting, const Run& run, Row row) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = sphere(1);
  const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, run.level)); };
  const Mesh mesh = initial_mesh(setting.meshes, run.level, generate, surface, setting.degree);
  const SurfaceSpace space(mesh, setting.rule);
  describe_mesh(mesh, row);

  // 2. The time steps, and the errors at their end.
  const GrowingSphereRuns runs{space, mesh.nodes};
  const UniformSteps grid{run.bdf, row.tau, row.steps, setting.start};
  try {
    if (run.kind == "difference") {
      run_difference(runs, grid, row);
    } else if (run.kind == "cost") {
      run_cost(runs, grid, row);
    } else if (run.kind == "growth") {
      run_growth(runs, grid, row);
    } else if (run.kind == "order") {
      run_order(runs, grid, row);
    } else {
      run_convergence(runs, run.kind, grid, row);
    }
  } catch (const NumericsError& error) {
    row.status = std::string("failed: ") + error.what();
  }
  return row;
}

std::string cell_name(const Run& run) {
  const std::string kind = run.kind == "convergence" ? "" : run.kind + "_";
  return kind + format("bdf%d_h%d_tau%d", run.bdf, run.level, run.k);
}

/// Seconds on one core: a step takes about 2.5 microseconds a node.
double estimated_cost(const Setting& setting, const Run& run) {
  const double vertices = 27.5 / std::pow(edge_length(largest_h, run.level), 2);
  const double nodes = vertices * setting.degree * setting.degree;
  double steps = time_steps.count(run.k);
  if (run.kind == "difference") steps *= 2.2;
  if (run.kind == "cost") steps *= 11;
  if (run.kind == "growth") steps *= 3;
  if (run.kind == "order") steps += time_steps.count(reference_k);
  return 0.1 + vertices * 2e-4 + nodes * steps * 2.5e-6;
}

std::vector<Cell> cells(const Setting& setting) {
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back({cell_name(run), estimated_cost(setting, run),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, row); },
                    planned_row(run.level, time_steps, run.k, labels(run))});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", time_steps.end_time},
          {"alpha", 1},
          {"beta", 1},
          {"degree", setting.degree},
          {"start", to_string(setting.start)},
          {"quadrature", setting.rule.name},
          {"errors", "at the end time"},
          {"meshes", mesh_parameter(setting.meshes, "generated, edge length 0.378 2^(-level/2)")}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "coupled_diffusion";
  experiment.paper = "nick18";
  experiment.help =
      "A growing sphere that is moved by what diffuses on it (nick18 Figures 1 to 5): errors of position x, "
      "velocity v and\n"
      "u at t = 1 over step size and mesh width. Step sizes 0.1 2^-k, k = 0, 1, ..; edge lengths 0.378 "
      "2^(-j/2), level j =\n"
      "0, 1, .. No units: alpha = beta = D = 1.\n"
      "Without --runs, --bdf, --levels, --steps, --mesh: the runs of the preset. With one of them: all "
      "combinations, where\n"
      "not given convergence, BDF3, level 0, k = 1..4.\n\n"
      "Example: coupled_diffusion --runs convergence --levels 0-2 --steps 1-4 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names(
        "--runs", known_runs, own.runs,
        "convergence: (2.19) with g coupled additively | quotient: as printed | none: not coupled "
        "| extrapolation: as (2.18) prints it "
        "| difference: (7.2) minus (2.19) | cost: of (7.2) | growth: of an error in u | dynamic: dynamic "
        "velocity law | order: errors "
        "against small steps");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
