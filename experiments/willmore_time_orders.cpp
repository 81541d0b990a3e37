// SPDX-License-Identifier: GPL-3.0-or-later
//
// Orders in time of the scheme for Willmore flow, with and without the projections of kll21 §7.1
//
// Sample runs:  build/bin/willmore_time_orders --preset check --output orders.json
//               build/bin/willmore_time_orders --bdf 3 --steps 4-6 --projection none
//
// Writes:       results/paper/willmore_time_orders.{json,csv,tex}
//
// The ellipsoid with half axes 2, 2, 1.6 under Willmore flow, kll21 (3.4)-(3.5) with quadratic elements on
// one mesh, BDF 1 to 4. Errors of x, u = (H, nu) and w = (V, z) against BDF5 with 1,024 steps on the same
// mesh, which gives the starting values, too. Errors are measured from t = 0.1 on: by then the fast modes
// that the interpolated initial values contain have decayed; in that initial layer no method shows its order.
//
// Expected: order q of BDF q without projections. With nu_h and z_h projected after each step the order is
// lost: about 0.4 is what remains, whatever q is.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/error.hpp"
#include "solver/flows/willmore_flow.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const HalvedSteps time_steps{0.4, 0.1};
const int reference_k = 8;  ///< tau = 0.4/1,024

Block otherwise(bool paper) {
  return {{"degree", 2}, {"bdf", range(1, 4)}, {"step", range(paper ? 3 : 4, 6)}};
}

HalvedSteps steps(const Choice& choice) {
  const int k = choice.step(), last = reference_k - 2;
  if (k < 1 || k > last) throw InputError(format("--steps: found %d, expected 1 to %d", k, last));
  return time_steps;
}

/// The state at t = 0.1, from the exact normal and mean curvature at t = 0.
State behind_the_layer(const SurfaceSpace& space, const Surface& surface, const Field& x,
                       WillmoreFlow& flow) {
  const WillmoreStart start = willmore_start_on(space, surface, x, willmore_law(), false);
  State state;
  integrate(flow, {2, 2e-4, 500, parse_start("substeps:16")}, start.state,
            [&](int, const State& now) { state = now; });
  return state;
}

/// Largest nodal L2 norm over the steps n >= q of the difference from the solution with small steps, for each
/// field.
void record_errors(WillmoreFlow& flow, const SurfaceSpace& space, const State& initial,
                   const UniformSteps& grid, Row& row) {
  const UniformSteps small{5, time_steps.tau(reference_k), time_steps.count(reference_k),
                           parse_start("substeps:128")};
  const SmallSteps reference(flow, small, initial, {}, small.steps / grid.steps);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  reference.compare(grid.order, grid.tau, grid.order, [&](int, const State& state, const State& exact) {
    space.assemble(exact.x, M, A);
    for (const auto& [name, field] : {std::pair("x", &State::x), {"u", &State::u}, {"w", &State::w}}) {
      double& largest = row.errors[name]["nodal_L2"];
      largest = std::max(largest, std::sqrt(M.energy(state.*field - exact.*field)));
    }
  });
}

void run(const Choice& choice, Row& row, const std::string&) {
  // 1. The ellipsoid and the finite element space on it: 162 nodes (quadratic elements).
  const Vec3 axes(2, 2, 1.6);
  const Surface surface = ellipsoid(axes[0], axes[1], axes[2]);
  Mesh sphere = icosphere(1, 1);
  sphere.nodes *= axes.asDiagonal();
  const Mesh mesh = initial_mesh(
      {}, 0, [&] { return sphere; }, surface, choice.degree());
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow and its state behind the initial layer.
  WillmoreFlow::Variant variant;
  variant.project = choice["projection"] == "projected";
  WillmoreFlow flow(space, variant);
  const State initial = behind_the_layer(space, surface, mesh.nodes, flow);

  // 3. The time steps, with small steps and with those of the row.
  record_errors(flow, space, initial, {choice.bdf(), row.tau, row.steps, {}}, row);
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_time_orders", "kll21");
  experiment.help =
      "Orders in time of BDF 1 to 4 for Willmore flow of an ellipsoid on [0, 0.4], with and without\n"
      "projections of nu_h and z_h, against small steps on the same mesh. Step sizes 0.1 2^-k, k = 1..6. No "
      "units.\n\n"
      "Example: willmore_time_orders --bdf 2 --steps 3-6 --output table.json";
  experiment.grid.axes = {{"projection", {"none", "projected"}, "of nu_h and z_h after each step"}};
  experiment.grid.labels = {"projection", "bdf"};
  experiment.grid.otherwise = otherwise;
  const std::string why = "mesh and starting values are those of the solution with small steps";
  experiment.grid.refused = {{"mesh", why}, {"start", why}, {"level", why}};
  experiment.steps = steps;
  experiment.cost = [](const Choice&) { return 2; };
  experiment.run = run;
  experiment.parameters = {
      {"end_time", time_steps.end_time},
      {"surface", "ellipsoid with half axes 2, 2, 1.6"},
      {"start", "solution with small steps"},
      {"errors", "against BDF5 with 1,024 steps on the same mesh, behind the initial layer"}};
  return run_experiment(experiment, argc, argv);
}
