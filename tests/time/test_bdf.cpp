// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "solver/error.hpp"
#include "solver/time/bdf.hpp"

namespace esfem {
namespace {

// The coefficients as textbooks print them (Hairer, Wanner: Solving ODEs II, chapter V).
const std::vector<std::vector<double>> textbook_delta = {
    {1, -1},
    {3. / 2, -2, 1. / 2},
    {11. / 6, -3, 3. / 2, -1. / 3},
    {25. / 12, -4, 3, -4. / 3, 1. / 4},
    {137. / 60, -5, 5, -10. / 3, 5. / 4, -1. / 5},
};
const std::vector<std::vector<double>> textbook_gamma = {
    {1}, {2, -1}, {3, -3, 1}, {4, -6, 4, -1}, {5, -10, 10, -5, 1},
};

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t j = 0; j < found.size(); ++j) EXPECT_NEAR(found[j], expected[j], 1e-14) << "j = " << j;
}

TEST(Bdf, CoefficientsAreTheTextbooks) {
  for (int q = 1; q <= max_bdf_order; ++q) {
    SCOPED_TRACE(q);
    expect_near(bdf_delta(q), textbook_delta[q - 1]);
    expect_near(bdf_gamma(q), textbook_gamma[q - 1]);
  }
}

TEST(Bdf, DerivativeIsExactUpToDegreeQ) {
  for (int q = 1; q <= max_bdf_order; ++q) {
    const std::vector<double> delta = bdf_delta(q);
    // d/ds s^m at s = 0 from the values at 0, -1, .., -q.
    for (int m = 0; m <= q + 1; ++m) {
      double sum = 0;
      for (int j = 0; j <= q; ++j) sum += delta[j] * std::pow(-j, m);
      const double error = std::abs(sum - (m == 1 ? 1 : 0));
      if (m <= q)
        EXPECT_LT(error, 1e-11) << "q = " << q << ", degree " << m;
      else
        EXPECT_GT(error, 1e-2) << "q = " << q << ": the order is higher than it can be";
    }
  }
}

TEST(Bdf, ExtrapolationIsExactUpToDegreeQMinus1) {
  for (int q = 1; q <= max_bdf_order; ++q) {
    const std::vector<double> gamma = bdf_gamma(q);
    EXPECT_NEAR(std::accumulate(gamma.begin(), gamma.end(), 0.0), 1, 1e-14);
    for (int m = 0; m <= q; ++m) {
      double value = 0;
      for (int j = 0; j < q; ++j) value += gamma[j] * std::pow(-1 - j, m);
      const double error = std::abs(value - (m == 0 ? 1 : 0));
      if (m < q)
        EXPECT_LT(error, 1e-11) << "q = " << q << ", degree " << m;
      else
        EXPECT_GT(error, 1e-2) << "q = " << q << ": the order is higher than it can be";
    }
  }
}

TEST(Bdf, OtherOrdersAreErrors) {
  for (int q : {-1, 0, 6}) {
    EXPECT_THROW(bdf_delta(q), InputError);
    EXPECT_THROW(bdf_gamma(q), InputError);
  }
}

}  // namespace
}  // namespace esfem
