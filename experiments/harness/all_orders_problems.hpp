// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of which all_orders consists: a problem of each flow, with its meshes and step sizes.
#pragma once

#include <string>
#include <vector>

#include "experiments/harness/grid.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// The runs of one flow. Lists by degree are for degree 1, 2, .., those by order for BDF1, BDF2, ..
struct OrdersOfFlow {
  std::string flow, problem;
  std::vector<std::string> quantities;  ///< those that decide whether a run is stable

  /// Orders in h: largest edges on level 1, which fall by the factor 2^(-1/2) from level to level, and step
  /// sizes.
  HalvedSteps space;
  std::vector<double> space_h;  ///< by degree
  std::vector<int> space_k;     ///< by order

  /// Orders in tau: time counts from `begin` on, with the step sizes k = first_k, first_k + 1, ..
  HalvedSteps time;
  double begin;
  std::vector<double> time_h;  ///< by degree
  std::vector<int> first_k;    ///< by order

  double vertices;          ///< times 1/h²: about how many vertices a mesh has
  double seconds_per_node;  ///< of a step

  double edge_length(int degree, int level) const;  ///< of the meshes in space
};

/// All flows, in the order of the figures.
const std::vector<OrdersOfFlow>& orders_of_flows();

/// If a larger part of an error is caused by the steps, it is not the error in space.
constexpr double largest_share = 0.2;

/// Errors in space are extrapolated in tau until this order at least.
constexpr int order_of_extrapolated = 4;

/// One run.
struct OrderRun {
  OrdersOfFlow flow;
  int degree, bdf;
  bool in_time;           ///< order in tau, or in h
  int level;              ///< of the mesh
  int reference_k;        ///< in time: the small steps
  int first_power = bdf;  ///< in space: of the error in tau, as extrapolation takes it
};

/// Fills in a row, of which level, tau and steps are known.
///
/// In space: errors against the exact solution at the end time. The nodal values of BDF1, 2 and 3 are
/// extrapolated to tau = 0 from runs with tau, 2 tau, .. (richardson.hpp), of BDF1 with 2^0, .., 2^3 tau, so
/// that the error in time is of order 4. The same from 2 tau, 4 tau, .. shows what the steps cause: values:
/// "<quantity>_<norm>_share", about their part of the error, (difference of the two)/(2^p - 1)/error. p is q,
/// and q + 1 for extrapolated values: one order more, not all those that are expected. What exact starting
/// values add is of first order in tau, but in proportion to the error in space, so that it hides no order.
/// Where the share is more than `largest_share` the error does not show the order in h: it is stored as the
/// value "<quantity>_<norm>_hidden" instead.
///
/// In time: errors against small steps on the same mesh, with tau; values: "<quantity>_<norm>_double", those
/// with 2 tau.
///
/// Both: the value "unstable", 1 when a run ends before its time, or when the errors of one of the flow's
/// quantities are larger with tau than with 2 tau (in space: ten times, not extrapolated); the errors of an
/// unstable row are values "<quantity>_<norm>_unstable".
Row run_all_orders(const OrderRun& run, Row row);

}  // namespace esfem
