// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "solver/types.hpp"

namespace esfem {

/// A disturbance with values in [-1, 1]: the mean of 20 plane waves cos(k . (x - origin)/length + phase) in
/// the points x, with components of k up to 4 and phases drawn from the engine. A function of space alone,
/// the same for every mesh and machine.
Eigen::VectorXd plane_waves(const Field& x, const Vec3& origin, double length, std::mt19937& engine);

}  // namespace esfem
