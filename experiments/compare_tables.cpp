// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compares the errors of a table with those of an independent implementation, row by row
//
// Sample runs:  build/bin/compare_tables results/check/independent/mcf_sphere.json
// reference/independent/table_mcf_sphere.json
//
// The independent table has {"rows": [{"nodes", "tau", "errors"}]} with maxima over the steps n >=
// --from-step, so the same maxima are formed here from the series of the rows with the same number of nodes
// and the same step size.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"

namespace {

using namespace esfem;

/// One error, as computed here and independently.
struct Pair {
  double own, independent;
  double deviation() const { return std::abs(own / independent - 1); }
};

const Row& find_row(const Table& table, int nodes, double tau) {
  for (const Row& row : table.rows) {
    if (row.nodes == nodes && std::abs(row.tau - tau) <= 1e-9 * tau) return row;
  }
  throw InputError(
      format("the table has no row with %d nodes and tau = %g, but the independent one has", nodes, tau));
}

int compare(const Table& table, const nlohmann::json& independent, int first, double tolerance,
            double floor) {
  int agreeing = 0, differing = 0;
  std::printf("%6s %10s %-4s %-16s %14s %14s %10s\n", "nodes", "tau", "", "norm", "here", "independent",
              "deviation");
  for (const auto& expected : independent.at("rows")) {
    const int nodes = expected.at("nodes").get<int>();
    const double tau = expected.at("tau").get<double>();
    const Row& row = find_row(table, nodes, tau);
    for (const auto& [quantity, norms] : expected.at("errors").items()) {
      for (const auto& [norm, value] : norms.items()) {
        const Pair pair{maximum_from(row, quantity, norm, first), value.get<double>()};
        if (std::max(pair.own, pair.independent) < floor) continue;  // round-off
        const bool agrees = pair.deviation() <= tolerance;
        ++(agrees ? agreeing : differing);
        std::printf("%6d %10g %-4s %-16s %14.6e %14.6e %10.1e%s\n", nodes, tau, quantity.c_str(),
                    norm.c_str(), pair.own, pair.independent, pair.deviation(), agrees ? "" : "  DIFFERS");
      }
    }
  }
  std::printf("%d of %d errors agree to %g%%\n", agreeing, agreeing + differing, 100 * tolerance);
  return differing == 0 && agreeing > 0 ? exit_done : exit_claim;
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] {
    std::string table, independent;
    int first = 0;
    double tolerance = 1e-3, floor = 1e-7;
    CommandLine line(
        "Compares the errors of a table with those of an independent implementation and prints both.\n"
        "Example: compare_tables table.json reference/independent/table_mcf_sphere.json --from-step 3",
        "compare_tables");
    line.argument("table", table, "table of an experiment, with series", "TABLE.json");
    line.argument("independent", independent, "the other table", "OTHER.json");
    line.integer("--from-step", 0, 1000000000, first, "the maxima are over the steps from this one on");
    line.number("--tolerance", tolerance, "relative deviation allowed");
    line.number("--floor", floor, "errors below this in both tables are not compared");
    if (!line.parse(argc, argv)) return static_cast<int>(exit_done);
    return compare(table_from_json(read_json(table), table), read_json(independent), first, tolerance, floor);
  });
}
