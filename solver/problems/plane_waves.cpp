// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/plane_waves.hpp"

#include <cmath>

#include "solver/constants.hpp"

namespace esfem {

Eigen::VectorXd plane_waves(const Field& x, const Vec3& origin, double length, std::mt19937& engine) {
  const int waves = 20;
  const double largest_wave_number = 4;
  // The distributions of <random> differ from library to library, its engines do not.
  const auto between_minus_one_and_one = [&] { return 2.0 * engine() / std::mt19937::max() - 1; };
  const Field y = (x.rowwise() - origin.transpose()) / length;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
  for (int m = 0; m < waves; ++m) {
    Vec3 wave;
    for (int i = 0; i < 3; ++i) wave[i] = largest_wave_number * between_minus_one_and_one();
    const double phase = pi * between_minus_one_and_one();
    sum.array() += ((y * wave).array() + phase).cos();
  }
  return sum / waves;
}

}  // namespace esfem
