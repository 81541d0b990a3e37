// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "solver/error.hpp"
#include "solver/linalg/least_squares.hpp"
#include "solver/tables/fit_orders.hpp"

namespace esfem::test_fit_orders {
namespace {

using testing::AllOf, testing::HasSubstr;

struct Samples {
  std::vector<double> h, tau, error;
  OrderFit fit() const { return fit_orders(h, tau, error); }
};

/// The published grid of kll19: h = 0.5 2^(-j/2), tau = 0.2 2^-k, with e = C_h h^p + C_tau tau^q.
Samples grid(int meshes, int step_sizes, double C_h, double p, double C_tau, double q) {
  Samples samples;
  for (int j = 0; j < meshes; ++j)
    for (int k = 0; k < step_sizes; ++k) {
      const double h = 0.5 * std::pow(2, -0.5 * j), tau = 0.2 * std::pow(2, -k);
      samples.h.push_back(h);
      samples.tau.push_back(tau);
      samples.error.push_back(C_h * std::pow(h, p) + C_tau * std::pow(tau, q));
    }
  return samples;
}

Samples with_noise(Samples samples, double relative, unsigned seed) {
  std::mt19937 generator(seed);
  for (double& error : samples.error) error *= 1 + relative * (2.0 * generator() / generator.max() - 1);
  return samples;
}

bool inside(double value, const double (&interval)[2]) {
  return interval[0] <= value && value <= interval[1];
}

TEST(FitOrders, CleanDataGiveTheOrders) {
  const OrderFit fit = grid(5, 8, 0.03, 2.1, 4, 3.2).fit();
  EXPECT_TRUE(fit.has_h && fit.has_tau);
  EXPECT_NEAR(fit.order_h, 2.1, 1e-6);
  EXPECT_NEAR(fit.order_tau, 3.2, 1e-6);
  EXPECT_NEAR(fit.constant_h, 0.03, 1e-6);
  EXPECT_NEAR(fit.constant_tau, 4, 1e-4);
  EXPECT_EQ(fit.rows_used, 40);
  EXPECT_LT(fit.ci95_h[1] - fit.ci95_h[0], 1e-4);
}

TEST(FitOrders, AllOrdersOfTheMethodsAreFound) {
  for (double p : {1, 2, 3, 4})
    for (double q : {1, 2, 3, 4, 5}) {
      // Both terms are equal in the middle of the grid.
      const OrderFit fit = grid(5, 8, 1e-3 * std::pow(0.25, -p), p, 1e-3 * std::pow(0.02, -q), q).fit();
      EXPECT_NEAR(fit.order_h, p, 1e-4) << "p = " << p << ", q = " << q;
      EXPECT_NEAR(fit.order_tau, q, 1e-4) << "p = " << p << ", q = " << q;
    }
}

TEST(FitOrders, NoiseOfTenPercentIsInsideTheInterval) {
  const int trials = 40;
  int covered_h = 0, covered_tau = 0;
  double width = 0;
  for (int seed = 0; seed < trials; ++seed) {
    const OrderFit fit = with_noise(grid(5, 8, 0.03, 2, 4, 3), 0.1, seed).fit();
    ASSERT_TRUE(fit.has_h && fit.has_tau) << "seed " << seed;
    EXPECT_NEAR(fit.order_h, 2, 0.25) << "seed " << seed;
    EXPECT_NEAR(fit.order_tau, 3, 0.25) << "seed " << seed;
    covered_h += inside(2, fit.ci95_h);
    covered_tau += inside(3, fit.ci95_tau);
    width += (fit.ci95_tau[1] - fit.ci95_tau[0]) / trials;
  }
  RecordProperty("covered_h", covered_h);
  RecordProperty("covered_tau", covered_tau);
  EXPECT_GE(covered_h, 0.8 * trials);
  EXPECT_GE(covered_tau, 0.8 * trials);
  EXPECT_LT(width, 0.3) << "an interval that covers only because it is wide is useless";
}

TEST(FitOrders, OutliersNeedTheRobustLoss) {
  const double tolerance = 0.05;
  Samples samples = with_noise(grid(1, 12, 0, 2, 4, 3), 0.02, 1);
  samples.error[0] *= 3;
  samples.error[10] /= 3;
  EXPECT_NEAR(samples.fit().order_tau, 3, tolerance);

  Eigen::MatrixXd line(12, 2);
  Eigen::VectorXd value(12);
  for (int i = 0; i < 12; ++i) {
    line.row(i) << 1, std::log(samples.tau[i]);
    value(i) = std::log(samples.error[i]);
  }
  const double plain = least_squares(line, value)[1];
  EXPECT_GT(std::abs(plain - 3), tolerance) << "the outliers are too weak for this test";
}

TEST(FitOrders, NoiseAndOutliersTogether) {
  int covered_h = 0, covered_tau = 0;
  for (int seed = 0; seed < 10; ++seed) {
    Samples samples = with_noise(grid(5, 8, 0.03, 2, 4, 3), 0.1, seed);
    samples.error[(7 * seed) % 40] *= 3;
    samples.error[(11 * seed + 20) % 40] /= 3;
    const OrderFit fit = samples.fit();
    EXPECT_NEAR(fit.order_h, 2, 0.25) << "seed " << seed;
    EXPECT_NEAR(fit.order_tau, 3, 0.25) << "seed " << seed;
    covered_h += inside(2, fit.ci95_h);
    covered_tau += inside(3, fit.ci95_tau);
  }
  EXPECT_GE(covered_h, 8);
  EXPECT_GE(covered_tau, 8);
}

TEST(FitOrders, OnlyTauWithPlateau) {
  const OrderFit clean = grid(1, 8, 1e-3, 0, 4, 3).fit();
  EXPECT_FALSE(clean.has_h);
  EXPECT_TRUE(clean.has_tau);
  EXPECT_NEAR(clean.order_tau, 3, 1e-5);
  EXPECT_NEAR(clean.constant_h, 1e-3, 1e-7);

  int covered = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const OrderFit fit = with_noise(grid(1, 8, 1e-3, 0, 4, 3), 0.1, seed).fit();
    EXPECT_NEAR(fit.order_tau, 3, 0.5) << "seed " << seed;
    covered += inside(3, fit.ci95_tau);
  }
  EXPECT_GE(covered, 17);
}

TEST(FitOrders, OnlyHWithPlateau) {
  const OrderFit fit = grid(6, 1, 0.3, 3, 1e-2, 0).fit();
  EXPECT_TRUE(fit.has_h);
  EXPECT_FALSE(fit.has_tau);
  EXPECT_NEAR(fit.order_h, 3, 1e-4);
  EXPECT_NEAR(fit.constant_tau, 1e-2, 1e-5);
}

TEST(FitOrders, OneVariableWithoutPlateauIsAPowerLaw) {
  const OrderFit in_tau = grid(1, 6, 0, 2, 4, 3).fit();
  EXPECT_TRUE(in_tau.has_tau);
  EXPECT_FALSE(in_tau.has_h);
  EXPECT_NEAR(in_tau.order_tau, 3, 1e-8);
  EXPECT_EQ(in_tau.constant_h, 0);

  const OrderFit in_h = with_noise(grid(5, 1, 0.03, 2, 0, 1), 0.05, 3).fit();
  EXPECT_TRUE(in_h.has_h);
  EXPECT_FALSE(in_h.has_tau);
  EXPECT_NEAR(in_h.order_h, 2, 0.15);
  EXPECT_TRUE(inside(2, in_h.ci95_h));

  const OrderFit three_rows = grid(1, 3, 0, 2, 4, 3).fit();
  EXPECT_NEAR(three_rows.order_tau, 3, 1e-8);
}

TEST(FitOrders, AnInvisibleTermHasNoOrder) {
  for (double noise : {0.0, 0.05}) {
    const OrderFit only_h = with_noise(grid(5, 4, 0.03, 2, 1e-9, 3), noise, 5).fit();
    EXPECT_TRUE(only_h.has_h);
    EXPECT_FALSE(only_h.has_tau) << "order " << only_h.order_tau;
    EXPECT_NEAR(only_h.order_h, 2, 0.1);

    const OrderFit only_tau = with_noise(grid(3, 6, 1e-12, 2, 4, 3), noise, 6).fit();
    EXPECT_FALSE(only_tau.has_h) << "order " << only_tau.order_h;
    EXPECT_TRUE(only_tau.has_tau);
    EXPECT_NEAR(only_tau.order_tau, 3, 0.1);
  }
}

TEST(FitOrders, ATermSeenInAFewRowsDoesNotSpoilTheOther) {
  // The h term is half of the error in one row of 12, and little elsewhere.
  const OrderFit fit = with_noise(grid(3, 4, 1e-3, 4, 4, 3), 0.1, 2).fit();
  EXPECT_TRUE(fit.has_tau);
  EXPECT_FALSE(fit.has_h) << "order " << fit.order_h;
  EXPECT_GT(fit.constant_h, 0);
  EXPECT_NEAR(fit.order_tau, 3, 0.1);
}

std::string input_error(const Samples& samples) {
  try {
    samples.fit();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FitOrders, TooFewRowsAreAnErrorAndNoNumber) {
  EXPECT_THAT(input_error({}), HasSubstr("0 rows, at least 3"));
  EXPECT_THAT(input_error(grid(1, 2, 0, 2, 4, 3)), HasSubstr("2 rows, at least 3"));
  EXPECT_THAT(input_error(grid(2, 2, 0.1, 2, 4, 3)), HasSubstr("4 rows, at least 5"));
  EXPECT_THAT(input_error({{1, 1, 1}, {1, 1, 1}, {1, 2, 3}}), HasSubstr("neither h nor tau varies"));
}

TEST(FitOrders, ErrorsThatAreNotPositiveAreAnError) {
  for (double bad : {0.0, -1e-3, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Samples samples = grid(1, 5, 0, 2, 4, 3);
    samples.error[2] = bad;
    EXPECT_THAT(input_error(samples), AllOf(HasSubstr("row 3"), HasSubstr("positive")));
  }
}

TEST(FitOrders, ScatterWithoutALawIsNoOrder) {
  EXPECT_THROW(fit_orders({1, 1, 1, 1}, {0.1, 0.09, 0.08, 0.07}, {1e-3, 1, 1e-3, 1}), NumericsError);
}

Table table_of(const Samples& samples) {
  Table table;
  for (std::size_t i = 0; i < samples.error.size(); ++i) {
    Row row;
    row.cell = std::to_string(i);
    row.h = samples.h[i];
    row.tau = samples.tau[i];
    row.errors["x"] = {{"nodal_L2", samples.error[i]}, {"nodal_H1", 1e-12 * samples.error[i]}};
    table.rows.push_back(row);
  }
  return table;
}

TEST(FitTable, FitsWhatIsAboveRoundOff) {
  const std::vector<Fit> fits = fit_table(table_of(grid(5, 8, 0.03, 2, 4, 3)), {});
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_EQ(fits[0].variable, "h");
  EXPECT_EQ(fits[1].variable, "tau");
  EXPECT_EQ(fits[1].norm, "nodal_L2");
  EXPECT_NEAR(fits[1].order, 3, 1e-5);
  EXPECT_EQ(fits[1].rows_used, 40);
}

TEST(FitTable, LeavesOutFailedRowsAndRowsOutOfRange) {
  Table table = table_of(grid(5, 8, 0.03, 2, 4, 3));
  table.rows[3].status = "failed: degenerate element 7";
  table.rows[3].errors["x"]["nodal_L2"] = std::nan("");
  RowRange range;
  range.tau_max = 0.05;
  for (Row& row : table.rows)
    if (row.tau > 0.051) row.errors["x"]["nodal_L2"] = 1;
  const std::vector<Fit> fits = fit_table(table, range);
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_NEAR(fits[1].order, 3, 1e-5);
  EXPECT_EQ(fits[1].rows_used, 29);
}

TEST(FitTable, FitsEachVariantByItself) {
  Table table = table_of(grid(1, 5, 0, 2, 4, 3));
  EXPECT_TRUE(fit_table(table, {})[0].labels.empty());
  const Table slow = table_of(grid(1, 5, 0, 2, 4, 1));
  for (Row row : slow.rows) {
    row.labels = {{"flow", "dziuk"}, {"bdf", 4}};
    table.rows.push_back(row);
  }
  const std::vector<Fit> fits = fit_table(table, {});
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_TRUE(fits[0].labels.empty());
  EXPECT_NEAR(fits[0].order, 3, 1e-5);
  EXPECT_EQ(fits[1].labels.dump(), R"({"bdf":4,"flow":"dziuk"})");
  EXPECT_NEAR(fits[1].order, 1, 1e-5);
  // A row of a third variant has no order of its own and changes none.
  table.rows[2].labels["flow"] = "other";
  EXPECT_EQ(fit_table(table, {}).size(), 2u);
}

}  // namespace
}  // namespace esfem::test_fit_orders
