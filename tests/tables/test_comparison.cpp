// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/tables/comparison.hpp"

namespace esfem::test_comparison {
namespace {

Row row_of(const char* flow, int bdf, int level, double distance, double error) {
  Row row;
  row.labels = {{"flow", flow}, {"bdf", bdf}, {"degree", 2}};
  row.level = level;
  row.tau = 0.1;
  row.values = {{"distance", distance}};
  row.errors["x"]["nodal_L2"] = error;
  return row;
}

TEST(Comparison, DividesByTheRowOfTheSameMeshStepSizeAndOtherLabels) {
  Table table;
  table.rows = {row_of("kll19", 3, 0, 2, 8), row_of("dziuk", 3, 0, 3, 2), row_of("bgn", 1, 1, 7, 9),
                row_of("kll19", 3, 1, 5, 3)};
  add_ratios({{{"flow", "kll19"}, {"bdf", 3}}, "_over_kll19", {"distance", "x_nodal_L2"}}, table);
  EXPECT_EQ(table.rows[1].values.at("distance_over_kll19"), 1.5);
  EXPECT_EQ(table.rows[1].values.at("x_nodal_L2_over_kll19"), 0.25);
  EXPECT_EQ(table.rows[2].values.at("distance_over_kll19"), 1.4);
  EXPECT_EQ(table.rows[2].values.at("x_nodal_L2_over_kll19"), 3);
  EXPECT_EQ(table.rows[0].values.size(), 1) << "a row is not compared with itself";
}

TEST(Comparison, MayBeWithAnotherMeshOrStepSize) {
  Table table;
  table.rows = {row_of("dziuk", 3, 0, 4, 8), row_of("dziuk", 3, 1, 2, 2), row_of("dziuk", 3, 0, 1, 1)};
  table.rows[2].tau = 0.025;
  add_ratios({nlohmann::json::object(), "_over_coarser", {"distance"}, -1}, table);
  add_ratios({nlohmann::json::object(), "_over_larger_tau", {"distance"}, 0, 4}, table);
  using Values = std::map<std::string, double>;
  EXPECT_EQ(table.rows[1].values, (Values{{"distance", 2}, {"distance_over_coarser", 0.5}}));
  EXPECT_EQ(table.rows[2].values, (Values{{"distance", 1}, {"distance_over_larger_tau", 0.25}}));
  EXPECT_EQ(table.rows[0].values.size(), 1);
}

TEST(Comparison, HasNoRatioWithoutAPartnerOrItsNumber) {
  Table table;
  table.rows = {row_of("kll19", 3, 0, 0, 8), row_of("dziuk", 3, 0, 3, 2), row_of("bgn", 1, 1, 7, 9),
                row_of("dziuk", 3, 0, 3, 2)};
  table.rows[3].tau = 0.05;
  table.rows[1].errors.clear();
  add_ratios({{{"flow", "kll19"}, {"bdf", 3}}, "_over_kll19", {"distance", "x_nodal_L2", "none"}}, table);
  for (const Row& row : table.rows) EXPECT_EQ(row.values.size(), 1);
}

}  // namespace
}  // namespace esfem::test_comparison
