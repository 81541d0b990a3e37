// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow of a sphere: convergence in time and space (kll19 §13.1, Figures 13.1 and 13.2)
//
// Sample runs:  build/bin/mcf_sphere --preset check --output sphere.json
//               build/bin/mcf_sphere --preset check --levels 0 --steps 2-4 --bdf 2 --start substeps:16
//               build/bin/mcf_sphere --preset check --degree 3 --levels 0 --steps 3-5
//               build/bin/mcf_sphere --preset check --flow dziuk --bdf 2
//
// Writes:       results/paper/mcf_sphere.{json,csv,tex}, from which plots/mcf_sphere.py draws
//               figures/kll19/fig13_1 (error over tau) and fig13_2 (error over h)
//
// The sphere of radius R_0 = 2 shrinks by v = -H nu on [0, 0.6], R(t) = sqrt(R_0² - 4t). The discretisation
// is (5.1): quadratic evolving surface finite elements and BDF3, exact starting values, tau = 0.2 2^-k and h
// near 0.5 2^(-j/2). The same table contains Dziuk's scheme (3.6), with nu and H from kappa = M^-1 A x; and,
// with one or a few cells each, the paper's statements on starting values and on the cost of a step, Dziuk's
// scheme with BDF4, the growth of an error in |nu_h|, and the decay of the mode l = 2 of a nearly round
// sphere.
//
// Expected orders (Theorem 6.1): tau³ + h² in L^infinity(H1) for x, v, nu, H. On the sphere all four
// superconverge in space (order 3 in H1, 4 for H), and nu shows no order in time, because it is constant
// along trajectories. x and H reach order 3 in tau slowly: slopes of x between neighbouring step sizes
// are 2.3, 2.6, 2.75 from tau = 0.1 down.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/mean_curvature_flows.hpp"
#include "experiments/harness/nearly_round_runs.hpp"
#include "experiments/harness/timed.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/problems/nearly_round_sphere.hpp"
#include "solver/time/last_state.hpp"

namespace {

using namespace esfem;

const double initial_radius = 2, largest_h = 0.5;

HalvedSteps time_steps(const Choice& choice) {
  return choice["run"] == "nearly_round" ? HalvedSteps{0.1, 1e-3} : HalvedSteps{0.6, 0.2};
}

Block otherwise(bool paper) {
  return {{"run", "convergence"},
          {"flow", {"mean_curvature", "dziuk"}},
          {"degree", 2},
          {"bdf", 3},
          {"start", "exact"},
          {"level", paper ? range(0, 4) : range(0, 2)},
          {"step", paper ? range(0, 7) : range(2, 6)}};
}

/// The figures, and further runs for claims, on coarse meshes.
std::vector<Block> preset(bool paper) {
  std::vector<Block> blocks = {
      {{"flow", "mean_curvature"}},
      // Without the most expensive mesh: it shows nothing that the others do not.
      {{"flow", "dziuk"}, {"level", paper ? range(0, 3) : range(0, 2)}},
      {{"flow", "dziuk"}, {"bdf", 4}, {"level", 0}, {"step", paper ? range(4, 5) : range(4, 4)}},
      {{"flow", "mean_curvature"}, {"start", "cascade"}, {"level", 0}, {"step", {1, 2, 3}}},
      {{"flow", "mean_curvature"},
       {"start", "substeps:16"},
       {"level", 0},
       {"step", paper ? range(2, 3) : range(2, 2)}},
      {{"run", "disturbed_normal"},
       {"flow", "mean_curvature"},
       {"bdf", 2},
       {"start", "substeps:16"},
       {"level", 0},
       {"step", 3}},
      {{"run", "nearly_round"}, {"flow", "mean_curvature"}, {"level", 0}, {"step", 0}}};
  if (!paper) return blocks;
  blocks.push_back({{"run", "cost"}, {"flow", "mean_curvature"}, {"level", 0}, {"step", 2}});
  blocks.push_back(
      {{"flow", "mean_curvature"}, {"bdf", 5}, {"start", "cascade"}, {"level", 0}, {"step", {1, 2, 3}}});
  return blocks;
}

/// How much an error in the length of nu_h grows until the end: |nu_h| of a run whose initial normals are a
/// little too long, compared with a run where they are not.
double growth_of_length(const SurfaceSpace& space, const UniformSteps& grid,
                        const MeanCurvatureFlow::State& initial) {
  const double excess = 1e-4;
  MeanCurvatureFlow::State disturbed = initial;
  disturbed.u.leftCols(3) *= 1 + excess;
  const auto length_at_end = [&](const MeanCurvatureFlow::State& start) {
    MeanCurvatureFlow flow(space, {});
    return last_state(flow, grid, start).u.leftCols(3).rowwise().norm().mean();
  };
  return (length_at_end(disturbed) - length_at_end(initial)) / excess;
}

/// Run time of (5.1) relative to Dziuk's scheme.
double cost_ratio(const SurfaceSpace& space, const UniformSteps& grid, const ExactEvolution& exact,
                  const Field& x0) {
  const auto seconds = [&](const std::string& name) {
    double seconds = 0;
    with_mean_curvature_flow(name, space, exact, x0, [&](auto flow, const auto& exact_state) {
      seconds = seconds_of([&] { last_state(flow, grid, {exact_state(0.0), exact_state}); });
    });
    return seconds;
  };
  return median_seconds_ratio([&] { return seconds("dziuk"); }, [&] { return seconds("mean_curvature"); });
}

/// The largest distance in a node between nu_h and the normal of Gamma_h[x].
double distance_of_normals(const SurfaceSpace& space, const MeanCurvatureFlow::State& state) {
  DiscreteCurvature curvature(space);
  curvature.compute(state.x);
  return (state.u.leftCols(3) - curvature.nu()).rowwise().norm().maxCoeff();
}

/// Errors of each step, and how far nu_h is from the surface at the end.
void measure_errors(const Choice& choice, const SurfaceSpace& space, const UniformSteps& steps,
                    const Field& x0, const ExactEvolution& exact, Row& row) {
  ErrorRecorder errors(space, exact, x0);
  if (choice["flow"] == "dziuk") warn(dziuk_warning(steps.order));
  with_mean_curvature_flow(choice["flow"], space, exact, x0, [&](auto flow, const auto& exact_state) {
    integrate(flow, steps, {exact_state(0.0), exact_state}, errors, [&](int n, const auto& state) {
      if constexpr (std::is_same_v<std::decay_t<decltype(state)>, MeanCurvatureFlow::State>)
        if (n == steps.steps) row.values["distance_of_normals"] = distance_of_normals(space, state);
    });
  });
  row.errors = errors.maxima();
  row.series = errors.series();
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The initial surface and the finite element space on it.
  const bool nearly_round = choice["run"] == "nearly_round";
  const Surface surface = nearly_round ? nearly_round_sphere() : sphere(initial_radius);
  const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, choice.level())); };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The exact solution: starting values and what the errors are measured against.
  const ExactEvolution exact = shrinking_sphere(initial_radius);

  // 3. The time steps, and what is measured of them.
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  if (nearly_round)
    measure_mean_curvature_decay(space, mesh.nodes, steps, row);
  else if (choice["run"] == "disturbed_normal")
    row.values["growth_of_length"] =
        growth_of_length(space, steps, exact_mean_curvature_state(exact, mesh.nodes, 0));
  else if (choice["run"] == "cost")
    row.values["seconds_ratio"] = cost_ratio(space, steps, exact, mesh.nodes);
  else
    measure_errors(choice, space, steps, mesh.nodes, exact, row);
}

/// A step with its errors takes about 9 microseconds a P2 node, a mesh about 0.2 ms a vertex.
double cost(const Choice& choice) {
  const double vertices = 110.0 / std::pow(edge_length(largest_h, choice.level()), 2);
  const double nodes = vertices * choice.degree() * choice.degree();
  return vertices * 2e-4 + nodes * time_steps(choice).count(choice.step()) * 9e-6;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("mcf_sphere", "kll19", run, otherwise, preset);
  experiment.help =
      "Mean curvature flow of the sphere of radius 2 on [0, 0.6]: errors of position x, velocity v, normal\n"
      "nu and mean curvature H over step size and mesh width (kll19 Figures 13.1, 13.2). Step sizes\n"
      "0.2 2^-k, k = 0..7; edge lengths 0.5 2^(-j/2), level j = 0..4. v = -H nu has no units.\n\n"
      "Example: mcf_sphere --preset check --levels 0 --steps 2-4 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"convergence", "disturbed_normal", "nearly_round", "cost"},
       "convergence: errors | disturbed_normal: growth of an error in |nu_h| | nearly_round: decay of the "
       "mode l = 2, on [0, 0.1] | cost: run time of (5.1) relative to Dziuk's scheme"},
      {"flow", {"mean_curvature", "dziuk"}, "mean_curvature: kll19 (5.1) | dziuk: kll19 (3.6)"}};
  experiment.grid.labels = {"run", "flow", "bdf", "start"};
  experiment.grid.implied = [](const Choice& choice) {
    return choice["run"] == "nearly_round" && choice["start"] == "exact" ? Block{{"start", "substeps:16"}}
                                                                         : Block();
  };
  experiment.grid.admits = [](const Choice& choice) {
    return choice["run"] == "convergence" || choice["flow"] == "mean_curvature";
  };
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.parameters = {{"initial_radius", initial_radius}, {"end_time", 0.6}};
  experiment.meshes = "generated, edge length 0.5 2^(-level/2)";
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
