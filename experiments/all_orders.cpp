// SPDX-License-Identifier: GPL-3.0-or-later
//
// All orders: polynomial degree k = 1, .., 4 and BDF q = 1, .., 5 for each flow
//
// Sample runs:  build/bin/all_orders --preset check --output orders.json
//               build/bin/all_orders --flows willmore --degree 2 --bdf 3 --runs time
//
// Writes:       results/paper/all_orders.{json,csv,tex}, from which plots/all_orders.py draws
//               figures/gallery/all_orders
#include <cmath>

#include "experiments/harness/all_orders_problems.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
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
void add_runs(const OrdersOfFlow& flow, int degree, int bdf, const Options& options, const OwnOptions& own,
              std::vector<Planned>& runs) {
  for (const std::string& kind : own.runs) {
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
  const bool check = options.preset == "check" && !options.degree && !options.bdf;
  const std::vector<int> degrees = options.degree ? std::vector<int>{*options.degree} : range(1, 4);
  const std::vector<int> orders = options.bdf ? std::vector<int>{*options.bdf} : range(1, 5);
  std::vector<Planned> runs;
  for (const OrdersOfFlow& flow : orders_of_flows()) {
    if (!wanted(own.flows, flow.flow)) continue;
    for (int degree : check ? std::vector<int>{2} : degrees) {
      for (int bdf : check ? std::vector<int>{2} : orders) add_runs(flow, degree, bdf, options, own, runs);
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
                     {{"flow", run.flow.flow},
                      {"degree", std::to_string(run.degree)},
                      {"bdf", std::to_string(run.bdf)},
                      {"run", kind}})});
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
      "errors\n"
      "against exact solutions on three meshes, orders in tau from errors against small steps on one mesh. "
      "No "
      "units.\n\n"
      "Example: all_orders --flows willmore --degree 2 --bdf 3 --output table.json";
  experiment.add_options = [&](CLI::App& app) {
    std::vector<std::string> flows;
    for (const OrdersOfFlow& flow : orders_of_flows()) flows.push_back(flow.flow);
    add_names_option(app, "--flows", flows, "all unless given", own.flows);
    add_names_option(app, "--runs", known_runs, "space: orders in h | time: orders in tau; both unless given",
                     own.runs);
  };
  experiment.cells = [&](const Options& options) { return cells(planned_runs(options, own)); };
  experiment.parameters = parameters;
  return run_experiment(experiment, argc, argv);
}
