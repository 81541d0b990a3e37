// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/tables/table.hpp"

namespace esfem {

/// Which rows enter a fit (bounds inclusive, with 1e-9 relative slack).
struct RowRange {
  /// Bounds of the step size and of the mesh's h.
  /// @{
  double tau_min = 0, tau_max = 1e300, h_min = 0, h_max = 1e300;
  /// @}
};

/// A quantity whose errors are all below this is not fitted.
constexpr double round_off = 1e-10;

/// Whether tau and h of the row are in the range.
bool in_range(const Row& row, const RowRange& range);

/// The order in one variable that rows show.
struct ObservedOrder {
  double order = 0;              ///< p or q of OrderFit
  std::optional<Interval> ci95;  ///< none where `remark` says why

  /// Slopes between neighbouring meshes (or step sizes), coarse to fine, where the term is at least a fifth
  /// of the error; the other term is taken off.
  std::vector<double> slopes;
  /// Where the slopes rise or fall: from the last of them to where they end if they change twice as much as
  /// an error C s^p (1 + c s) does, linearly in s.
  std::optional<Interval> limit;
  std::string remark;  ///< "" or what the order means: why there is no interval, "no dependence"
};

/// Observed orders p, q of e = C_h h^p + C_tau tau^q (positive C), from all given rows at once.
struct OrderFit {
  /// p and q, where the rows determine them.
  /// @{
  std::optional<ObservedOrder> h, tau;
  /// @}

  /// C_h and C_tau; 0: the term is not in the model.
  /// @{
  double constant_h = 0, constant_tau = 0;
  /// @}

  int rows_used = 0;  ///< all that were given
};

/// Fits log e = log(C_h h^p + C_tau tau^q) by Ceres with Cauchy's loss (power_law.hpp).
///
/// Rows that share a mesh or a step size share a part of their errors. So a group, all rows of one mesh or of
/// one step size, is what counts:
/// - The full model or one with a single term is selected by the Bayesian information criterion with the
///   number of groups, so that a term without effect is omitted. When only one variable varies, the other
///   term is a plateau; a plateau beside an order needs four groups.
/// - 95% intervals are those of the jackknife (Efron, Stein, Ann. Statist. 9, 1981) that leaves out one group
///   after the other, with Student's t of one degree of freedom less than groups in which the term is seen:
///   its share of the error is three times the scatter, a fifth at most. Three such groups are needed, and an
///   interval is +- 0.02 at least.
/// - An order counts as determined when its standard error is at most 1.
///
/// There is no interval where the rms residual of log e is above 0.2, where the error changes sign (a dip
/// between larger errors on both sides), and where slopes rise or fall by more than 0.1 from the first pair
/// of groups to the last: by less and less from pair to pair, or significantly (at 5%) against the scatter
/// about a parabola in log h or log tau. Three groups cannot show that.
///
/// Throws InputError, which says how many rows there are and how many are needed, when there are too few
/// rows, nothing varies, or a number is not positive; NumericsError when the rows determine no order.
OrderFit fit_orders(const std::vector<double>& h, const std::vector<double>& tau,
                    const std::vector<double>& error);

/// Fits for every variant, quantity and norm of the rows with status "ok" in the range, but for those at
/// round-off and those whose orders the data do not determine. Rows of different variants have no common
/// order.
std::vector<Fit> fit_table(const Table& table, const RowRange& range);

}  // namespace esfem
