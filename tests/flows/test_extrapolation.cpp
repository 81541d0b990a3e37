// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "solver/flows/extrapolation.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/time/bdf.hpp"

namespace esfem::test_extrapolation {
namespace {

/// |u^400| of u' = -k⁴ u - a k² u with the last term extrapolated, from u^n = (-1)^n.
double size_after_steps(int order, double tau, double a, double k_squared) {
  const std::vector<double> delta = bdf_delta(order), gamma = bdf_gamma(order);
  std::deque<double> past;
  for (int n = 0; n < order; ++n) past.push_front(n % 2 == 0 ? 1 : -1);
  for (int n = 0; n < 400; ++n) {
    double known = 0, extrapolated = 0;
    for (int j = 0; j < order; ++j) {
      known += delta[j + 1] * past[j];
      extrapolated += gamma[j] * past[j];
    }
    past.push_front((-known / tau - a * k_squared * extrapolated) / (delta[0] / tau + k_squared * k_squared));
    past.pop_back();
  }
  return std::abs(past.front());
}

double largest_size(int order, double tau, double a) {
  double largest = 0;
  for (double k_squared = 1e-2 * a; k_squared < 1e2 * a; k_squared *= 1.01)
    largest = std::max(largest, size_after_steps(order, tau, a, k_squared));
  return largest;
}

TEST(Extrapolation, IsStableUpToTheBoundAndNotAboveIt) {
  const double a = 7;
  for (int order = 1; order <= max_bdf_order; ++order) {
    const double bound = largest_extrapolated_step(order, a);
    EXPECT_LT(largest_size(order, 0.95 * bound, a), 10) << order;
    EXPECT_GT(largest_size(order, 1.05 * bound, a), 100) << order;
  }
}

TEST(Extrapolation, TheWeingartenMapIsThatOfTheSurface) {
  // 2/R² on a sphere.
  const double R = 2;
  const Mesh mesh = icosphere(R, 3);
  Field u(mesh.nodes.rows(), 4);
  u << Field::Constant(mesh.nodes.rows(), 1, 2 / R), mesh.nodes / R;
  EXPECT_NEAR(largest_weingarten_squared(SurfaceSpace(mesh), mesh.nodes, u), 2 / (R * R), 5e-3);
}

}  // namespace
}  // namespace esfem::test_extrapolation
