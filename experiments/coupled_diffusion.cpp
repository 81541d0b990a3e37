// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surface evolution coupled to diffusion on the surface: convergence in time and space (nick18 §7, Figures 1
// to 5)
//
// Sample runs:  build/bin/coupled_diffusion --preset check --output coupled.json
//               build/bin/coupled_diffusion --run convergence --bdf 2 --levels 0 --steps 1-4
//               build/bin/coupled_diffusion --run difference --levels 0 --steps 1-3
//
// Writes:       results/paper/coupled_diffusion.{json,csv,tex}, from which plots/coupled_diffusion.py draws
//               figures/nick18/fig1 .. fig5
//
// A sphere of radius r(t) = 1 + sin(pi t)/2 carries u = exp(-t²) x1 x2 x3; f and g are chosen
// so that these solve
//   d•u + u div v - Lap u = f(u),   v - Lap v + H nu = g(u) nu   (2.7)-(2.8)
// on [0, 1]. The discretisation is (2.19)-(2.21): quadratic elements and BDF3, exact starting values, tau =
// 0.1 2^-k and h near 0.378 2^(-j/2). Errors are those at t = 1.
//
// Beside the published runs: the extrapolation as (2.18) prints it; g coupled as printed (0/0 on three
// planes) and not coupled at all; the difference between (2.19) and (7.2) for BDF 2, 3 and 4; the dynamic
// velocity law; the orders of BDF 1 to 5 against a solution of the same discretisation with small steps.
//
// Expected orders (Theorem 2.1): tau³ + h² in H1, one more in h in L2.
#include <cmath>
#include <map>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/growing_sphere_runs.hpp"
#include "experiments/harness/small_steps.hpp"
#include "experiments/harness/timed.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = CoupledDiffusionState;
using Problem = GrowingSphereProblem;
using Variant = CoupledDiffusionVariant;

const double largest_h = 0.378;
const HalvedSteps time_steps{1, 0.1};
const int reference_k = 7;  ///< step size of the solution that the orders of BDF 1 to 5 are measured against

Block otherwise(bool) {
  return {{"run", "convergence"}, {"degree", 2}, {"bdf", 3},
          {"start", "exact"},     {"level", 0},  {"step", range(1, 4)}};
}

std::vector<Block> preset(bool paper) {
  const std::vector<int> steps = paper ? range(0, 5) : range(1, 4);
  std::vector<Block> blocks = {{{"run", {"quotient", "none"}}, {"level", {0, 1}}, {"step", 3}},
                               {{"run", "extrapolation"}},
                               {{"run", "growth"}, {"step", 3}},
                               {{"run", "difference"}, {"bdf", {2, 4}}, {"level", {0, 1}}},
                               // Where each order shows: small errors end at round-off times the growth of f.
                               {{"run", "order"}, {"bdf", {1, 3}}, {"step", {3, 4, 5}}},
                               {{"run", "order"}, {"bdf", 2}, {"step", {2, 3, 4}}},
                               {{"run", "order"}, {"bdf", {4, 5}}, {"step", {1, 2, 3, 4}}},
                               {{"run", "convergence"}, {"level", range(0, paper ? 4 : 3)}, {"step", steps}},
                               {{"run", "difference"}, {"level", range(0, paper ? 3 : 1)}, {"step", steps}},
                               {{"run", "dynamic"}, {"level", range(0, paper ? 3 : 2)}}};
  if (paper) blocks.push_back({{"run", "cost"}, {"step", 2}});
  return blocks;
}

/// (7.2) compared with (2.19): the difference in u, its ratio to the error of (2.19), the ratio of the error
/// of (7.2) to that, and the run time of (7.2) relative to (2.19).
void measure_difference(const GrowingSphereRuns& on, Row& row) {
  State one, two;
  const double extrapolated = seconds_of([&] { one = on.end_of(with_mass(Variant::extrapolated)); });
  const double reassembled = seconds_of([&] { two = on.end_of(with_mass(Variant::reassembled)); });
  row.values["seconds_ratio"] = reassembled / extrapolated;
  const Field u = on.exact_state(time_steps.end_time).u;
  Field differences(u.rows(), 3);
  differences << one.u - two.u, one.u - u, two.u - u;
  LargestDifferences norms(on.space, {{"difference", 1}, {"extrapolated", 1}, {"reassembled", 1}});
  norms.add(on.exact.trajectories(on.x0, time_steps.end_time), differences);
  const auto H1 = [&](const char* name) { return norms.errors().at(name).at("nodal_H1"); };
  row.errors["u_difference"] = norms.errors().at("difference");
  row.values["difference_over_error"] = H1("difference") / H1("extrapolated");
  row.values["error_ratio"] = H1("reassembled") / H1("extrapolated");
}

/// Run time of (7.2) relative to (2.19).
void measure_cost(const GrowingSphereRuns& on, Row& row) {
  const auto seconds = [&](Variant::Mass mass) { return seconds_of([&] { on.end_of(with_mass(mass)); }); };
  row.values["seconds_ratio"] = median_seconds_ratio([&] { return seconds(Variant::extrapolated); },
                                                     [&] { return seconds(Variant::reassembled); });
}

/// How much a constant error of u grows until the end, relative to u: by the load f, which the manufactured
/// solution needs. exp(t²) undoes the decay of u.
void measure_growth(const GrowingSphereRuns& on, Row& row) {
  const double excess = 1e-5, end_time = time_steps.end_time;
  UniformSteps steps = on.steps;
  steps.start = parse_start("substeps:16");
  const auto mean_u_from = [&](double added) {
    auto flow = growing_sphere_flow(on.space, {}, Problem::none);
    const State exact = on.exact_state(0);
    const State start = coupled_diffusion_state(on.space, 0, exact.x, exact.v, exact.u.array() + added);
    return last_state(flow, steps, start).u.mean();
  };
  row.values["growth_of_constants"] =
      (mean_u_from(excess) - mean_u_from(0)) / excess * std::exp(end_time * end_time);
}

/// Errors at the end against the solution of the same discretisation in space, by BDF5 and small steps.
void measure_order(const GrowingSphereRuns& on, Row& row) {
  const UniformSteps small{5, time_steps.tau(reference_k), time_steps.count(reference_k),
                           parse_start("substeps:128")};
  const UniformSteps& steps = on.steps;
  auto flow = growing_sphere_flow(on.space, {});
  const SmallSteps reference(flow, small, on.exact_state(0), {}, small.steps / steps.steps);
  LargestDifferences differences(on.space, on.exact.quantities);
  reference.compare(steps.order, steps.tau, steps.order, [&](int n, const State& state, const State& exact) {
    if (n == steps.steps) differences.add(on.exact.trajectories(on.x0, time_steps.end_time), state, exact);
  });
  row.errors = differences.errors();
}

/// The state at the end of one of the runs that are compared with the exact solution.
State end_of(const std::string& run, const GrowingSphereRuns& on) {
  if (run == "convergence") return on.end_of({});
  if (run == "quotient") return on.end_of({}, Problem::quotient);
  if (run == "none") return on.end_of({}, Problem::none);
  if (run == "dynamic") return on.end_of(with_law(Variant::dynamic));
  if (run != "extrapolation") throw std::logic_error("no run is called " + run);
  ExtrapolationAsPrinted flow(on.space, {});
  return last_state(flow, on.steps, on.start());
}

/// Errors against the exact solution at the end.
void measure_errors(const std::string& run, const GrowingSphereRuns& on, Row& row) {
  ErrorRecorder errors(on.space, on.exact, on.x0);
  errors.record(end_of(run, on));
  row.errors = errors.maxima();
  row.series = errors.series();
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it.
  const auto generate = [&] { return generate_mesh(sphere(1), edge_length(largest_h, choice.level())); };
  const Mesh mesh = initial_mesh(choice, generate, sphere(1));
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The time steps, and what is measured at their end.
  const GrowingSphereRuns on{space, mesh.nodes, {choice.bdf(), row.tau, row.steps, choice.start()}};
  static const std::map<std::string, void (*)(const GrowingSphereRuns&, Row&)> measures = {
      {"difference", measure_difference},
      {"cost", measure_cost},
      {"growth", measure_growth},
      {"order", measure_order}};
  const auto found = measures.find(choice["run"]);
  if (found != measures.end()) return found->second(on, row);
  measure_errors(choice["run"], on, row);
}

/// A step takes about 2.5 microseconds a node.
double cost(const Choice& choice) {
  const std::string& run = choice["run"];
  const double times_as_many = run == "difference" ? 2.2 : run == "cost" ? 11 : run == "growth" ? 3 : 1;
  const double vertices = 27.5 / std::pow(edge_length(largest_h, choice.level()), 2);
  const double nodes = vertices * choice.degree() * choice.degree();
  double steps = time_steps.count(choice.step()) * times_as_many;
  if (run == "order") steps += time_steps.count(reference_k);
  return 0.1 + vertices * 2e-4 + nodes * steps * 2.5e-6;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("coupled_diffusion", "nick18", run, otherwise, preset);
  experiment.help =
      "A growing sphere whose velocity is coupled to diffusion on it (nick18 Figures 1 to 5): errors of "
      "position x, velocity v and\nu at t = 1 over step size and mesh width. Step sizes 0.1 2^-k, k = 0, 1, "
      "..; edge "
      "lengths 0.378 2^(-j/2), level j =\n0, 1, .. No units: alpha = beta = D = 1.\n\n"
      "Example: coupled_diffusion --levels 0-2 --steps 1-4 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"convergence", "extrapolation", "quotient", "none", "difference", "cost", "growth", "dynamic",
        "order"},
       "convergence: (2.19) with g coupled additively | quotient: as printed | none: not coupled | "
       "extrapolation: as (2.18) prints it | difference: (7.2) minus (2.19) | cost: run time of (7.2) | "
       "growth: of an error in u | dynamic: dynamic velocity law | order: errors against small steps"}};
  experiment.grid.labels = {"run", "bdf"};
  experiment.comparisons = {{{{"run", "convergence"}}, "_over_additive", {"x_nodal_L2"}},
                            {nlohmann::json::object(), "_over_larger_tau", {"u_lifted_H1_semi"}, 0, 2}};
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = cost;
  experiment.known_end = [](const Choice& choice) {
    return choice["run"] == "quotient" ? "the quotient of nick18 7.3 is 0/0 on three planes" : "";
  };
  experiment.parameters = {
      {"end_time", time_steps.end_time}, {"alpha", 1}, {"beta", 1}, {"errors", "at the end time"}};
  experiment.meshes = "generated, edge length 0.378 2^(-level/2)";
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
