// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/nearly_round_sphere.hpp"

namespace esfem {

Surface nearly_round_sphere(double amplitude) {
  return ellipsoid(1 - amplitude / 2, 1 - amplitude / 2, 1 + amplitude);
}

double mode_amplitude(const Field& x) {
  const Eigen::ArrayXd r = x.rowwise().norm();
  Eigen::ArrayXd Y = 1.5 * (x.col(2).array() / r).square() - 0.5;
  Y -= Y.mean();
  return (r * Y).sum() / Y.square().sum();
}

}  // namespace esfem
