// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

namespace esfem {

/// The c with the least |terms c - values|, by QR with column pivoting. terms: n x m, values: n.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values);

/// The smallest pivot of this QR factorisation over the largest one, about sigma_min / sigma_max: 0 when
/// columns depend on each other.
double smallest_pivot(const Eigen::MatrixXd& terms);

}  // namespace esfem
