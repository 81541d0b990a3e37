// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/tables/table.hpp"

namespace esfem::test_export_table {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::Not;

Row row(const std::string& cell, int level, double h, double tau, double error) {
  Row row;
  row.cell = cell;
  row.level = level;
  row.h = h;
  row.nodes = 100 * level;
  row.tau = tau;
  row.steps = 4;
  row.errors["x"]["nodal_L2"] = error;
  return row;
}

/// Two meshes whose h differ by a factor that is not 2, and two step sizes; rows in no order.
Table sample_table() {
  Table table;
  table.experiment = "mcf_sphere";
  table.paper = "kll19";
  table.rows = {row("b", 1, 0.5, 0.05, 1e-3), row("a", 1, 0.5, 0.1, 8e-3), row("c", 2, 0.4, 0.1, 0.8 * 8e-3)};
  table.fits = {{"x", "nodal_L2", "tau", 2.96, Interval{2.9, 3}, {}, "", 3}};
  return table;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Csv, HasARowALineAndAnErrorAColumn) {
  Table table = sample_table();
  table.rows[0].labels = {{"variant", "a \"b\", c"}, {"bdf", 3}};
  table.rows[2].more["note"] = "late";
  table.rows[2].status = "failed: step 2, t = 0.1: degenerate element 7";
  table.rows[2].errors["x"]["nodal_L2"] = std::nan("");
  table.rows[1].errors["nu"]["nodal_H1"] = 0.1;
  EXPECT_THAT(
      lines_of(to_csv(table)),
      ElementsAre(
          "cell,level,h,nodes,tau,steps,status,seconds,peak_memory_mb,bdf,note,variant,x_nodal_L2,nu_nodal_"
          "H1",
          "b,1,0.5,100,0.050000000000000003,4,ok,0,0,3,,\"a \"\"b\"\", c\",0.001,",
          "a,1,0.5,100,0.10000000000000001,4,ok,0,0,,,,0.0080000000000000002,0.10000000000000001",
          "c,2,0.40000000000000002,200,0.10000000000000001,4,\"failed: step 2, t = 0.1: degenerate element "
          "7\",0,0,,late,,,"));
}

TEST(Latex, PrintsOrdersBetweenNeighbours) {
  const std::vector<std::string> lines = lines_of(to_latex(sample_table()));
  const auto from = [&](const std::string& line) { return std::find(lines.begin(), lines.end(), line); };
  const auto block = from("\\multicolumn{3}{l}{$h = 0.5$, $N = 100$} \\\\");
  ASSERT_LT(lines.end() - block, lines.end() - lines.begin()) << "no block of the first mesh";
  ASSERT_GE(lines.end() - block, 3);
  EXPECT_EQ(block[1], "$0.1$ & $8.000\\cdot10^{-3}$ & -- \\\\");
  EXPECT_EQ(block[2], "$0.05$ & $1.000\\cdot10^{-3}$ & $3.00$ \\\\");
  EXPECT_NE(from("fit & & $2.96$ \\\\"), lines.end());

  // In h: log(1/0.8) / log(0.5/0.4) = 1, from the measured h.
  const auto step = from("\\multicolumn{3}{l}{$\\tau = $ $0.1$} \\\\");
  ASSERT_GE(lines.end() - step, 3);
  EXPECT_EQ(step[1], "$0.5$ & $8.000\\cdot10^{-3}$ & -- \\\\");
  EXPECT_EQ(step[2], "$0.4$ & $6.400\\cdot10^{-3}$ & $1.00$ \\\\");
  EXPECT_NE(from("fit & & -- \\\\"), lines.end());
}

TEST(Latex, FailedRowsSayWhyAndBreakTheOrders) {
  Table table = sample_table();
  table.rows.push_back(row("d", 1, 0.5, 0.025, 1.25e-4));
  table.rows[0].status = "failed: |nu_h| > 2 & 100%";
  const std::string text = to_latex(table);
  EXPECT_THAT(text, HasSubstr("$0.05$ & \\multicolumn{2}{l}{failed: |nu\\_h| > 2 \\& 100\\%} \\\\\n"
                              "$0.025$ & $1.250\\cdot10^{-4}$ & -- \\\\\n"));
}

TEST(Latex, VariantsAreBlocksOfTheirOwn) {
  Table table = sample_table();
  table.rows.push_back(row("e", 1, 0.5, 0.025, 1));
  table.rows.back().labels["variant"] = "dziuk";
  EXPECT_THAT(to_latex(table),
              HasSubstr("$N = 100$, variant=dziuk} \\\\\n$0.025$ & $1.000\\cdot10^{0}$ & -- \\\\\n"));
}

TEST(Latex, RowsWithoutErrorsAreNoBlocks) {
  Table table = sample_table();
  const std::string before = to_latex(table);
  table.rows.push_back(row("d", 1, 0.5, 0.1, 0));
  table.rows.back().errors.clear();
  table.rows.back().labels["flow"] = "cost";
  EXPECT_EQ(to_latex(table), before);
  table.rows.back().status = "failed: why";
  EXPECT_THAT(to_latex(table), testing::HasSubstr("failed: why"));
}

TEST(Latex, OnlyOfWhatIsThere) {
  EXPECT_THAT(to_latex(Table{}), Not(HasSubstr("tabular")));
}

TEST(Latex, OnlyInWhatChanges) {
  Table table = sample_table();
  table.rows = {row("a", 1, 0.5, 0.1, 8e-3), row("b", 2, 0.25, 0.1, 1e-3)};
  EXPECT_THAT(to_latex(table), AllOf(HasSubstr("orders in $h$"), Not(HasSubstr("orders in $\\tau$"))));
  table.rows[1] = row("b", 1, 0.5, 0.05, 1e-3);
  EXPECT_THAT(to_latex(table), AllOf(HasSubstr("orders in $\\tau$"), Not(HasSubstr("orders in $h$"))));
  table.rows.pop_back();
  EXPECT_THAT(to_latex(table), HasSubstr("orders in $h$")) << "the errors of one run";
  EXPECT_THAT(to_latex(table), HasSubstr("% mcf_sphere (kll19); needs"));
  table.paper = "";
  EXPECT_THAT(to_latex(table), HasSubstr("% mcf_sphere; needs"));
}

TEST(Latex, EachVariantHasItsFits) {
  Table table = sample_table();
  table.fits = {{"x", "nodal_L2", "tau", 2.9, Interval{2.8, 3}, {}, "", 5, {{"flow", "kll"}}},
                {"x", "nodal_L2", "tau", 1.1, Interval{1, 1.2}, {}, "", 5, {{"flow", "dziuk"}}}};
  EXPECT_THAT(to_latex(table),
              HasSubstr("\\midrule\nfit, flow=dziuk & & $1.10$ \\\\\nfit, flow=kll & & $2.90$ \\\\\n"));
}

TEST(Values, AreColumnsOfTheirOwn) {
  Table table;
  table.experiment = "mcf_dumbbell";
  table.rows = {row("a", 0, 0.2, 0.003, 1), row("b", 0, 0.2, 0.0015, 1)};
  for (Row& row : table.rows) row.errors.clear();
  table.rows[0].values["pinch_time"] = 0.0825;
  table.rows[0].status = "singular at t = 0.0825 (step 27): element 7";
  EXPECT_THAT(to_csv(table), HasSubstr(",peak_memory_mb,pinch_time\n"));
  EXPECT_THAT(to_csv(table), HasSubstr(",0.082500000000000004\n"));
  const std::string text = to_latex(table);
  EXPECT_THAT(text, HasSubstr("& $N$ & $\\tau$ & pinch\\_time \\\\\n"));
  EXPECT_THAT(text, HasSubstr("& $0.003$ & $0.0825$ \\\\\n"));
  EXPECT_THAT(text, Not(HasSubstr("0.0015")));
}

}  // namespace
}  // namespace esfem::test_export_table
