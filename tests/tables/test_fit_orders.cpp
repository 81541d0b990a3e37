// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>
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

bool inside(double value, const std::optional<ObservedOrder>& observed) {
  return observed && observed->ci95 && (*observed->ci95)[0] <= value && value <= (*observed->ci95)[1];
}

TEST(FitOrders, CleanDataGiveTheOrders) {
  const OrderFit fit = grid(5, 8, 0.03, 2.1, 4, 3.2).fit();
  EXPECT_TRUE(fit.h && fit.tau);
  EXPECT_NEAR(fit.h->order, 2.1, 1e-6);
  EXPECT_NEAR(fit.tau->order, 3.2, 1e-6);
  EXPECT_NEAR(fit.constant_h, 0.03, 1e-6);
  EXPECT_NEAR(fit.constant_tau, 4, 1e-4);
  EXPECT_EQ(fit.rows_used, 40);
  EXPECT_NEAR((*fit.h->ci95)[1] - (*fit.h->ci95)[0], 0.04, 1e-6) << "no order is known better than to 0.02";
}

TEST(FitOrders, AllOrdersOfTheMethodsAreFound) {
  for (double p : {1, 2, 3, 4})
    for (double q : {1, 2, 3, 4, 5}) {
      // Both terms are equal in the middle of the grid.
      const OrderFit fit = grid(5, 8, 1e-3 * std::pow(0.25, -p), p, 1e-3 * std::pow(0.02, -q), q).fit();
      EXPECT_NEAR(fit.h->order, p, 1e-4) << "p = " << p << ", q = " << q;
      EXPECT_NEAR(fit.tau->order, q, 1e-4) << "p = " << p << ", q = " << q;
    }
}

/// Relative standard deviations of the scatter of single rows, of all rows of a mesh in their error in space,
/// and of all rows of a step size in their error in time.
struct Scatter {
  double rows = 0, meshes = 0, step_sizes = 0;
};

/// The grid with e = 0.03 h² + C_tau tau³, both equal in the middle of a 5 x 6 grid with C_tau = 20.
Samples scattered(int meshes, int step_sizes, double C_tau, Scatter scatter, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto factor = [&](double deviation) { return std::exp(deviation * normal(generator)); };
  std::vector<double> of_mesh(meshes), of_step_size(step_sizes);
  for (double& value : of_mesh) value = factor(scatter.meshes);
  for (double& value : of_step_size) value = factor(scatter.step_sizes);
  Samples samples = grid(meshes, step_sizes, 0.03, 2, C_tau, 3);
  for (int j = 0; j < meshes; ++j)
    for (int k = 0; k < step_sizes; ++k) {
      const int i = j * step_sizes + k;
      const double in_space = 0.03 * std::pow(samples.h[i], 2), in_time = C_tau * std::pow(samples.tau[i], 3);
      samples.error[i] = (of_mesh[j] * in_space + of_step_size[k] * in_time) * factor(scatter.rows);
    }
  return samples;
}

/// How often an interval is given, and how often one that is given contains the order.
struct Coverage {
  int given = 0, covered = 0;
  double mean_order = 0;
  void add(double truth, const std::optional<ObservedOrder>& observed) {
    if (!observed || !observed->ci95) return;
    ++given;
    covered += inside(truth, observed);
    mean_order += (observed->order - mean_order) / given;
  }
};

const int trials = 400;

void expect_95_percent(const Coverage& coverage, double truth) {
  EXPECT_GE(coverage.given, 0.8 * trials) << "no interval is no answer";
  EXPECT_GE(coverage.covered, 0.90 * coverage.given) << "of " << coverage.given;
  EXPECT_LE(coverage.covered, 0.98 * coverage.given) << "of " << coverage.given << ": too wide to be of use";
  EXPECT_NEAR(coverage.mean_order, truth, 0.05);
}

std::pair<Coverage, Coverage> coverage_of(int meshes, int step_sizes, double C_tau, Scatter scatter) {
  std::mt19937 generator(1);
  Coverage h, tau;
  for (int i = 0; i < trials; ++i) {
    const Samples samples = scattered(meshes, step_sizes, C_tau, scatter, generator);
    try {
      const OrderFit fit = samples.fit();
      h.add(2, fit.h);
      tau.add(3, fit.tau);
    } catch (const NumericsError&) {  // no order
    }
  }
  return {h, tau};
}

TEST(FitOrders, IntervalsCoverUnderIndependentScatter) {
  const auto [h, tau] = coverage_of(5, 6, 20, {0.1, 0, 0});
  expect_95_percent(h, 2);
  expect_95_percent(tau, 3);
}

TEST(FitOrders, IntervalsCoverUnderScatterThatAMeshShares) {
  expect_95_percent(coverage_of(5, 6, 20, {0, 0.1, 0}).first, 2);
}

TEST(FitOrders, IntervalsCoverUnderScatterThatAStepSizeShares) {
  expect_95_percent(coverage_of(5, 6, 20, {0, 0, 0.05}).second, 3);
}

TEST(FitOrders, IntervalsOfThreeMeshesCover) {
  expect_95_percent(coverage_of(3, 5, 20, {0, 0.1, 0}).first, 2);
  // Nothing to be seen in time, and scatter that a plateau would explain
  expect_95_percent(coverage_of(3, 5, 1e-9, {0.02, 0.1, 0}).first, 2);
}

TEST(FitOrders, IntervalsOfSingleSeriesCover) {
  for (int runs : {3, 4, 5}) {
    SCOPED_TRACE(runs);
    expect_95_percent(coverage_of(runs, 1, 1e-9, {0.1, 0, 0}).first, 2);
    const Coverage in_tau = coverage_of(1, runs, 1e6, {0.1, 0, 0}).second;
    expect_95_percent(in_tau, 3);
  }
}

TEST(FitOrders, SlopesThatStillFallHaveALimitAndNoInterval) {
  for (int meshes : {4, 5, 6})
    for (int step_sizes : {1, 6}) {
      Samples samples = grid(meshes, step_sizes, 0, 2, step_sizes > 1 ? 20 : 0, 3);
      for (std::size_t i = 0; i < samples.h.size(); ++i)
        samples.error[i] += 0.03 * std::pow(samples.h[i], 2) * (1 + samples.h[i]);
      const OrderFit fit = samples.fit();
      SCOPED_TRACE(meshes);
      ASSERT_TRUE(fit.h.has_value());
      EXPECT_FALSE(fit.h->ci95.has_value()) << "around " << fit.h->order;
      EXPECT_THAT(fit.h->remark, HasSubstr("falling, 2.3 -> 2."));
      ASSERT_TRUE(fit.h->limit.has_value());
      EXPECT_LT((*fit.h->limit)[0], 2);
      EXPECT_GT((*fit.h->limit)[1], 2);
      EXPECT_EQ(fit.h->slopes.size(), meshes - 1u);
      EXPECT_NEAR(fit.h->slopes[0], 2 + std::log(1.5 / (1 + std::sqrt(0.125))) / std::log(std::sqrt(2)),
                  0.01);
    }
}

TEST(FitOrders, AChangeOfSignHasNoInterval) {
  Samples samples = grid(5, 6, 0, 0, 0, 0);
  for (std::size_t i = 0; i < samples.h.size(); ++i)
    samples.error[i] = std::abs(0.03 * std::pow(samples.h[i], 2) - 20 * std::pow(samples.tau[i], 3));
  const OrderFit fit = samples.fit();
  for (const std::optional<ObservedOrder>& observed : {fit.h, fit.tau})
    if (observed) {
      EXPECT_FALSE(observed->ci95.has_value());
      EXPECT_EQ(observed->remark, "the error changes sign");
    }
}

TEST(FitOrders, LargeScatterHasNoInterval) {
  Samples samples = grid(8, 1, 0.03, 2, 0, 3);
  for (int i = 0; i < 8; ++i) samples.error[i] *= (i + 1) % 4 < 2 ? 1.3 : 1 / 1.3;
  const OrderFit fit = samples.fit();
  ASSERT_TRUE(fit.h.has_value());
  EXPECT_FALSE(fit.h->ci95.has_value());
  EXPECT_THAT(fit.h->remark, HasSubstr("the scatter of log e is 0.31"));
}

TEST(FitOrders, APlateauIsNoOrder) {
  const OrderFit fit = with_noise(grid(1, 6, 1e-3, 0, 1e-9, 3), 0.02, 1).fit();
  ASSERT_TRUE(fit.tau.has_value());
  EXPECT_EQ(fit.tau->remark, "no dependence");
  EXPECT_NEAR(fit.tau->order, 0, 0.1);
}

TEST(FitOrders, TwoMeshesHaveNoInterval) {
  const OrderFit fit = grid(2, 6, 0.03, 2, 20, 3).fit();
  ASSERT_TRUE(fit.h && fit.tau);
  EXPECT_FALSE(fit.h->ci95.has_value());
  EXPECT_EQ(fit.h->remark, "two meshes");
  EXPECT_TRUE(fit.tau->ci95.has_value());
}

TEST(FitOrders, OutliersNeedTheRobustLoss) {
  const double tolerance = 0.05;
  Samples samples = with_noise(grid(1, 12, 0, 2, 4, 3), 0.02, 1);
  samples.error[0] *= 3;
  samples.error[10] /= 3;
  EXPECT_NEAR(samples.fit().tau->order, 3, tolerance);

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
  for (int seed = 0; seed < 10; ++seed) {
    Samples samples = with_noise(grid(5, 8, 0.03, 2, 4, 3), 0.1, seed);
    samples.error[(7 * seed) % 40] *= 3;
    samples.error[(11 * seed + 20) % 40] /= 3;
    const OrderFit fit = samples.fit();
    ASSERT_TRUE(fit.h && fit.tau) << "seed " << seed;
    EXPECT_NEAR(fit.h->order, 2, 0.25) << "seed " << seed;
    EXPECT_NEAR(fit.tau->order, 3, 0.25) << "seed " << seed;
  }
}

TEST(FitOrders, OnlyTauWithPlateau) {
  const OrderFit clean = grid(1, 8, 1e-3, 0, 4, 3).fit();
  EXPECT_FALSE(clean.h.has_value());
  EXPECT_TRUE(clean.tau.has_value());
  EXPECT_NEAR(clean.tau->order, 3, 1e-5);
  EXPECT_NEAR(clean.constant_h, 1e-3, 1e-7);

  int covered = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const OrderFit fit = with_noise(grid(1, 8, 1e-3, 0, 4, 3), 0.1, seed).fit();
    EXPECT_NEAR(fit.tau->order, 3, 0.5) << "seed " << seed;
    covered += inside(3, fit.tau);
  }
  EXPECT_GE(covered, 17);
}

TEST(FitOrders, OnlyHWithPlateau) {
  const OrderFit fit = grid(6, 1, 0.3, 3, 1e-2, 0).fit();
  EXPECT_TRUE(fit.h.has_value());
  EXPECT_FALSE(fit.tau.has_value());
  EXPECT_NEAR(fit.h->order, 3, 1e-4);
  EXPECT_NEAR(fit.constant_tau, 1e-2, 1e-5);
}

TEST(FitOrders, OneVariableWithoutPlateauIsAPowerLaw) {
  const OrderFit in_tau = grid(1, 6, 0, 2, 4, 3).fit();
  EXPECT_TRUE(in_tau.tau.has_value());
  EXPECT_FALSE(in_tau.h.has_value());
  EXPECT_NEAR(in_tau.tau->order, 3, 1e-8);
  EXPECT_EQ(in_tau.constant_h, 0);

  const OrderFit in_h = with_noise(grid(5, 1, 0.03, 2, 0, 1), 0.05, 3).fit();
  EXPECT_TRUE(in_h.h.has_value());
  EXPECT_FALSE(in_h.tau.has_value());
  EXPECT_NEAR(in_h.h->order, 2, 0.15);
  EXPECT_TRUE(inside(2, in_h.h));

  const OrderFit three_rows = grid(1, 3, 0, 2, 4, 3).fit();
  EXPECT_NEAR(three_rows.tau->order, 3, 1e-8);
}

TEST(FitOrders, AnInvisibleTermHasNoOrder) {
  for (double noise : {0.0, 0.05}) {
    const OrderFit only_h = with_noise(grid(5, 4, 0.03, 2, 1e-9, 3), noise, 5).fit();
    EXPECT_TRUE(only_h.h.has_value());
    EXPECT_FALSE(only_h.tau.has_value());
    EXPECT_NEAR(only_h.h->order, 2, 0.1);

    const OrderFit only_tau = with_noise(grid(3, 6, 1e-12, 2, 4, 3), noise, 6).fit();
    EXPECT_FALSE(only_tau.h.has_value());
    EXPECT_TRUE(only_tau.tau.has_value());
    EXPECT_NEAR(only_tau.tau->order, 3, 0.1);
  }
}

TEST(FitOrders, ATermSeenInAFewRowsDoesNotSpoilTheOther) {
  // The h term is half of the error in one row of 12, and little elsewhere.
  const OrderFit fit = with_noise(grid(3, 4, 1e-3, 4, 4, 3), 0.1, 2).fit();
  EXPECT_TRUE(fit.tau.has_value());
  EXPECT_FALSE(fit.h.has_value());
  EXPECT_GT(fit.constant_h, 0);
  EXPECT_NEAR(fit.tau->order, 3, 0.1);
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
