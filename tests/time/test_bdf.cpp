// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "solver/error.hpp"
#include "solver/time/bdf.hpp"

namespace esfem::test_bdf {
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

struct Weights {
  std::vector<double> delta, gamma;
};
Weights in_vectors(int q, const BdfWeights& weights) {
  return {{weights.delta.begin(), weights.delta.begin() + q + 1},
          {weights.gamma.begin(), weights.gamma.begin() + q}};
}
Weights weights(int q, const std::vector<double>& old, double t) {
  return in_vectors(q, bdf_weights(q, old.data(), t));
}

TEST(BdfWeights, AreTheUsualOnesForEqualSteps) {
  const double tau = 0.037;
  for (int q = 1; q <= max_bdf_order; ++q) {
    SCOPED_TRACE(q);
    std::vector<double> old;
    for (int j = 0; j < q; ++j) old.push_back(-j * tau);
    const auto [delta, gamma] = weights(q, old, tau);
    const auto [equal_delta, equal_gamma] = in_vectors(q, bdf_weights(q));
    for (const auto& found : {delta, equal_delta}) expect_near(found, bdf_delta(q));
    for (const auto& found : {gamma, equal_gamma}) expect_near(found, bdf_gamma(q));
  }
}

TEST(BdfWeights, OfOrderTwoAreTheTextbooks) {
  for (const double w : {0.1, 0.5, 1.0, 1.5, 2.4}) {
    const double t = 0.7, before = 0.03;
    const auto [delta, gamma] = weights(2, {t, t - before}, t + w * before);
    expect_near(delta, {(1 + 2 * w) / (1 + w), -(1 + w), w * w / (1 + w)});
    expect_near(gamma, {1 + w, -w});
  }
}

TEST(BdfWeights, AreExactForPolynomialsOnAnyTimes) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> step(0.3, 1.5);
  for (int q = 1; q <= max_bdf_order; ++q)
    for (int sample = 0; sample < 20; ++sample) {
      const double t = 1.3;
      std::vector<double> old = {t - step(generator)};
      while (int(old.size()) < q) old.push_back(old.back() - step(generator));
      const auto [delta, gamma] = weights(q, old, t);
      const double tau = t - old[0];
      for (int m = 0; m <= q + 1; ++m) {
        const auto value = [&](double s) { return std::pow(s - t, m); };
        double derivative = delta[0] * value(t) / tau, extrapolated = 0;
        for (int j = 0; j < q; ++j) derivative += delta[j + 1] * value(old[j]) / tau;
        for (int j = 0; j < q; ++j) extrapolated += gamma[j] * value(old[j]);
        const double derivative_error = std::abs(derivative - (m == 1 ? 1 : 0));
        const double extrapolation_error = std::abs(extrapolated - (m == 0 ? 1 : 0));
        if (m <= q)
          EXPECT_LT(derivative_error, 1e-10) << "q = " << q << ", degree " << m;
        else
          EXPECT_GT(derivative_error, 1e-2) << "q = " << q << ": the order is higher than it can be";
        if (m < q)
          EXPECT_LT(extrapolation_error, 1e-10) << "q = " << q << ", degree " << m;
        else
          EXPECT_GT(extrapolation_error, 1e-3) << "q = " << q << ": the order is higher than it can be";
      }
    }
}

TEST(BdfWeights, NeedIncreasingTimes) {
  EXPECT_THROW(weights(1, {0}, 0), InputError);
  EXPECT_THROW(weights(2, {1, 1}, 2), InputError);
  EXPECT_THROW(weights(2, {1, 0}, 0.5), InputError);
  EXPECT_THROW(weights(1, {0}, std::nan("")), InputError);
}

TEST(Bdf, OtherOrdersAreErrors) {
  for (int q : {-1, 0, 6}) {
    EXPECT_THROW(bdf_delta(q), InputError);
    EXPECT_THROW(bdf_gamma(q), InputError);
  }
}

}  // namespace
}  // namespace esfem::test_bdf
