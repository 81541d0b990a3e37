// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of all_orders, of any flow. A Problem is made of degree, edge length and step size, and has
//   Flow, flow()       the scheme, and one of it
//   on                 the initial surface: its mesh, and the space on it
//   exact              an ExactEvolution; against small steps its quantities alone
//   state(t)           the exact state, or the one at the start
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/harness/all_orders_problems.hpp"
#include "experiments/harness/richardson.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"

namespace esfem {

/// The norms in which the errors with tau and with 2 tau are compared.
inline constexpr const char* deciding_norm = "nodal_L2";

/// In space errors with tau may exceed those with 2 tau, where error in time and in space cancel each other:
/// by less than this.
inline constexpr double growth_in_space = 10;

/// Whether an error of the flow's quantities is larger with tau than `factor` times that with 2 tau.
inline bool grows(const OrdersOfFlow& flow, const Errors& errors, const Errors& doubled, double factor) {
  for (const std::string& quantity : flow.quantities) {
    const double error = errors.at(quantity).at(deciding_norm);
    if (!(error <= std::max(1e-9, factor * doubled.at(quantity).at(deciding_norm)))) return true;
  }
  return false;
}

/// Moves the errors to the values "<quantity>_<norm>_<reason>".
inline void set_aside(const Errors& errors, const std::string& reason, Row& row) {
  for (const auto& [quantity, norms] : errors) {
    for (const auto& [norm, error] : norms) {
      if (std::isfinite(error)) row.values[quantity + "_" + norm + "_" + reason] = error;
    }
  }
}

/// Runs `body`; a run that ends at a singularity or with another NumericsError is unstable.
template <class Body>
void note_instability(Row& row, Body&& body) {
  row.values["unstable"] = 0;
  try {
    body();
  } catch (const NumericsError& error) {
    row.values["unstable"] = 1;
    row.errors.clear();
    row.more["ended"] = {{"why", error.what()}};
  }
}

/// The quantities at the end, N x all components, with the step sizes tau, 2 tau, 4 tau, ..; `count` of them.
template <class Problem>
std::vector<Field> values_at_end(const Problem& problem, const OrderRun& run, const Row& row, int count) {
  const int coarsest = 1 << (count - 1);
  if (row.steps % coarsest != 0 || row.steps / coarsest < run.bdf)
    throw std::logic_error(format("%d steps cannot be made %d times larger", row.steps, coarsest));
  typename Problem::Flow flow = problem.flow();
  Quantities quantities(problem.on.space, problem.exact.quantities);
  const StartingValues<typename Problem::Flow::State> start(problem.state(0),
                                                            [&](double t) { return problem.state(t); });
  std::vector<Field> values;
  for (int factor = 1; factor <= coarsest; factor *= 2)
    values.push_back(quantities.of(
        last_state(flow, UniformSteps{run.bdf, factor * row.tau, row.steps / factor, {}}, start)));
  return values;
}

template <class Problem>
Errors errors_at_end(const Problem& problem, double t, const Field& values) {
  ErrorRecorder recorder(problem.on.space, problem.exact, problem.on.mesh.nodes);
  recorder.record(t, values);
  return recorder.maxima();
}

/// Errors at the end of values that are extrapolated to tau = 0, as far as they are errors in space.
template <class Problem>
void run_in_space(const OrderRun& run, Row& row) {
  const double h = run.flow.edge_length(run.degree, run.level), t = row.steps * row.tau;
  const Problem problem(run.degree, h, row.tau);
  describe_mesh(problem.on.mesh, row);
  note_instability(row, [&] {
    const int extrapolations = std::max(0, order_of_extrapolated - run.first_power);
    const std::vector<Field> values = values_at_end(problem, run, row, extrapolations + 2);
    const Errors single = errors_at_end(problem, t, values[0]);
    if (grows(run.flow, single, errors_at_end(problem, t, values[1]), growth_in_space)) {
      row.values["unstable"] = 1;
      return set_aside(single, "unstable", row);
    }
    const Field extrapolated = richardson({values.begin(), values.end() - 1}, run.first_power);
    const Field with_2_tau = richardson({values.begin() + 1, values.end()}, run.first_power);
    LargestDifferences differences(problem.on.space, problem.exact.quantities);
    differences.add(problem.exact.trajectories(problem.on.mesh.nodes, t), extrapolated - with_2_tau);
    const int order = run.bdf + (extrapolations > 0 ? 1 : 0);
    for (const auto& [quantity, norms] : errors_at_end(problem, t, extrapolated)) {
      for (const auto& [norm, error] : norms) {
        const std::string nodal = "nodal" + norm.substr(norm.find('_'));
        const double by_steps = differences.errors().at(quantity).at(nodal) / (std::pow(2, order) - 1);
        const double share = by_steps / std::max(error, 1e-300);
        row.values[quantity + "_" + norm + "_share"] = share;
        if (share > largest_share)
          set_aside({{quantity, {{norm, error}}}}, "hidden", row);
        else
          row.errors[quantity][norm] = error;
      }
    }
  });
}

/// Errors with tau and with 2 tau against small steps.
template <class Problem>
void run_in_time(const OrderRun& run, Row& row) {
  using State = typename Problem::Flow::State;
  const UniformSteps small{run.flow.flow == "dziuk" ? 3 : 5, run.flow.time.tau(run.reference_k),
                           run.flow.time.count(run.reference_k), parse_start("cascade")};
  const Problem problem(run.degree, run.flow.time_h.at(run.degree - 1), small.tau);
  describe_mesh(problem.on.mesh, row);
  typename Problem::Flow flow = problem.flow();
  const SmallSteps<typename Problem::Flow> reference(flow, small, problem.state(0), {},
                                                     static_cast<int>(std::lround(row.tau / small.tau)));
  note_instability(row, [&] {
    const auto errors = [&](double tau) {
      LargestDifferences differences(problem.on.space, problem.exact.quantities);
      reference.compare(
          run.bdf, tau, static_cast<int>(std::lround(run.flow.begin / tau)),
          [&](int, const State& state, const State& exact) { differences.add(exact.x, state, exact); });
      return differences.errors();
    };
    const Errors doubled = errors(2 * row.tau), single = errors(row.tau);
    set_aside(doubled, "double", row);
    if (grows(run.flow, single, doubled, 1)) {
      row.values["unstable"] = 1;
      return set_aside(single, "unstable", row);
    }
    row.errors = single;
  });
}

/// In space and in time; the problems may differ.
template <class InSpace, class InTime = InSpace>
void run_problem(const OrderRun& run, Row& row) {
  if (run.in_time)
    run_in_time<InTime>(run, row);
  else
    run_in_space<InSpace>(run, row);
}

}  // namespace esfem
