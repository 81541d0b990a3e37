// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/least_squares.hpp"

namespace esfem {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values) {
  return terms.colPivHouseholderQr().solve(values);
}

double smallest_pivot(const Eigen::MatrixXd& terms) {
  const auto R = terms.colPivHouseholderQr().matrixQR().diagonal().cwiseAbs().eval();
  return R.minCoeff() / R.maxCoeff();
}

}  // namespace esfem
