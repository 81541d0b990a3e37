// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/error.hpp"
#include "solver/linalg/gmres.hpp"

namespace esfem::test_gmres {
namespace {

/// I - B with a B that is not symmetric and has eigenvalues beyond 1: Neumann's series diverges.
struct Example {
  Eigen::MatrixXd B = 0.4 * Eigen::MatrixXd::Random(30, 30);
  Eigen::VectorXd solution = Eigen::VectorXd::LinSpaced(30, -1, 2);
  LinearMap map = [this](const Eigen::VectorXd& from, Eigen::VectorXd& to) { to = from - B * from; };
  Eigen::VectorXd rhs() const { return solution - B * solution; }
};

TEST(Gmres, SolvesWhereNeumannsSeriesDiverges) {
  const Example example;
  Eigen::VectorXd term = example.rhs();
  for (int k = 0; k < 100; ++k) term = example.B * term;
  ASSERT_GT(term.norm(), 10 * example.rhs().norm()) << "Neumann's series";
  Eigen::VectorXd y = Eigen::VectorXd::Zero(30);
  const int iterations = solve_gmres(example.map, example.rhs(), 1e-12, 40, y);
  EXPECT_LT((y - example.solution).norm(), 1e-9);
  EXPECT_GT(iterations, 10);
}

TEST(Gmres, AGoodGuessSavesIterations) {
  const Example example;
  Eigen::VectorXd y = example.solution;
  y[3] += 1e-9;
  EXPECT_LT(solve_gmres(example.map, example.rhs(), 1e-12, 40, y), 40);
  y = example.solution;
  EXPECT_LE(solve_gmres(example.map, example.rhs(), 1e-12, 40, y), 1);
}

TEST(Gmres, SaysWhenItDoesNotConverge) {
  const Example example;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(30);
  EXPECT_THAT([&] { solve_gmres(example.map, example.rhs(), 1e-12, 5, y); },
              testing::ThrowsMessage<NumericsError>(testing::HasSubstr("after 5 iterations")));
}

}  // namespace
}  // namespace esfem::test_gmres
