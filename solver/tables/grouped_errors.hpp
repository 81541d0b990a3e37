// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a table for the fit of orders, by mesh and by step size.
#pragma once

#include <vector>

#include "solver/tables/power_law.hpp"

namespace esfem {

/// The rows of one mesh or of one step size.
struct Group {
  double place;           ///< log h or log tau
  std::vector<int> rows;  ///< their numbers in the LogErrors, from 0
};

/// The rows and their groups, from coarse to fine.
struct GroupedErrors {
  LogErrors rows;  ///< with log h and log tau less their means

  /// The means of log h and of log tau.
  /// @{
  double centre_h = 0, centre_tau = 0;
  /// @}

  std::vector<Group> meshes;      ///< rows of equal h
  std::vector<Group> step_sizes;  ///< rows of equal tau

  /// Step sizes or meshes.
  const std::vector<Group>& groups(bool in_tau) const { return in_tau ? step_sizes : meshes; }
};

/// Groups of equal h or tau, from coarse to fine, of their logarithms.
std::vector<Group> groups_of(const std::vector<double>& places);

/// Throws InputError, which says how many rows there are and how many are needed, when there are too few
/// rows, nothing varies, or a number is not positive.
GroupedErrors grouped_errors(const std::vector<double>& h, const std::vector<double>& tau,
                             const std::vector<double>& error);

/// The rows with these numbers, in this order.
LogErrors chosen(const LogErrors& rows, const std::vector<int>& which);
/// All rows but those of a group, in their order.
LogErrors without(const LogErrors& rows, const Group& group);

}  // namespace esfem
