// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cahn-Hilliard equation on an evolving ellipsoid: convergence in space and time (bk22 §9.1, Figures 2 to 5)
//
// Sample runs:  build/bin/cahn_hilliard_ellipsoid --preset check --output ellipsoid.json
//               build/bin/cahn_hilliard_ellipsoid --bdf 3 --levels 0-2 --steps 2-4
//               build/bin/cahn_hilliard_ellipsoid --run interpolation --degree 2 --levels 0,1 --steps 4
//
// Writes:       results/paper/cahn_hilliard_ellipsoid.{json,csv,tex}, from which
//               plots/cahn_hilliard_ellipsoid.py draws figures/bk22/fig2 .. fig5
//
// The unit sphere moves as {x1²/a(t) + x2² + x3² = 1}, a(t) = 1 + sin(2 pi t)/4, by its normal velocity;
// u = exp(-6t) x1 x2 and the w that belongs to it solve
//   d•u + u div v - Lap w = b,   w + epsilon Lap u = (u³ - u)/epsilon   (9.1)
// on [0, 1] with epsilon = 1/2. The discretisation is (8.3) as corrected in cahn_hilliard.hpp: linear
// elements, BDF1 and BDF3, tau = 0.2 2^-i, i = 1, .., 7, and h halved from mesh to mesh; nodes move by the
// Runge-Kutta method of order 4 with the smallest tau.
//
// The analysis (§3.6, Theorem 4.1) starts from Ritz maps, with the correction theta (3.13) in the second
// equation: the runs ritz_theta, of which the errors are maxima over all n >= 0. The text of §9 starts from
// nodal interpolations and does not mention theta: the runs interpolation, where w(0) has to come from the
// second equation and does not converge; their errors are maxima over n >= q. All runs have the errors at
// the start separately, as u_initial and w_initial.
//
// Beside the published runs: BDF 2, 4 and 5; quadratic elements; the orders of BDF 1 to 5 against a solution
// of the same discretisation with small steps; the errors of d•u that Theorem 4.1 bounds, in L2 over time;
// (8.3) as it is printed, with a load that is not multiplied by tau.
//
// Expected orders (Theorem 4.1 and the BDF methods): tau^q + h^k in H1, one more in h in L2. The nodal H1
// errors, of the difference to the interpolated solution, are better than O(h): those of w least, because
// maxima over n >= 0 contain how far Ritz maps are from interpolations. BDF5 amplifies the difference
// of Ritz maps as starting values from the discrete solution (w 0.030 at tau = 0.025 on 2,491 nodes; BDF4
// 0.004).
#include <cmath>
#include <deque>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/moving_mesh.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace {

using namespace esfem;
using State = CahnHilliardState;
using Flow = EllipsoidCahnHilliard;

const double epsilon = 0.5;
const double largest_h = 0.84;  ///< 40, 160, 636, 2491, 9994 vertices on the levels 0 to 4
const HalvedSteps time_steps{1, 0.2};
const int smallest_step = 7;  ///< the i of the smallest published tau
/// When the runs of the kind "order" begin: by then the discrete solution no longer shows that its initial
/// values are only close to a smooth one.
const double orders_begin = 0.4;

Block otherwise(bool) {
  return {{"run", "ritz_theta"}, {"degree", 1}, {"bdf", 3},
          {"start", "exact"},    {"level", 1},  {"step", range(2, 5)}};
}

std::vector<Block> preset(bool paper) {
  const int coarse = paper ? 1 : 0;
  std::vector<Block> blocks = {
      {{"degree", 2}, {"bdf", 4}, {"level", range(0, 2)}, {"step", 4}},
      {{"run", "interpolation"}, {"level", range(0, 3)}, {"step", paper ? range(1, 5) : range(4, 4)}},
      {{"run", "order"}, {"bdf", 1}, {"level", coarse}, {"step", range(4, 7)}},
      {{"run", "order"}, {"bdf", range(2, 5)}, {"level", coarse}, {"step", range(3, 6)}},
      {{"run", "derivative"}, {"level", range(1, 3)}, {"step", 3}},
      {{"run", "printed"}, {"bdf", 1}, {"step", range(3, 6)}}};
  if (paper) {
    blocks.push_back({{"bdf", {1, 3}}, {"level", range(0, 4)}, {"step", range(1, smallest_step)}});
    blocks.push_back({{"run", "interpolation"}, {"bdf", 1}, {"level", range(0, 3)}, {"step", range(1, 5)}});
    blocks.push_back({{"bdf", {2, 4, 5}}, {"level", range(0, 3)}});
  } else {
    blocks.push_back({{"bdf", 1}, {"level", range(1, 3)}, {"step", range(3, 5)}});
    blocks.push_back({{"level", range(1, 3)}, {"step", range(2, 4)}});
  }
  return blocks;
}

bool finds_starting_values(const Choice& choice) {
  if (choice["run"] == "order")
    require_starting_values(choice.step(), choice.bdf(), time_steps.tau(choice.step()), orders_begin);
  return true;
}

MovingMesh& mesh_of(const Choice& choice, MovingMeshes& meshes) {
  const int smallest = std::max(smallest_step, choice.step());
  std::optional<MovingMesh>& shared = meshes[{choice.level(), choice.degree(), smallest}];
  if (!shared) {
    const Surface surface = sphere(1);
    const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, 2 * choice.level())); };
    shared.emplace(epsilon, initial_mesh(choice, generate, surface), choice.quadrature(),
                   time_steps.tau(smallest), choice.start().substeps_per_step);
  }
  return *shared;
}

/// Errors of d•u from Ritz maps with theta, where the backward differences of u stand for the derivative
/// along the nodes: in L2 over [q tau, 1], the integrals as sums over the steps.
void measure_derivative(MovingMesh& on, const UniformSteps& steps, Row& row) {
  const auto starts = exact_starts(on, StartValues::ritz);
  const State start = starts(0);
  Flow flow = cahn_hilliard_flow(on, cahn_hilliard_theta(on.space, DoubleWell(), epsilon, start));
  const ExactEvolution exact = exact_derivative(on);
  const std::vector<double> delta = bdf_delta(steps.order);
  std::deque<Field> newest;  // first, of q + 1 steps
  double L2 = 0, H1_semi = 0;
  integrate(flow, steps, {start, starts}, [&](int n, const State& state) {
    newest.push_front(state.u);
    if (n < steps.order) return;
    newest.resize(steps.order + 1);
    Field derivative = Field::Zero(state.u.rows(), 1);
    for (int j = 0; j <= steps.order; ++j) derivative += delta[j] / steps.tau * newest[j];
    const SquaredNorms norms = lifted_errors(on.space, state.x, exact, state.t, derivative);
    L2 += steps.tau * norms.L2[0];
    H1_semi += steps.tau * norms.H1_semi[0];
  });
  row.errors["u_derivative"] = {{"lifted_L2", std::sqrt(L2)},
                                {"lifted_H1", std::sqrt(L2 + H1_semi)},
                                {"lifted_H1_semi", std::sqrt(H1_semi)}};
}

/// Errors against the exact solution: maxima over n >= 0, or n >= q from interpolated starting values. As
/// printed the first line of (8.3) has f where it should have tau f: the load is too large by 1/tau.
void measure_errors(MovingMesh& on, const std::string& run, const UniformSteps& steps, Row& row) {
  const bool ritz = run != "interpolation";
  const auto starts = exact_starts(on, ritz ? StartValues::ritz : StartValues::interpolation);
  const State start = starts(0);
  Flow flow =
      cahn_hilliard_flow(on, ritz ? cahn_hilliard_theta(on.space, DoubleWell(), epsilon, start) : Field(),
                         run == "printed" ? 1 / steps.tau : 1);

  const ExactEvolution exact = exact_evolution(on.exact, on.nodes);
  ErrorRecorder errors(on.space, exact, on.mesh.nodes), initial_errors(on.space, exact, on.mesh.nodes);
  initial_errors.record(start);
  const int first = ritz ? 0 : steps.order;
  integrate(flow, steps, {start, starts}, [&](int n, const State& state) {
    if (n >= first) errors.record(state);
  });
  row.errors = errors.maxima();
  for (const auto& [quantity, norms] : initial_errors.maxima()) row.errors[quantity + "_initial"] = norms;
  row.series = errors.series();
}

/// Errors from orders_begin on against the solution of the same discretisation in space, by BDF5 and small
/// steps.
void measure_order(MovingMesh& on, const UniformSteps& steps, Row& row) {
  const UniformSteps small{
      5, on.smallest_tau, static_cast<int>(std::lround(time_steps.end_time / on.smallest_tau)), {}};
  const auto starts = exact_starts(on, StartValues::ritz);
  const State start = starts(0);
  Flow flow = cahn_hilliard_flow(on, cahn_hilliard_theta(on.space, DoubleWell(), epsilon, start));
  const SmallSteps reference(flow, small, start, starts, small.steps / steps.steps);

  LargestDifferences differences(on.space, {{"u", 1}, {"w", 1}});
  const int first = static_cast<int>(std::lround(orders_begin / steps.tau));
  reference.compare(steps.order, steps.tau, first, [&](int, const State& state, const State& exact) {
    differences.add(state.x, state, exact);
  });
  row.errors = differences.errors();
}

void run(const Choice& choice, Row& row, MovingMeshes& meshes) {
  MovingMesh& on = mesh_of(choice, meshes);
  describe_mesh(on.mesh, row);
  const UniformSteps steps{choice.bdf(), row.tau, row.steps, choice.start()};
  if (choice["run"] == "order")
    measure_order(on, steps, row);
  else if (choice["run"] == "derivative")
    measure_derivative(on, steps, row);
  else
    measure_errors(on, choice["run"], steps, row);
}

/// A step with its errors takes about 12 microseconds a P1 node and 8 a P2 node, without errors 5; a mesh
/// with its trajectories takes 0.1 ms a vertex.
double cost(const Choice& choice) {
  const double vertices = 27.5 / std::pow(edge_length(largest_h, 2 * choice.level()), 2);
  const double nodes = vertices * choice.degree() * choice.degree();
  const double steps = time_steps.count(choice.step());
  const double microseconds = choice["run"] == "order" ? 5 * (steps + time_steps.count(smallest_step))
                                                       : (choice.degree() == 1 ? 12 : 8) * steps;
  return 0.02 + 1e-4 * vertices + 1e-6 * nodes * microseconds;
}

}  // namespace

int main(int argc, char** argv) {
  MovingMeshes meshes;
  const auto run_on_meshes = [&](const Choice& choice, Row& row, const std::string&) {
    run(choice, row, meshes);
  };
  Experiment experiment("cahn_hilliard_ellipsoid", "bk22", run_on_meshes, otherwise, preset);
  experiment.help =
      "The Cahn-Hilliard equation on an evolving ellipsoid (bk22 Figures 2 to 5): errors of u and w over "
      "step size and mesh\n"
      "width, maxima over time. Step sizes 0.2 2^-i, i = 1, 2, ..; edge lengths 0.84 2^-j, level j = 0, 1, "
      ".. No units:\n"
      "epsilon = 1/2.\n\n"
      "Example: cahn_hilliard_ellipsoid --bdf 3 --levels 0-2 --steps 2-4 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"ritz_theta", "interpolation", "order", "derivative", "printed"},
       "ritz_theta: Ritz maps and theta | interpolation: interpolated u, no theta | order: errors against "
       "small steps | derivative: errors of d•u | printed: (8.3) without tau before its load"}};
  experiment.grid.labels = {"run", "bdf", "degree"};
  experiment.grid.admits = finds_starting_values;
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = cost;
  experiment.parameters = {
      {"end_time", time_steps.end_time},
      {"epsilon", epsilon},
      {"tau_of_the_nodes", "0.2 2^-7, or the step size if that is smaller; with substeps:K a K-th of it"},
      {"errors", "maxima over n >= 0; interpolation: over n >= q; u_derivative: L2 over time, n >= q"}};
  experiment.meshes = "generated, edge length 0.84 2^-level";
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
