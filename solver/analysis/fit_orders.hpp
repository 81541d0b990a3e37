// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/analysis/table.hpp"

namespace esfem {

/// Which rows enter a fit (bounds inclusive, with 1e-9 relative slack).
struct RowRange {
  double tau_min = 0, tau_max = 1e300, h_min = 0, h_max = 1e300;
};

/// Observed orders p, q of e = C_h h^p + C_tau tau^q (positive C), from all given rows at once.
struct OrderFit {
  bool has_h = false, has_tau = false;  ///< the variable varies and its term is identified by the data
  double order_h = 0, ci95_h[2] = {0, 0};
  double order_tau = 0, ci95_tau[2] = {0, 0};
  double constant_h = 0, constant_tau = 0;
  int rows_used = 0;
};

/// Fits log e = log(C_h h^p + C_tau tau^q) by Ceres with a robust loss; 95% intervals from the covariance
/// (scaled by the residual variance, Student's t). When only one variable varies, the other term is a
/// constant plateau. Throws InputError, which says how many rows there are and how many are needed, when the
/// data cannot determine the orders (too few rows, no variation, errors that are not positive), NumericsError
/// when Ceres finds no usable solution.
OrderFit fit_orders(const std::vector<double>& h, const std::vector<double>& tau,
                    const std::vector<double>& error);

/// Fits for every quantity and norm of the rows with status "ok" in the range (max over rows of one norm >
/// 1e-10, so that round-off is not fitted); quantities whose orders the data cannot determine are left out.
std::vector<Fit> fit_table(const Table& table, const RowRange& range);

}  // namespace esfem
