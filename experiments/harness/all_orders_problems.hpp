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

  /// Orders in h: largest edges on level 0, halved after two levels, and step sizes.
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

/// One run.
struct OrderRun {
  OrdersOfFlow flow;
  int degree, bdf;
  bool in_time;     ///< order in tau, or in h
  int level;        ///< of the mesh
  int reference_k;  ///< in time: the small steps
};

/// Fills in a row, of which level, tau and steps are known.
///
/// In space: errors against the exact solution at the end time. values: "<quantity>_<norm>_share", about the
/// part of the error that is caused by the steps, (difference between tau and 2 tau)/(2^q - 1)/error. Where
/// this is more than `largest_share` the error does not show the order in h: it is stored as the value
/// "<quantity>_<norm>_hidden" instead. In time: errors against small steps on the same mesh, with tau;
/// values: "<quantity>_<norm>_double", those with 2 tau. Both: the value "unstable", 1 when a run ends before
/// its time, or when the errors of one of the flow's quantities are larger with tau than with 2 tau (in
/// space: ten times); the errors of an unstable row are values "<quantity>_<norm>_unstable".
Row run_all_orders(const OrderRun& run, Row row);

/// If a larger part of an error is caused by the steps, it is not the error in space.
constexpr double largest_share = 0.2;

}  // namespace esfem
