// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "solver/surfaces/surface.hpp"
#include "solver/types.hpp"

namespace esfem {

/// The root mean square of the distances of the nodes x (N x 3) from the surface: the error of positions up
/// to tangential motion of the nodes.
inline double distance(const Surface& surface, const Field& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 node = x.row(i).transpose();
    sum += (node - surface.closest_point(node)).squaredNorm();
  }
  return std::sqrt(sum / x.rows());
}

}  // namespace esfem
