// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/least_squares.hpp"

namespace esfem {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values) {
  return terms.colPivHouseholderQr().solve(values);
}

}  // namespace esfem
