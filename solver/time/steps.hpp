// SPDX-License-Identifier: GPL-3.0-or-later
// Which steps a run takes: equal ones, those that follow the solution, or those of a list of times.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/time/checkpoint.hpp"

namespace esfem {

/// How the states 1..q-1 are found. exact: from the exact solution. cascade: BDF 1, 2, .. with the same step
/// size (global order 2 at most). substeps: the same method started by a cascade with step size tau/K, every
/// K-th kept.
struct Start {
  /// Where they come from.
  enum Kind { exact, cascade, substeps } kind = exact;  ///< with order 1 of no meaning
  int substeps_per_step = 1;                            ///< K
};
/// Parses "exact" | "cascade" | "substeps:K"; throws InputError that lists these.
Start parse_start(const std::string& text);
/// Its inverse.
std::string to_string(const Start& start);

/// Equal steps.
struct UniformSteps {
  int order = 2;          ///< q of BDF
  double tau = 0;         ///< step size, to be set
  int steps = 0;          ///< starting steps counted
  Start start = {};       ///< of the states 1..q-1
  int first = 0;          ///< state n is that at t = start_time + (first + n) tau
  double start_time = 0;  ///< of a run whose initial state is not one of t = 0

  /// The time of state n.
  double time(int n) const { return start_time + (first + n) * tau; }
};
/// Throws InputError unless 1 <= order <= 5, tau > 0, steps >= 0, first >= 0, K >= 1, start_time is finite.
void check_steps(const UniformSteps& steps);

/// Steps whose size follows the solution. The error of a step is estimated by the root mean square over the
/// nodes of the difference of the `controlled` field from its linear extrapolation from the two newest
/// states, which is of second order in the step size; the first step is a backward Euler step without
/// estimate. A step is rejected, and repeated from the same states with half its size, when the estimate is
/// more than 4 times the tolerance, or when it throws a NumericsError.
struct AdaptiveSteps {
  std::string controlled = "";     ///< name of a field of the State
  int order = 2;                   ///< of BDF, 1 or 2
  double end_time = 0;             ///< of the last state
  double tolerance = 1e-3;         ///< of the estimate of each step, in `units`
  double first_step = 1e-6;        ///< not controlled itself; a hundredth of it is the smallest step
  double largest_step = 0;         ///< 0: no bound
  std::vector<double> units = {};  ///< of the components of the controlled field; empty: 1
  double start_time = 0;           ///< of the initial state
};
/// Throws InputError unless order is 1 or 2, end_time >= start_time >= 0, tolerance > 0, end_time/10^12 <=
/// first_step, units > 0 and, where a largest step is given, first_step <= largest_step.
void check_steps(const AdaptiveSteps& steps);

/// Steps from each time to the next; state n is that at times[n].
struct GivenTimes {
  int order = 1;              ///< of BDF; the states before the order-th are found by lower orders
  std::vector<double> times;  ///< increasing, the first is that of the initial state
};
/// Throws InputError unless 1 <= order <= 5 and there are increasing times.
void check_steps(const GivenTimes& steps);

/// What the numbers of a step depend on: all but where the run ends; of given times all of
/// them.
/// @{
nlohmann::json identity_of_steps(const UniformSteps& steps);
nlohmann::json identity_of_steps(const AdaptiveSteps& steps);
nlohmann::json identity_of_steps(const GivenTimes& steps);
/// @}

/// Why a run with this progress does not lead to this end; empty when it does.
/// @{
std::string objection_of_end(const UniformSteps& steps, const RunPosition& done);
std::string objection_of_end(const AdaptiveSteps& steps, const RunPosition& done);
std::string objection_of_end(const GivenTimes& steps, const RunPosition& done);
/// @}

/// The time after t for a step of about tau: the last step ends at end_time, and what remains for one step to
/// two is halved.
double next_time(const AdaptiveSteps& steps, double t, double tau);

/// The least end time (up to round-off, not below it) for which next_time is t + tau.
double least_end(double t, double tau);

/// min(1.5, max(0.5, 0.9 sqrt(tolerance / error))): the estimate is of second order. 1.5 keeps BDF2
/// zero-stable.
double step_factor(double tolerance, double error);

/// The size of a nodal field: sqrt(sum of squares / number of nodes).
double root_mean_square(const Field& field);

/// That of the field whose components are measured in `units`: one for each, or none. Changes the field.
double root_mean_square(Field& field, const std::vector<double>& units);

}  // namespace esfem
