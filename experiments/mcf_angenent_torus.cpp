// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of the self-shrinking torus: convergence in time and space to an exact solution that is
// not a sphere
//
// Sample runs:  build/bin/mcf_angenent_torus --preset check --output torus.json
//               build/bin/mcf_angenent_torus --flow mean_curvature --degree 3 --levels 0-1 --steps 2
//               build/bin/mcf_angenent_torus --run order --bdf 2 --steps 2-4
//
// Writes:       results/paper/mcf_angenent_torus.{json,csv,tex}, from which plots/mcf_angenent_torus.py draws
//               figures/gallery/mcf_angenent_torus
//
// Angenent's torus shrinks by v = -H nu to sqrt(1 - t) times itself; here on [0, 0.2]. Its profile comes from
// an ordinary differential equation, its particles slide along it (surfaces/angenent_torus.hpp). (5.1) of
// kll19 and Dziuk's scheme (3.6), with nu and H from kappa = M^-1 A x, take exact starting values, quadratic
// and cubic elements, tau = 0.02 2^-k, on grids that are uniform in arclength and angle, and on unstructured
// meshes.
//
// Runs "order" measure BDF 1 to 5 on [0.1, 0.2] against the same discretisation with a quarter of the step
// size, because the error in space hides that in time.
//
// Expected orders (kll19 Theorem 6.1): tau^q + h^k in L^infinity(H1) for x, v, nu, H, one more in h in L2. On
// the sphere all four superconverge in space, and nu has no error in time; here these orders are
// observed.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/mean_curvature_flows.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace {

using namespace esfem;

const HalvedSteps time_steps{0.2, 0.02};
const HalvedSteps order_steps{0.1, 0.02};  ///< of the runs "order", on [0.1, 0.2]
const int finer_by = 2;                    ///< the solutions they are measured against have tau 2^-finer_by
const std::vector<int> profile_cells = {12, 18, 24, 36, 48};  ///< of the grid, twice as many around the axis
const double largest_h = 0.66;  ///< of the coarsest unstructured mesh, at the outer equator

Block otherwise(bool) {
  return {{"run", "convergence"},
          {"flow", {"mean_curvature", "dziuk"}},
          {"triangulation", "grid"},
          {"degree", 2},
          {"bdf", 3},
          {"start", "exact"},
          {"level", 0},
          {"step", range(1, 4)}};
}

std::vector<Block> preset(bool paper) {
  const char *kll = "mean_curvature", *dziuk = "dziuk";
  if (!paper)
    return {{{"flow", kll}, {"level", range(0, 3)}, {"step", 2}},
            {{"flow", dziuk}, {"bdf", 2}, {"level", range(0, 2)}, {"step", 2}},
            {{"run", "order"}, {"flow", kll}, {"bdf", {1, 3, 5}}}};
  return {
      {{"flow", kll}, {"level", 3}, {"step", 3}},
      {{"flow", kll}, {"level", range(0, 2)}, {"step", {2, 3}}},
      {{"flow", kll}, {"triangulation", "unstructured"}, {"level", range(0, 3)}, {"step", 3}},
      {{"flow", dziuk}, {"bdf", 2}, {"level", range(0, 3)}, {"step", 3}},
      {{"flow", dziuk}, {"bdf", {1, 3}}, {"level", range(0, 2)}, {"step", 3}},
      {{"flow", dziuk}, {"bdf", 2}, {"triangulation", "unstructured"}, {"level", range(0, 1)}, {"step", 3}},
      {{"flow", kll}, {"degree", 3}, {"level", range(0, 3)}, {"step", 2}},
      {{"flow", dziuk}, {"degree", 3}, {"bdf", 2}, {"level", range(0, 2)}, {"step", 2}},
      {{"run", "order"}, {"flow", kll}, {"bdf", range(1, 5)}},
      {{"run", "order"}, {"flow", dziuk}, {"bdf", range(1, 5)}, {"step", range(2, 4)}},
      {{"run", "order"}, {"flow", kll}, {"degree", 3}, {"bdf", range(1, 5)}}};
}

Mesh generated(const Choice& choice) {
  if (choice["triangulation"] == "unstructured")
    return generate_mesh(angenent_torus(),
                         angenent_torus_edge_length(edge_length(largest_h, choice.level())));
  require_levels({choice.level()}, static_cast<int>(profile_cells.size()), "meshes");
  const int n = profile_cells[choice.level()];
  return angenent_torus_grid(2 * n, n);
}

/// Errors against the exact solution, over all steps.
template <class Flow, class ExactState>
void measure_convergence(const SurfaceSpace& space, const ExactEvolution& exact, const Field& x0, Flow& flow,
                         const ExactState& exact_state, const UniformSteps& steps, Row& row) {
  ErrorRecorder errors(space, exact, x0);
  integrate(flow, steps, {exact_state(0.0), exact_state}, errors);
  row.errors = errors.maxima();
  row.series = errors.series();
}

/// Errors at the end against the same discretisation in space with small steps. It gives the starting values
/// at t = 0.1, too: by then the fast modes that interpolated exact values contain have decayed.
template <class Flow, class State>
void measure_order(const SurfaceSpace& space, const ExactEvolution& exact, Flow& flow, const State& start,
                   const UniformSteps& steps, Row& row) {
  const int ratio = 1 << finer_by, last = static_cast<int>(std::lround(time_steps.end_time / steps.tau));
  const int reference_bdf = std::is_same_v<Flow, DziukFlow> ? 3 : 5;  // Dziuk's scheme: stable up to 3
  const UniformSteps small{reference_bdf, steps.tau / ratio, ratio * last, parse_start("substeps:16")};
  const SmallSteps<Flow> solution(flow, small, start, {}, ratio);
  LargestDifferences differences(space, exact.quantities);
  solution.compare(steps.order, steps.tau, last - steps.steps + steps.order,
                   [&](int n, const State& state, const State& exactly) {
                     if (n == last) differences.add(exactly.x, state, exactly);
                   });
  row.errors = differences.errors();
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it.
  const Mesh mesh = initial_mesh(
      choice, [&] { return generated(choice); }, angenent_torus());
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The time steps, with the errors of each or at the end.
  const ExactEvolution exact = shrinking_angenent_torus();
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  with_mean_curvature_flow(choice["flow"], space, exact, mesh.nodes, [&](auto flow, const auto& exact_state) {
    if (choice["run"] == "order")
      measure_order(space, exact, flow, exact_state(0.0), steps, row);
    else
      measure_convergence(space, exact, mesh.nodes, flow, exact_state, steps, row);
  });
}

/// About 5 microseconds a step and node, 8 more for the errors.
double cost(const Choice& choice) {
  const double cells = profile_cells[std::min<std::size_t>(choice.level(), profile_cells.size() - 1)];
  const double nodes = 2 * cells * cells * choice.degree() * choice.degree();
  if (choice["run"] == "order")
    return nodes * 5e-6 * (order_steps.count(choice.step()) + time_steps.count(choice.step() + finer_by));
  return nodes * 13e-6 * time_steps.count(choice.step());
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("mcf_angenent_torus", "esfem", run, otherwise, preset);
  experiment.help =
      "Mean curvature flow of the self-shrinking torus of Angenent on [0, 0.2]: errors of position x,\n"
      "velocity v, normal nu and mean curvature H over step size and mesh width. Step sizes 0.02 2^-k,\n"
      "k = 0, 1, ..; level j = 0, .., 4: grids of 2n x n cells, n = 12, 18, 24, 36, 48, or unstructured\n"
      "meshes. Lengths and times have no units: v = -H nu.\n\n"
      "Example: mcf_angenent_torus --flow mean_curvature --levels 0-2 --steps 3 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"convergence", "order"},
       "convergence: errors against the exact solution | order: at the end, against small steps"},
      {"flow", {"mean_curvature", "dziuk"}, "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6)"},
      {"triangulation", {"grid", "unstructured"}, "grid: uniform in arclength and angle | unstructured"}};
  experiment.grid.labels = {"run", "flow", "triangulation", "degree", "bdf"};
  experiment.comparisons = {{{{"flow", "mean_curvature"}, {"bdf", 3}}, "_over_kll19", {"x_lifted_L2"}}};
  experiment.steps = [](const Choice& choice) { return choice["run"] == "order" ? order_steps : time_steps; };
  experiment.cost = cost;
  experiment.known_end = [](const Choice& choice) {
    return choice["flow"] == "dziuk" && choice.bdf() >= 4 ? "Dziuk's scheme is unstable with BDF4 and BDF5"
                                                          : "";
  };
  experiment.parameters = {{"end_time", time_steps.end_time}};
  experiment.meshes =
      "grid: 2n x n cells, n = 12, 18, 24, 36, 48; unstructured: edges 0.33 to 0.66 times 2^(-level/2)";
  return run_experiment(experiment, argc, argv);
}
