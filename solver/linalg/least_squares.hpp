// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

namespace esfem {

/// The c with the least |terms c - values|, by QR with column pivoting. terms: n x m, values: n.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values);

}  // namespace esfem
