// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time/adaptive.hpp"

#include <cmath>
#include <limits>

namespace esfem {

void check_adaptive_grid(const AdaptiveGrid& grid) {
  if (grid.order < 1 || grid.order > 2)
    throw InputError(format("BDF order %d with adaptive steps: expected 1 or 2", grid.order));
  if (!(grid.end_time >= 0) || !std::isfinite(grid.end_time))
    throw InputError(format("end time %g: expected a number >= 0", grid.end_time));
  if (!(grid.tolerance > 0) || !std::isfinite(grid.tolerance))
    throw InputError(format("tolerance %g: expected a positive number", grid.tolerance));
  if (!(grid.first_step > 0) || !std::isfinite(grid.first_step) || grid.first_step < 1e-12 * grid.end_time)
    throw InputError(format("first step %g: expected a positive number, at least %g for this end time",
                            grid.first_step, 1e-12 * grid.end_time));
  if (!(grid.largest_step == 0 || grid.largest_step >= grid.first_step))
    throw InputError(format("largest step %g: expected 0 (no bound) or at least the first step %g",
                            grid.largest_step, grid.first_step));
  for (const double unit : grid.units)
    if (!(unit > 0) || !std::isfinite(unit))
      throw InputError(format("unit %g of the controlled field: expected a positive number", unit));
}

nlohmann::json identity_of_steps(const AdaptiveGrid& grid) {
  return {{"order", grid.order},
          {"tolerance", grid.tolerance},
          {"first_step", grid.first_step},
          {"largest_step", grid.largest_step},
          {"units", grid.units}};
}

std::string objection_of_end(const AdaptiveGrid& grid, const RunPosition& done) {
  if (done.least_end <= grid.end_time) return "";
  return format("its steps lead to an end time of %g at least, end_time is %g", done.least_end,
                grid.end_time);
}

double least_end(double t, double tau) {
  return (t + 2 * tau) * (1 + 4 * std::numeric_limits<double>::epsilon());
}

double next_time(const AdaptiveGrid& grid, double t, double tau) {
  const double remaining = grid.end_time - t;
  if (tau >= (1 - 1e-10) * remaining) return grid.end_time;
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
