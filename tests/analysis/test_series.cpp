// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/series.hpp"
#include "solver/error.hpp"

namespace esfem::test_series {
namespace {

TEST(Series, ValueIsThatAtOrAfterTheTimeOrTheLast) {
  const Series series = {{"t", {0, 0.1, 0.3}}, {"f", {5, 6, 7}}};
  EXPECT_EQ(value_at(series, "f", 0), 5);
  EXPECT_EQ(value_at(series, "f", 0.05), 6);
  EXPECT_EQ(value_at(series, "f", 0.1 * (1 + 1e-12)), 6) << "the same time up to round-off";
  EXPECT_EQ(value_at(series, "f", 0.2), 7);
  EXPECT_EQ(value_at(series, "f", 1), 7);
  EXPECT_THROW(first_at({{"t", {}}}, 0), InputError);
}

TEST(Series, NothingIsRecordedAtTimesBetweenStepsAndAfterTheEnd) {
  const Series series = {{"t", {0, 0.1, 0.3}}, {"f", {5, 6, 7}}};
  EXPECT_EQ(recorded_at(series, "f", 0.1 + 1e-12), 6);
  EXPECT_EQ(recorded_at(series, "f", 0.15), std::nullopt);
  EXPECT_EQ(recorded_at(series, "f", 0.4), std::nullopt);
}

TEST(Series, LargestRiseIsThatOfOneStep) {
  EXPECT_EQ(largest_rise({3, 1, 2, 4, 0, 1}), 2);
  EXPECT_EQ(largest_rise({3, 2, 1}), 0);
  EXPECT_EQ(largest_rise({}), 0);
}

TEST(Series, LargestDeviationIsOnEitherSide) {
  EXPECT_EQ(largest_deviation({1, 1.5, 0.25}, 1), 0.75);
  EXPECT_EQ(largest_deviation({1, 2, 0.25}, 1), 1);
}

TEST(Series, RatesAreThoseOfExponentials) {
  Series series;
  for (const double t : {0.0, 0.1, 0.25, 0.4, 0.7}) {
    series["t"].push_back(t);
    series["decaying"].push_back(3 * std::exp(-24 * t));
    series["growing"].push_back(t < 0.2 ? 1 : 1e-3 * std::exp(8 * t));
  }
  EXPECT_NEAR(decay_rate(series, "decaying", 0.1, 0.3), 24, 1e-12);
  EXPECT_NEAR(growth_rate(series.at("t"), series.at("growing"), 0.2), 8, 1e-12);
  EXPECT_GT(std::abs(growth_rate(series.at("t"), series.at("growing"), 0) - 8), 1) << "the start is left out";
}

}  // namespace
}  // namespace esfem::test_series
