// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "solver/types.hpp"

namespace esfem {

/// A smooth periodic function with values in R^components from its values on a uniform grid, by local
/// polynomials of degree 7 (the error is of order 8 in the grid's width).
template <int components>
class PeriodicTable {
 public:
  /// A column for each point of the grid.
  using Values = Eigen::Matrix<double, components, Eigen::Dynamic>;

  /// values: the column j belongs to the argument j period/n, j = 0, ..., n - 1, n >= 8.
  PeriodicTable(double period, const Values& values)
      : period_(period), size_(static_cast<int>(values.cols())), values_(components, size_ + points) {
    for (int j = 0; j < size_ + points; ++j) values_.col(j) = values.col((j - left + size_) % size_);
  }

  /// The length after which the function repeats.
  double period() const { return period_; }

  /// The value at s, which need not be in the first period.
  Eigen::Matrix<double, components, 1> operator()(double s) const {
    const double position = s / period_ - std::floor(s / period_);
    const int cell = std::min(static_cast<int>(position * size_), size_ - 1);
    return values_.template middleCols<points>(cell) * weights(position * size_ - cell);
  }

 private:
  static constexpr int points = 8, left = 3;

  /// Lagrange's polynomials of the nodes -3, ..., 4 in f.
  static Eigen::Matrix<double, points, 1> weights(double f) {
    static constexpr double inverse_products[points] = {-1.0 / 5040, 1.0 / 720, -1.0 / 240, 1.0 / 144,
                                                        -1.0 / 144,  1.0 / 240, -1.0 / 720, 1.0 / 5040};
    Eigen::Matrix<double, points, 1> weight;
    double before = 1, after = 1;
    for (int i = 0; i < points; ++i) {
      weight[i] = before * inverse_products[i];
      before *= f - (i - left);
    }
    for (int i = points - 1; i >= 0; --i) {
      weight[i] *= after;
      after *= f - (i - left);
    }
    return weight;
  }

  double period_;
  int size_;
  Values values_;  ///< continued periodically, so that each polynomial's columns are neighbours
};

}  // namespace esfem
