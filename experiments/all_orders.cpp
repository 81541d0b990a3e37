// SPDX-License-Identifier: GPL-3.0-or-later
//
// All orders: polynomial degree k = 1, .., 4 and BDF q = 1, .., 5 for each flow
//
// Sample runs:  build/bin/all_orders --preset check --output orders.json
//               build/bin/all_orders --flows willmore --degree 2 --bdf 3 --runs time
//               build/bin/all_orders --flows dziuk --bdf 4 --runs time --steps 2-5
//
// Writes:       results/paper/all_orders.{json,csv,tex}, from which plots/all_orders.py draws
//               figures/gallery/all_orders
//
// Orders in h and in tau are measured apart, so that they do not hide each other:
//   space  errors against the exact solution at the end, on three meshes, h halved in all, exact starting
//          values (Ritz maps and theta for Cahn-Hilliard, theta for Willmore flow). A run with 2 tau beside
//          it tells how much of an error the steps make: where it is more than a fifth, it is hidden, and
//          there is no order.
//   time   largest errors against small steps on the same coarse mesh, three step sizes. The small steps give
//          the starting values, some time after t = 0: by then the fast modes that interpolated initial
//          values contain have died out.
// A run is unstable when it ends before its time or an error is larger with tau than with 2 tau.
//
// Problems: mean curvature flow, (5.1) of kll19 and Dziuk's scheme, on the self-shrinking torus; nick18's
// growing sphere; Willmore flow without projections, in space on the Clifford torus until t = 0.02 (later
// |nu_h| leaves 1, like exp(100t) at the hole), in time of an ellipsoid; bk22's evolving ellipsoid.
//
// Expected: q in tau; k in h in H1 (kll19 Theorem 6.1, nick18 Theorem 2.1, kll21 Theorem 4.1 for k >= 2, bk22
// Theorem 4.1 for k >= 1), k + 1 in L2. All of it comes out, for k = 1 and q = 1, too. Higher orders than
// expected: positions and velocity of the growing sphere in h when k is even, and Willmore flow with k = 4 on
// these coarse meshes (slopes 6.1, 5.0); those of BDF4 and 5 fall towards 4 and 5 with tau.
//
// Dziuk's scheme is unstable with BDF4 and 5 unless tau/h² is small (dziuk_flow.hpp), so that coarse meshes
// pass for stable at large and at very small tau. BDF1 shows 0.5 to 0.8 of its order in H1, 1 in L2: fast
// tangential modes are still on their way. In space its positions have order 1.0 to 1.4 in H1 with k = 2, 2.4
// with k = 3.
//
// With nu_h and z_h projected after each step Willmore flow on the Clifford torus is unstable with BDF5 for
// tau from 0.0006 to 0.005 (BDF4 in one of two runs), and BDF3 is not.
#include <cmath>

#include "experiments/harness/all_orders_problems.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/error.hpp"

namespace {

using namespace esfem;

const std::vector<std::string> known_runs = {"space", "time"};
/// Step sizes of an order in tau, and meshes of an order in h.
const int step_count = 3, level_count = 3;

struct OwnOptions {
  std::vector<std::string> flows, runs = known_runs;
};

/// A run with the exponent of its step size.
struct Planned {
  OrderRun run;
  int k;
};

/// The small steps are smaller than those of an order 2^gap times: they are of order 3 at least.
int reference_gap(int bdf) {
  return bdf <= 2 ? 1 : 2;
}

/// All runs of one flow with one degree and order.
void add_runs(const OrdersOfFlow& flow, int degree, int bdf, const std::vector<std::string>& kinds,
              const Options& options, std::vector<Planned>& runs) {
  for (const std::string& kind : kinds) {
    if (kind == "time") {
      const int first = flow.first_k.at(bdf - 1);
      const std::vector<int> steps = options.steps.value_or(range(first, first + step_count - 1));
      const int reference = *std::max_element(steps.begin(), steps.end()) + reference_gap(bdf);
      for (int k : steps) runs.push_back({{flow, degree, bdf, true, 0, reference}, k});
    } else {
      for (int k : options.steps.value_or(std::vector<int>{flow.space_k.at(bdf - 1)})) {
        for (int level : options.levels.value_or(range(0, level_count - 1)))
          runs.push_back({{flow, degree, bdf, false, level, 0}, k});
      }
    }
  }
}

/// Those of the preset check: P2 and BDF2, of Dziuk's scheme that BDF4 is unstable.
void add_check_runs(const OrdersOfFlow& flow, const Options& options, std::vector<Planned>& runs) {
  if (flow.flow == "dziuk")
    add_runs(flow, 2, 4, {"space"}, options, runs);
  else
    add_runs(flow, 2, 2, known_runs, options, runs);
}

/// Throws InputError when small steps do not give all the starting values of a run with 2 tau.
void require_starting_values(const Planned& planned) {
  const OrdersOfFlow& flow = planned.run.flow;
  const double doubled = 2 * flow.time.tau(planned.k);
  if (planned.run.in_time && planned.run.bdf * doubled > flow.begin * (1 + 1e-9)) {
    throw InputError(
        format("--steps: found %d, expected more for %s: BDF%d needs %d steps of %g before t = %g", planned.k,
               flow.flow.c_str(), planned.run.bdf, planned.run.bdf, doubled, flow.begin));
  }
}

bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<Planned> planned_runs(const Options& options, const OwnOptions& own) {
  if (!options.meshes.empty() || options.start)
    throw InputError(
        "--mesh, --start: meshes and starting values are those of the problems; expected --flows, --degree, "
        "--bdf, --runs, --levels, --steps");
  std::vector<Planned> runs;
  const bool check = options.preset == "check" && !options.degree && !options.bdf && own.runs == known_runs;
  const std::vector<int> degrees = options.degree ? std::vector<int>{*options.degree} : range(1, 4);
  const std::vector<int> orders = options.bdf ? std::vector<int>{*options.bdf} : range(1, 5);
  for (const OrdersOfFlow& flow : orders_of_flows()) {
    if (!wanted(own.flows, flow.flow)) continue;
    if (check) {
      add_check_runs(flow, options, runs);
      continue;
    }
    for (int degree : degrees) {
      for (int bdf : orders) add_runs(flow, degree, bdf, own.runs, options, runs);
    }
  }
  for (const Planned& planned : runs) require_starting_values(planned);
  return runs;
}

/// Seconds on one core.
double estimated_cost(const Planned& planned) {
  const OrderRun& run = planned.run;
  const double h =
      run.in_time ? run.flow.time_h.at(run.degree - 1) : run.flow.edge_length(run.degree, run.level);
  const double vertices = run.flow.vertices / (h * h), nodes = vertices * run.degree * run.degree;
  const double steps = run.in_time
                           ? run.flow.time.count(run.reference_k) + 1.5 * run.flow.time.count(planned.k)
                           : 1.5 * run.flow.space.count(planned.k);
  return 0.05 + vertices * 2e-4 + nodes * steps * run.flow.seconds_per_node;
}

std::vector<Cell> cells(const std::vector<Planned>& runs) {
  std::vector<Cell> list;
  for (const Planned& planned : runs) {
    const OrderRun run = planned.run;
    const char* kind = run.in_time ? "time" : "space";
    const HalvedSteps& steps = run.in_time ? run.flow.time : run.flow.space;
    list.push_back(
        {run.flow.flow + format("_p%d_bdf%d_%s_h%d_tau%d", run.degree, run.bdf, kind, run.level, planned.k),
         estimated_cost(planned),
         [=](const Row& row, const std::string&) { return run_all_orders(run, row); },
         planned_row(run.level, steps, planned.k,
                     {{"flow", run.flow.flow}, {"degree", run.degree}, {"bdf", run.bdf}, {"run", kind}})});
  }
  return list;
}

nlohmann::json parameters(const Options& options) {
  nlohmann::json problems;
  for (const OrdersOfFlow& flow : orders_of_flows()) {
    problems[flow.flow] = {{"problem", flow.problem},
                           {"quantities", flow.quantities},
                           {"end_time_in_space", flow.space.end_time},
                           {"begin_in_time", flow.begin},
                           {"end_time_in_time", flow.time.end_time}};
  }
  return {
      {"preset", options.preset},
      {"problems", problems},
      {"errors", "space: at the end time, against the exact solution; time: maxima, against small steps"}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "all_orders";
  experiment.paper = "esfem";
  experiment.help =
      "The orders in h and tau of each flow for polynomial degrees 1 to 4 and BDF 1 to 5. Orders in h come "
      "from "
      "errors against\n"
      "exact solutions on three meshes (levels 0, 1, 2), orders in tau from errors against small steps on "
      "one mesh "
      "with three\n"
      "step sizes, k = first, first + 1, first + 2, of which the first depends on flow and BDF. No units.\n"
      "Preset check: P2 with BDF2, and Dziuk's scheme with BDF4.\n\n"
      "Example: all_orders --flows willmore --degree 2 --bdf 3 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    std::vector<std::string> flows;
    for (const OrdersOfFlow& flow : orders_of_flows()) flows.push_back(flow.flow);
    line.names("--flows", flows, own.flows, "all unless given");
    line.names("--runs", known_runs, own.runs, "space: orders in h | time: orders in tau; both unless given");
  };
  experiment.cells = [&](const Options& options) { return cells(planned_runs(options, own)); };
  experiment.parameters = parameters;
  return run_experiment(experiment, argc, argv);
}
