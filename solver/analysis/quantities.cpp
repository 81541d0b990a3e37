// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/quantities.hpp"

#include <utility>

#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

Quantities::Quantities(const SurfaceSpace& space, std::vector<ExactEvolution::Quantity> quantities)
    : quantities_(std::move(quantities)), space_(space) {}

Field Quantities::columns(const Field& x, NodalFields fields) {
  const auto is_wanted = [&](const char* name) {
    for (const ExactEvolution::Quantity& quantity : quantities_)
      if (quantity.name == name) return true;
    return false;
  };
  const bool has_nu = find(fields, "nu"), has_both = has_nu && find(fields, "H");
  if ((is_wanted("nu") && !has_nu) || (is_wanted("H") && !has_both)) {
    if (!curvature_) curvature_ = std::make_unique<DiscreteCurvature>(space_);
    curvature_->compute(x);
    if (!has_both) fields.insert(fields.begin(), {"H", curvature_->H()});
    if (!has_nu) fields.insert(fields.begin(), {"nu", curvature_->nu()});
  }
  int count = 0;
  for (const ExactEvolution::Quantity& quantity : quantities_) count += quantity.components;
  Field columns(x.rows(), count);
  int column = 0;
  for (const auto& [name, components] : quantities_) {
    const Field* values = find(fields, name);
    if (!values || values->cols() != components)
      throw InputError("error table: expected a nodal field " + name + " of " + std::to_string(components) +
                       " components");
    columns.middleCols(column, components) = *values;
    column += components;
  }
  return columns;
}

}  // namespace esfem
