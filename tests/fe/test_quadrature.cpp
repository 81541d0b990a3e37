// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/fe/quadrature.hpp"

namespace esfem::test_quadrature {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// |quadrature - integral| of xi^a eta^b, whose integral is a! b! / (a+b+2)!. Summed in long double: what is
/// left is the error of the rule and of its printed digits.
double moment_error(const Quadrature& rule, int a, int b) {
  long double sum = 0;
  for (int q = 0; q < rule.weights.size(); ++q)
    sum += rule.weights(q) * std::pow((long double)rule.points(q, 0), a) *
           std::pow((long double)rule.points(q, 1), b);
  const long double exact =
      std::exp(std::lgamma(a + 1.0L) + std::lgamma(b + 1.0L) - std::lgamma(a + b + 3.0L));
  return double(std::abs(sum - exact));
}

/// Largest error among the monomials of exactly this total degree.
double error_at_degree(const Quadrature& rule, int degree) {
  double worst = 0;
  for (int a = 0; a <= degree; ++a) worst = std::max(worst, moment_error(rule, a, degree - a));
  return worst;
}

double error_up_to_degree(const Quadrature& rule, int degree) {
  double worst = 0;
  for (int d = 0; d <= degree; ++d) worst = std::max(worst, error_at_degree(rule, d));
  return worst;
}

void expect_positive_and_inside(const Quadrature& rule) {
  ASSERT_EQ(rule.points.rows(), rule.weights.size());
  EXPECT_GT(rule.weights.minCoeff(), 0) << rule.name;
  EXPECT_GT(rule.points.minCoeff(), 0) << rule.name;
  EXPECT_LT(rule.points.rowwise().sum().maxCoeff(), 1) << rule.name;
  EXPECT_NEAR(rule.weights.sum(), 0.5, 1e-15) << rule.name;
}

/// Largest distance of a permuted point from the nearest point of the rule with the same weight.
double asymmetry(const Quadrature& rule) {
  double worst = 0;
  for (int q = 0; q < rule.weights.size(); ++q) {
    const double xi = rule.points(q, 0), eta = rule.points(q, 1);
    std::array<double, 3> point = {1 - xi - eta, xi, eta};
    std::sort(point.begin(), point.end());
    do {
      double nearest = std::numeric_limits<double>::infinity();
      for (int p = 0; p < rule.weights.size(); ++p)
        if (rule.weights(p) == rule.weights(q))
          nearest = std::min(nearest, std::hypot(rule.points(p, 0) - point[1], rule.points(p, 1) - point[2]));
      worst = std::max(worst, nearest);
    } while (std::next_permutation(point.begin(), point.end()));
  }
  return worst;
}

const std::vector<int> tabulated = {1, 2, 4, 5, 6, 8, 9, 10, 12, 14};

class Symmetric : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degree, Symmetric, testing::ValuesIn(tabulated));

TEST_P(Symmetric, IsExactToItsDegreeAndNoFurther) {
  const Quadrature rule = symmetric_quadrature(GetParam());
  EXPECT_EQ(rule.degree, GetParam());
  EXPECT_LE(error_up_to_degree(rule, rule.degree), 1e-16);
  EXPECT_GT(error_at_degree(rule, rule.degree + 1), 1e-12);
}

TEST_P(Symmetric, HasPositiveWeightsAndInnerPoints) {
  expect_positive_and_inside(symmetric_quadrature(GetParam()));
}

TEST_P(Symmetric, IsInvariantUnderTheSixPermutations) {
  EXPECT_LE(asymmetry(symmetric_quadrature(GetParam())), 1e-15);
}

TEST(SymmetricQuadrature, TheConicalRuleIsNotInvariant) {
  EXPECT_GT(asymmetry(conical_quadrature(3)), 0.01);
}

TEST(SymmetricQuadrature, ACutOffDigitIsSeen) {
  Quadrature rule = symmetric_quadrature(8);
  rule.points(rule.points.rows() - 1, 0) += 1e-13;  // digits beyond those of the published tables
  EXPECT_GT(error_up_to_degree(rule, rule.degree), 1e-16);
}

TEST(SymmetricQuadrature, MissingDegreesGetTheNextRule) {
  for (int degree = 0; degree <= tabulated.back(); ++degree) {
    const int expected = *std::lower_bound(tabulated.begin(), tabulated.end(), degree);
    EXPECT_EQ(symmetric_quadrature(degree).degree, expected) << "asked for " << degree;
  }
  EXPECT_EQ(symmetric_quadrature(6).name, "symmetric degree 6 (12 points)");
}

TEST(SymmetricQuadrature, DegreesOutOfRangeNameTheLargestAndTheConicalRules) {
  EXPECT_THAT([] { symmetric_quadrature(15); },
              ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("degree 15"), HasSubstr("0 to 14"), HasSubstr("conical"))));
  EXPECT_THROW(symmetric_quadrature(-1), InputError);
}

class Conical : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Points, Conical, testing::Range(1, 11));

TEST_P(Conical, IsExactToTwiceItsPointsLessTwoAndNoFurther) {
  const int n = GetParam();
  const Quadrature rule = conical_quadrature(n);
  EXPECT_EQ(rule.points.rows(), n * n);
  EXPECT_EQ(rule.degree, 2 * n - 2);
  EXPECT_LE(error_up_to_degree(rule, rule.degree), 1e-16);
  EXPECT_GT(error_at_degree(rule, rule.degree + 1), 1e-13);
  expect_positive_and_inside(rule);
}

TEST(ConicalQuadrature, LargestRuleIsExactInEachVariable) {
  const Quadrature rule = conical_quadrature(64);
  EXPECT_EQ(rule.name, "conical 64x64");
  ASSERT_EQ(rule.degree, 126);
  for (int a = 0; a <= rule.degree; a += 3) {
    EXPECT_LE(moment_error(rule, a, 0), 1e-15) << a;
    EXPECT_LE(moment_error(rule, 0, a), 1e-15) << a;
    EXPECT_LE(moment_error(rule, a, rule.degree - a), 1e-15) << a;
  }
  expect_positive_and_inside(rule);
}

TEST(ConicalQuadrature, CollapsesTheSquareAlongLinesOfConstantEta) {
  // n = 2: Gauss points (1 -+ 1/sqrt 3)/2 with weights 1/2; each eta occurs twice, with xi = s (1 - eta).
  const Quadrature rule = conical_quadrature(2);
  const double low = (1 - 1 / std::sqrt(3.0)) / 2, high = 1 - low;
  for (double t : {low, high})
    for (double s : {low, high}) {
      int matches = 0;
      for (int q = 0; q < 4; ++q)
        if (std::abs(rule.points(q, 0) - s * (1 - t)) < 1e-15 && std::abs(rule.points(q, 1) - t) < 1e-15 &&
            std::abs(rule.weights(q) - (1 - t) / 4) < 1e-15)
          ++matches;
      EXPECT_EQ(matches, 1) << "s = " << s << ", t = " << t;
    }
}

TEST(ConicalQuadrature, NumbersOutOfRangeAreErrors) {
  for (int n : {-1, 0, 65}) EXPECT_THROW(conical_quadrature(n), InputError);
  EXPECT_THAT([] { conical_quadrature(65); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("n = 65"), HasSubstr("1 to 64"))));
}

TEST(DefaultQuadrature, IntegratesTheMassMatrixOfAFlatElementExactly) {
  for (int k = 1; k <= 4; ++k) EXPECT_GE(default_quadrature(k).degree, 2 * k);
  for (int k : {0, 5}) EXPECT_THROW(default_quadrature(k), InputError);
}

TEST(VertexQuadrature, LumpsTheMassMatrixOfP1) {
  const Quadrature rule = vertex_quadrature();
  EXPECT_DOUBLE_EQ(rule.weights.sum(), 0.5);
  const ShapeTable shapes = shape_functions(1, rule.points);
  const Eigen::MatrixXd mass = shapes.value.transpose() * rule.weights.asDiagonal() * shapes.value;
  EXPECT_TRUE(mass.isApprox(Eigen::MatrixXd::Identity(3, 3) / 6)) << mass;
}

}  // namespace
}  // namespace esfem::test_quadrature
