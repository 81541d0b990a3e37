// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace esfem {

namespace {

std::optional<double> number(const Row& row, const std::string& name) {
  if (const auto value = row.values.find(name); value != row.values.end()) return value->second;
  for (const auto& [quantity, norms] : row.errors)
    for (const auto& [norm, error] : norms)
      if (quantity + "_" + norm == name) return error;
  return {};
}

}  // namespace

void add_ratios(const Comparison& comparison, Table& table) {
  for (Row& row : table.rows) {
    nlohmann::json labels = row.labels;
    labels.update(comparison.with);
    const auto partner = std::find_if(table.rows.begin(), table.rows.end(), [&](const Row& other) {
      return other.labels == labels && other.level == row.level + comparison.level &&
             std::abs(other.tau / (row.tau * comparison.tau) - 1) < 1e-9;
    });
    if (partner == table.rows.end() || &*partner == &row) continue;
    for (const std::string& name : comparison.numbers) {
      const std::optional<double> own = number(row, name), others = number(*partner, name);
      if (own && others && *others != 0) row.values[name + comparison.suffix] = *own / *others;
    }
  }
}

}  // namespace esfem
