// SPDX-License-Identifier: GPL-3.0-or-later
//
// All orders: polynomial degree k = 1, .., 4 and BDF q = 1, .., 5 for each flow
//
// Sample runs:  build/bin/all_orders --preset check --output orders.json
//               build/bin/all_orders --flow willmore --degree 2 --bdf 3 --run time
//               build/bin/all_orders --flow dziuk --bdf 4 --run time --steps 0-3
//
// Writes:       results/paper/all_orders.{json,csv,tex}, from which plots/all_orders.py draws
//               figures/gallery/all_orders
//
// Orders in h and in tau are measured separately, so that they do not hide each other:
//   space  errors against the exact solution at the end, on four meshes, h smaller by 2^(-1/2) from one to
//          the next (three for P4, whose coarsest would be out of the asymptotic range), exact starting
//          values (Ritz maps and theta for Cahn-Hilliard, theta for Willmore flow). The nodal values of BDF1,
//          2, 3 are extrapolated to tau = 0 from runs with tau, 2 tau, .. (Richardson), until their error in
//          time is of order 4. The same from 2 tau, 4 tau, .. shows which part of an error is caused by the
//          steps: if it is more than a fifth, the error in space is hidden, and there is no order.
//   time   largest errors against small steps on the same coarse mesh, three step sizes. The small steps give
//          the starting values, some time after t = 0: by then the fast modes that interpolated initial
//          values contain have died out.
// A run is unstable when it ends before its time or an error is larger with tau than with 2 tau.
//
// Problems: mean curvature flow, (5.1) of kll19, the same with the velocity of minimal deformation rate, and
// Dziuk's scheme, on the self-shrinking torus; generalised mean curvature flow with V = H², in space of a
// sphere, in time of an ellipsoid; nick18's growing sphere; Willmore flow without projections, in space on
// the Clifford torus until t = 0.02 (later |nu_h| leaves 1, like exp(100t) at the hole), in time of an
// ellipsoid; Helfrich flow with H_0 = 1 of the same surfaces, which keeps area and volume; bk22's evolving
// ellipsoid.
//
// Expected: q in tau; k in h in H1 (kll19 Theorem 6.1, nick18 Theorem 2.1, kll21 Theorem 4.1 for k >= 2, bk22
// Theorem 4.1 for k >= 1), k + 1 in L2. All of it is observed, also for k = 1 and q = 1. But for Dziuk's
// scheme the orders in h of BDF1 to 4 differ by 0.2 at most, as they should after the extrapolation in tau.
// Higher than expected, in h: spheres for even k, k + 1 in H1 and k + 2 in L2 (not u); V = H² of the sphere
// in H1 (2.2, 4.8, 5.4, 7.4); the self-shrinking torus with k = 4, 5.2 in H1 of x and H, 6 in L2, with the
// velocity of minimal deformation rate 5.2 in H1 of x and v, 6.2 to 6.7 in L2; Willmore flow with k = 4 on
// these coarse meshes (slopes 6.1, 5.0). In tau those of BDF4 and 5 fall towards 4 and 5.
//
// Dziuk's scheme is unstable with BDF4 and 5 unless tau/h² is small (dziuk_flow.hpp), so that coarse meshes
// seem stable at large and at very small tau. BDF1 shows 0.5 to 0.8 of its order in H1, 1 in L2: fast
// tangential modes have not decayed yet. In space its positions have order 1.8, 1.7, 1.0 in H1 with k = 2 and
// BDF1, 2, 3; 2.4 to 2.6 with k = 3.
//
// Hidden: H in H1 of Dziuk's scheme with k = 2, 4 and BDF1, 2, with k = 4 also in L2 (BDF1: v, nu); nu in L2
// of (5.1) with k = 4 and BDF1.
//
// With nu_h and z_h projected after each step Willmore flow on the Clifford torus is unstable with BDF5 for
// tau from 0.0006 to 0.005 (BDF4 in one of two runs), and BDF3 is not.
#include <algorithm>

#include "experiments/harness/all_orders_problems.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/small_steps.hpp"

namespace {

using namespace esfem;

/// Step sizes of an order in tau, and meshes of an order in h.
const int step_count = 3, level_count = 4;

const OrdersOfFlow& orders_of(const Choice& choice) {
  for (const OrdersOfFlow& flow : orders_of_flows())
    if (flow.flow == choice["flow"]) return flow;
  throw std::logic_error("there are no orders of the flow " + choice["flow"]);
}

std::vector<std::string> known_flows() {
  std::vector<std::string> names;
  for (const OrdersOfFlow& flow : orders_of_flows()) names.push_back(flow.flow);
  return names;
}

Block otherwise(bool paper) {
  return {{"flow", known_flows()},
          {"degree", paper ? range(1, 4) : range(2, 2)},
          {"bdf", paper ? range(1, 5) : range(2, 2)},
          {"run", {"space", "time"}},
          {"level", range(0, level_count - 1)},
          {"step", range(0, step_count - 1)}};
}

std::vector<std::string> flows_but(const std::vector<std::string>& excluded) {
  std::vector<std::string> names;
  for (const std::string& name : known_flows())
    if (std::count(excluded.begin(), excluded.end(), name) == 0) names.push_back(name);
  return names;
}

/// Paper: all, of Helfrich flow P2, and P1 and P3 with BDF2. Check: P2 and BDF2, of Dziuk's scheme that BDF4
/// is unstable, and the velocity of minimal deformation rate in time alone.
std::vector<Block> preset(bool paper) {
  if (!paper)
    return {{{"flow", flows_but({"dziuk", "minimal_deformation"})}},
            {{"flow", "dziuk"}, {"bdf", 4}, {"run", "space"}},
            {{"flow", "minimal_deformation"}, {"run", "time"}}};
  return {{{"flow", flows_but({"helfrich"})}},
          {{"flow", "helfrich"}, {"degree", 2}},
          {{"flow", "helfrich"}, {"degree", {1, 3}}, {"bdf", 2}}};
}

bool in_time(const Choice& choice) {
  return choice["run"] == "time";
}

/// The step sizes of a run: the first depends on flow and BDF.
HalvedSteps steps(const Choice& choice) {
  const OrdersOfFlow& flow = orders_of(choice);
  const HalvedSteps& steps = in_time(choice) ? flow.time : flow.space;
  const int first = (in_time(choice) ? flow.first_k : flow.space_k).at(choice.bdf() - 1);
  return {steps.end_time, steps.tau(first)};
}

/// The small steps are smaller than those of an order 2^gap times: they are of order 3 at least.
int reference_k(const Choice& choice) {
  const int gap = choice.bdf() <= 2 ? 1 : 2;
  return orders_of(choice).first_k.at(choice.bdf() - 1) + std::max(choice.step(), step_count - 1) + gap;
}

/// P4 has no level 0: that mesh is too coarse for the unit sphere, and on the Clifford torus the errors fall
/// with the orders 8, 6 and 5.
int coarsest_level(const Choice& choice) {
  return choice.degree() <= 3 ? 0 : 1;
}

/// Orders in tau are those on one mesh, orders in h those with one step size.
bool belongs_to_an_order(const Choice& choice) {
  if (!in_time(choice)) return choice.step() == 0 && choice.level() >= coarsest_level(choice);
  if (choice.level() != 0) return false;
  // A run with 2 tau stands beside.
  const double doubled = 2 * steps(choice).tau(choice.step());
  require_starting_values(choice.step(), choice.bdf(), doubled, orders_of(choice).begin);
  return true;
}

void run(const Choice& choice, Row& row, const std::string&) {
  row = run_all_orders({orders_of(choice), choice.degree(), choice.bdf(), in_time(choice), choice.level(),
                        in_time(choice) ? reference_k(choice) : 0},
                       row);
}

double cost(const Choice& choice) {
  const OrdersOfFlow& flow = orders_of(choice);
  const double h = in_time(choice) ? flow.time_h.at(choice.degree() - 1)
                                   : flow.edge_length(choice.degree(), choice.level());
  const double vertices = flow.vertices / (h * h), nodes = vertices * choice.degree() * choice.degree();
  const double small_steps = in_time(choice) ? flow.time.count(reference_k(choice)) : 0;
  // With tau and 2 tau; in space with up to 16 tau.
  const double all_steps = small_steps + (in_time(choice) ? 1.5 : 1.9) * steps(choice).count(choice.step());
  return 0.05 + vertices * 2e-4 + nodes * all_steps * flow.seconds_per_node;
}

nlohmann::json parameters() {
  nlohmann::json problems;
  for (const OrdersOfFlow& flow : orders_of_flows()) {
    problems[flow.flow] = {{"problem", flow.problem},
                           {"quantities", flow.quantities},
                           {"end_time_in_space", flow.space.end_time},
                           {"begin_in_time", flow.begin},
                           {"end_time_in_time", flow.time.end_time}};
  }
  const std::string errors =
      "space: at the end time, with BDF1 to 3 extrapolated to tau = 0, against the exact solution; "
      "time: maxima, against small steps";
  return {{"problems", problems}, {"errors", errors}};
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("all_orders", "esfem", run, otherwise, preset);
  experiment.help =
      "The orders in h and tau of each flow for polynomial degrees 1 to 4 and BDF 1 to 5. Orders in h come "
      "from errors against\nexact solutions on four meshes (levels 0 to 3; degree 4: 1 to 3), with BDF1 to 3 "
      "extrapolated to tau = 0. Orders in tau\ncome from errors against small steps on one mesh with three "
      "step sizes (steps 0, 1, 2), of which the first depends on\nflow and BDF. No units.\n"
      "Preset check: P2 with BDF2, and Dziuk's scheme with BDF4.\n\n"
      "Example: all_orders --flow willmore --degree 2 --bdf 3 --output table.json";
  experiment.grid.axes = {{"flow", known_flows(),
                           "as in evolve; minimal_deformation: mean_curvature with this tangential motion"},
                          {"run", {"space", "time"}, "space: orders in h | time: orders in tau"}};
  experiment.grid.labels = {"flow", "degree", "bdf", "run"};
  const std::string why = "meshes, starting values and quadrature are those of the problems";
  experiment.grid.refused = {{"mesh", why}, {"start", why}, {"quadrature", why}};
  experiment.grid.admits = belongs_to_an_order;
  experiment.steps = steps;
  experiment.cost = cost;
  experiment.parameters = parameters();
  return run_experiment(experiment, argc, argv);
}
