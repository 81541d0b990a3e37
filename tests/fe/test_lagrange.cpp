// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"

namespace esfem::test_lagrange {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Points in general position: inner ones, one on an edge, one outside.
Points some_points() {
  Points points(5, 2);
  points << 0.21, 0.34, 0.62, 0.07, 1.0 / 3, 1.0 / 3, 0.45, 0.55, -0.2, 0.9;
  return points;
}

/// xi^a eta^b (0 for a negative exponent, which comes with the factor 0 of a derivative).
double monomial(int a, int b, double xi, double eta) {
  return a < 0 || b < 0 ? 0 : std::pow(xi, a) * std::pow(eta, b);
}

class Lagrange : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degree, Lagrange, testing::Range(1, max_degree + 1));

TEST_P(Lagrange, IsOneAtItsNodeAndZeroAtTheOthers) {
  const int k = GetParam(), n = nodes_per_element(k);
  EXPECT_EQ(n, (k + 1) * (k + 2) / 2);
  const Points nodes = reference_nodes(k);
  ASSERT_EQ(nodes.rows(), n);
  EXPECT_LE((shape_functions(k, nodes).value - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_P(Lagrange, SumsToOne) {
  const ShapeTable shape = shape_functions(GetParam(), some_points());
  EXPECT_LE((shape.value.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
  EXPECT_LE(shape.dxi.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LE(shape.deta.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(Lagrange, ReproducesMonomialsAndTheirDerivativesUpToItsDegreeOnly) {
  const int k = GetParam();
  const Points nodes = reference_nodes(k), points = some_points();
  const ShapeTable shape = shape_functions(k, points);
  for (int a = 0; a <= k + 1; ++a)
    for (int b = 0; a + b <= k + 1; ++b) {
      Eigen::VectorXd nodal(nodes.rows()), value(points.rows()), dxi(points.rows()), deta(points.rows());
      for (int n = 0; n < nodes.rows(); ++n) nodal(n) = monomial(a, b, nodes(n, 0), nodes(n, 1));
      for (int q = 0; q < points.rows(); ++q) {
        const double xi = points(q, 0), eta = points(q, 1);
        value(q) = monomial(a, b, xi, eta);
        dxi(q) = a * monomial(a - 1, b, xi, eta);
        deta(q) = b * monomial(a, b - 1, xi, eta);
      }
      const double error = (shape.value * nodal - value).cwiseAbs().maxCoeff();
      if (a + b > k) {
        EXPECT_GT(error, 1e-4) << "xi^" << a << " eta^" << b;
        continue;
      }
      EXPECT_LE(error, 1e-14) << "xi^" << a << " eta^" << b;
      EXPECT_LE((shape.dxi * nodal - dxi).cwiseAbs().maxCoeff(), 1e-13) << "xi^" << a << " eta^" << b;
      EXPECT_LE((shape.deta * nodal - deta).cwiseAbs().maxCoeff(), 1e-13) << "xi^" << a << " eta^" << b;
    }
}

TEST_P(Lagrange, DerivativesAreThoseOfTheValues) {
  const int k = GetParam();
  const double step = 1e-5;
  const Points points = some_points();
  const ShapeTable shape = shape_functions(k, points);
  for (int direction = 0; direction < 2; ++direction) {
    Points before = points, after = points;
    before.col(direction).array() -= step;
    after.col(direction).array() += step;
    const Eigen::MatrixXd difference =
        (shape_functions(k, after).value - shape_functions(k, before).value) / (2 * step);
    const Eigen::MatrixXd& derivative = direction == 0 ? shape.dxi : shape.deta;
    EXPECT_LE((derivative - difference).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST_P(Lagrange, NodesStandInGmshOrder) {
  const int k = GetParam();
  const Points nodes = reference_nodes(k);
  Eigen::Matrix<double, 3, 2> corners;
  corners << 0, 0, 1, 0, 0, 1;
  EXPECT_EQ(nodes.topRows(3), corners);
  int row = 3;
  for (int edge = 0; edge < 3; ++edge)
    for (int m = 1; m < k; ++m) {
      const double s = double(m) / k;  // from the edge's first corner to its second
      const Eigen::RowVector2d expected = (1 - s) * corners.row(edge) + s * corners.row((edge + 1) % 3);
      EXPECT_LE((nodes.row(row) - expected).norm(), 1e-15) << "edge " << edge << ", node " << m;
      ++row;
    }
}

TEST(LagrangeNodes, InnerNodesOfCubicsAndQuartics) {
  EXPECT_LE((reference_nodes(3).row(9) - Eigen::RowVector2d(1, 1) / 3).norm(), 1e-15);
  Points inner(3, 2);
  inner << 0.25, 0.25, 0.5, 0.25, 0.25, 0.5;
  EXPECT_EQ(reference_nodes(4).bottomRows(3), inner);
}

TEST(LagrangeErrors, NameTheDegreeAndTheAcceptedOnes) {
  for (int degree : {-1, 0, 5}) {
    EXPECT_THROW(nodes_per_element(degree), InputError);
    EXPECT_THROW(reference_nodes(degree), InputError);
    EXPECT_THROW(shape_functions(degree, some_points()), InputError);
  }
  EXPECT_THAT([] { nodes_per_element(5); },
              testing::ThrowsMessage<InputError>(
                  testing::AllOf(testing::HasSubstr("degree 5"), testing::HasSubstr("expected 1 to 4"))));
}

}  // namespace
}  // namespace esfem::test_lagrange
