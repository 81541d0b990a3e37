// SPDX-License-Identifier: GPL-3.0-or-later
// The program cahn_hilliard_pfhub on a coarse mesh, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "solver/error.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_cahn_hilliard_pfhub {
namespace {

namespace fs = std::filesystem;

/// The energies of a row at the recorded steps around a time.
std::pair<double, double> energies_around(const Row& row, double t) {
  const std::vector<double>&times = row.series.at("t"), &energy = row.series.at("energy");
  const auto after = std::lower_bound(times.begin(), times.end(), t) - times.begin();
  return {energy.at(after - 1), energy.at(after)};
}

/// The table of a run of the program.
Table table_of(const std::string& arguments, const fs::path& folder) {
  fs::create_directories(folder);
  const std::string command = std::string(ESFEM_BINARY_DIR) + "/bin/cahn_hilliard_pfhub " + arguments +
                              " --output " + (folder / "table.json").string() + " 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), exit_done) << command;
  return table_from_json(read_json((folder / "table.json").string()), "table.json");
}

const fs::path root = fs::path(ESFEM_BINARY_DIR) / "test_pfhub" / std::to_string(getpid());

// An order of elimination that differs from process to process would show.
TEST(CahnHilliardPfhub, IsRepeatedToTheBit) {
  const Table table = table_of("--levels 1 --end_time 1", root / "first");
  EXPECT_EQ(table.rows.at(0).series, table_of("--levels 1 --end_time 1", root / "second").rows.at(0).series);
  fs::remove_all(root);
}

TEST(CahnHilliardPfhub, RecordsEnergiesDomainsAndSnapshots) {
  const Table table = table_of("--stepping adaptive,moose --levels 0 --end_time 20", root);
  ASSERT_EQ(table.rows.size(), 2u);
  for (const Row& row : table.rows) {
    SCOPED_TRACE(row.cell);
    EXPECT_EQ(row.status, "ok");
    for (const char* name : {"energy", "domains", "min_c", "max_c"})
      EXPECT_EQ(row.series.at(name).size(), row.series.at("t").size()) << name;
    // What 2,932 linear nodes leave of 1002.05: the area of the inscribed polyhedron is smaller.
    EXPECT_NEAR(row.values.at("initial_energy"), 1001.33, 0.01);
    EXPECT_LT(row.values.at("mass_drift"), 1e-12);
    EXPECT_LT(row.values.at("largest_rise"), 0);
    EXPECT_EQ(row.values.at("last_domains"), row.series.at("domains").back());
    EXPECT_GE(row.values.at("last_domains"), 2);
    EXPECT_EQ(row.more.at("snapshots").size(), 3u);
    for (const char* time : {"6.1051", "14.158"}) {
      const double t = std::atof(time), energy = row.values.at(std::string("energy_at_") + time);
      const auto [before, after] = energies_around(row, t * (1 - 1e-4));
      EXPECT_LE(energy, before) << time;
      EXPECT_GE(energy, after) << time;
    }
  }
  const Row &adaptive = table.rows[0], &moose = table.rows[1];
  EXPECT_EQ(adaptive.series.at("t").back(), 20);
  EXPECT_NEAR(moose.series.at("t").at(5), 6.1051, 1e-12);
  EXPECT_NEAR(moose.series.at("t").at(20), 30.26275, 1e-12);
  EXPECT_EQ(moose.values.at("energy_at_6.1051"), moose.series.at("energy").at(5));
  EXPECT_EQ(adaptive.values.count("energy_at_30.263"), 0u);
  EXPECT_GT(adaptive.values.at("energy_at_14.158") - moose.values.at("energy_at_14.158"), 50)
      << "large steps of backward Euler decompose too early";
  fs::remove_all(root);
}

}  // namespace
}  // namespace esfem::test_cahn_hilliard_pfhub
