// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time/steps.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "solver/error.hpp"
#include "solver/time/bdf.hpp"

namespace esfem {

Start parse_start(const std::string& text) {
  if (text == "exact") return {Start::exact, 1};
  if (text == "cascade") return {Start::cascade, 1};
  const std::string prefix = "substeps:";
  if (text.compare(0, prefix.size(), prefix) == 0) {
    int K = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + prefix.size(), end, K);
    if (error == std::errc() && rest == end && K >= 1) return {Start::substeps, K};
  }
  throw InputError("start '" + text + "': expected exact, cascade or substeps:K with an integer K >= 1");
}

std::string to_string(const Start& start) {
  switch (start.kind) {
  case Start::exact:
    return "exact";
  case Start::cascade:
    return "cascade";
  case Start::substeps:
    break;
  }
  return "substeps:" + std::to_string(start.substeps_per_step);
}

void check_steps(const UniformSteps& steps) {
  check_bdf_order(steps.order);
  if (!(steps.tau > 0) || !std::isfinite(steps.tau))
    throw InputError(format("step size tau = %g: expected a positive number", steps.tau));
  if (steps.steps < 0) throw InputError(format("%d steps: expected 0 or more", steps.steps));
  if (steps.first < 0) throw InputError(format("first state %d: expected 0 or more", steps.first));
  if (!std::isfinite(steps.start_time))
    throw InputError(format("time %g at the start: expected a finite number", steps.start_time));
  if (steps.start.substeps_per_step < 1)
    throw InputError(format("%d substeps per step: expected 1 or more", steps.start.substeps_per_step));
}

nlohmann::json identity_of_steps(const UniformSteps& steps) {
  return {{"order", steps.order},
          {"tau", steps.tau},
          {"start", to_string(steps.start)},
          {"first", steps.first},
          {"start_time", steps.start_time}};
}

std::string objection_of_end(const UniformSteps& steps, const RunPosition& done) {
  if (done.n <= steps.steps) return "";
  return format("it is at step %d, %d steps are asked for", done.n, steps.steps);
}

void check_steps(const GivenTimes& steps) {
  check_bdf_order(steps.order);
  if (steps.times.empty()) throw InputError("no times are given: expected the initial one at least");
  for (std::size_t n = 1; n < steps.times.size(); ++n)
    if (!(steps.times[n - 1] < steps.times[n]))
      throw InputError(
          format("time %.17g after %.17g: expected increasing times", steps.times[n], steps.times[n - 1]));
}

nlohmann::json identity_of_steps(const GivenTimes& steps) {
  return {{"order", steps.order}, {"times", steps.times}};
}

std::string objection_of_end(const GivenTimes& steps, const RunPosition& done) {
  const int last = static_cast<int>(steps.times.size()) - 1;
  return done.n <= last ? "" : format("it is at step %d, there are %d", done.n, last);
}

void check_steps(const AdaptiveSteps& steps) {
  if (steps.order < 1 || steps.order > 2)
    throw InputError(format("BDF order %d with adaptive steps: expected 1 or 2", steps.order));
  if (!(steps.start_time >= 0 && steps.end_time >= steps.start_time) || !std::isfinite(steps.end_time))
    throw InputError(
        format("end time %g: expected a number >= %g", steps.end_time, std::max(0.0, steps.start_time)));
  if (!(steps.tolerance > 0) || !std::isfinite(steps.tolerance))
    throw InputError(format("tolerance %g: expected a positive number", steps.tolerance));
  if (!(steps.first_step > 0) || !std::isfinite(steps.first_step) ||
      steps.first_step < 1e-12 * steps.end_time)
    throw InputError(format("first step %g: expected a positive number, at least %g for this end time",
                            steps.first_step, 1e-12 * steps.end_time));
  if (!(steps.largest_step == 0 || steps.largest_step >= steps.first_step))
    throw InputError(format("largest step %g: expected 0 (no bound) or at least the first step %g",
                            steps.largest_step, steps.first_step));
  for (const double unit : steps.units)
    if (!(unit > 0) || !std::isfinite(unit))
      throw InputError(format("unit %g of the controlled field: expected a positive number", unit));
}

nlohmann::json identity_of_steps(const AdaptiveSteps& steps) {
  return {{"controlled", steps.controlled},     {"order", steps.order},
          {"tolerance", steps.tolerance},       {"first_step", steps.first_step},
          {"largest_step", steps.largest_step}, {"units", steps.units},
          {"start_time", steps.start_time}};
}

std::string objection_of_end(const AdaptiveSteps& steps, const RunPosition& done) {
  if (done.least_end <= steps.end_time) return "";
  return format("its steps lead to an end time of %g at least, end_time is %g", done.least_end,
                steps.end_time);
}

double least_end(double t, double tau) {
  return (t + 2 * tau) * (1 + 4 * std::numeric_limits<double>::epsilon());
}

double next_time(const AdaptiveSteps& steps, double t, double tau) {
  const double remaining = steps.end_time - t;
  if (tau >= (1 - 1e-10) * remaining) return steps.end_time;
  return t + (2 * tau > remaining ? remaining / 2 : tau);
}

double step_factor(double tolerance, double error) {
  if (error == 0) return 1.5;
  return std::min(1.5, std::max(0.5, 0.9 * std::sqrt(tolerance / error)));
}

double root_mean_square(const Field& field) {
  return field.norm() / std::sqrt(static_cast<double>(field.rows()));
}

double root_mean_square(Field& field, const std::vector<double>& units) {
  if (!units.empty() && static_cast<Eigen::Index>(units.size()) != field.cols())
    throw InputError(format("%zu units for a field of %td components", units.size(), field.cols()));
  for (std::size_t l = 0; l < units.size(); ++l) field.col(l) /= units[l];
  return root_mean_square(field);
}

}  // namespace esfem
