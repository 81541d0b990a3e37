// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/tables/table.hpp"

namespace esfem {

/// Which rows enter a fit (bounds inclusive, with 1e-9 relative slack).
struct RowRange {
  double tau_min = 0, tau_max = 1e300, h_min = 0, h_max = 1e300;
};

/// A quantity whose errors are all below this is not fitted.
constexpr double round_off = 1e-10;

bool in_range(const Row& row, const RowRange& range);

/// Observed orders p, q of e = C_h h^p + C_tau tau^q (positive C), from all given rows at once.
struct OrderFit {
  bool has_h = false, has_tau = false;  ///< the variable varies and the data determine its order
  double order_h = 0, ci95_h[2] = {0, 0};
  double order_tau = 0, ci95_tau[2] = {0, 0};
  double constant_h = 0, constant_tau = 0;  ///< 0: the term is not in the model
  int rows_used = 0;
};

/// Fits log e = log(C_h h^p + C_tau tau^q) by Ceres with Cauchy's loss; 95% intervals from the covariance
/// (scaled by the residual variance, Student's t). When only one variable varies, the other term is a
/// constant plateau.
///
/// The full model or one with a single term is selected by the Bayesian information criterion, so that a term
/// without effect on the data is omitted. An order counts as determined (has_h, has_tau) when its standard
/// error is at most 1/2; a term that shows in a few rows only stays in the model without one.
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
