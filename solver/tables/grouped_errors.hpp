// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a table for the fit of orders, by mesh and by step size.
#pragma once

#include <vector>

#include "solver/tables/power_law.hpp"

namespace esfem {

/// The rows of one mesh or of one step size.
struct Group {
  double place;  ///< log h or log tau
  std::vector<int> rows;
};

/// The rows and their groups, from coarse to fine.
struct GroupedErrors {
  LogErrors rows;
  double centre_h = 0, centre_tau = 0;  ///< of the logarithms, which are less these
  std::vector<Group> meshes, step_sizes;
  const std::vector<Group>& groups(bool in_tau) const { return in_tau ? step_sizes : meshes; }
};

/// Groups of equal h or tau, from coarse to fine, of their logarithms.
std::vector<Group> groups_of(const std::vector<double>& places);

/// Throws InputError, which says how many rows there are and how many are needed, when there are too few
/// rows, nothing varies, or a number is not positive.
GroupedErrors grouped_errors(const std::vector<double>& h, const std::vector<double>& tau,
                             const std::vector<double>& error);

LogErrors chosen(const LogErrors& rows, const std::vector<int>& which);
LogErrors without(const LogErrors& rows, const Group& group);

}  // namespace esfem
