// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time/integrate.hpp"

#include <charconv>
#include <cmath>

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

void check_time_grid(const TimeGrid& grid) {
  check_bdf_order(grid.order);
  if (!(grid.tau > 0) || !std::isfinite(grid.tau))
    throw InputError(format("step size tau = %g: expected a positive number", grid.tau));
  if (grid.steps < 0) throw InputError(format("%d steps: expected 0 or more", grid.steps));
  if (grid.start.substeps_per_step < 1)
    throw InputError(format("%d substeps per step: expected 1 or more", grid.start.substeps_per_step));
}

nlohmann::json identity_of_steps(const TimeGrid& grid) {
  return {{"order", grid.order}, {"tau", grid.tau}, {"start", to_string(grid.start)}};
}

std::string objection_of_end(const TimeGrid& grid, const RunPosition& done) {
  if (done.n <= grid.steps) return "";
  return format("it is at step %d, %d steps are asked for", done.n, grid.steps);
}

}  // namespace esfem
