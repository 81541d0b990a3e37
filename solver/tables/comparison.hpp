// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/tables/table.hpp"

namespace esfem {

/// Rows of a table relative to others, for claims that one scheme, mesh or step size is better than another.
struct Comparison {
  nlohmann::json with;  ///< labels of the rows that the others are compared with: {"flow": "dziuk", "bdf": 3}
  std::string suffix;   ///< of the names of the ratios: "_over_dziuk"

  /// Numbers of a row: the name of a value, "distance", or quantity and norm of an error, "x_nodal_L2".
  std::vector<std::string> numbers;
  int level = 0;   ///< -1: with the next coarser mesh
  double tau = 1;  ///< 4: with four times the step size
};

/// Appends to each row's values NAME + suffix, its number NAME divided by that of the row with the same
/// labels except for those of `with`, and with this level and step size relative to its own. There is no
/// ratio where a row has no such number or no such partner, or where the partner's is zero.
void add_ratios(const Comparison& comparison, Table& table);

}  // namespace esfem
