// SPDX-License-Identifier: GPL-3.0-or-later
// The programs cahn_hilliard_energy, cahn_hilliard_initial_values and cahn_hilliard_ellipsoid on coarse
// meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"

namespace esfem::test_energy_and_initial_values {
namespace {

namespace fs = std::filesystem;

struct Programs : testing::Test {
  fs::path folder = fs::path(ESFEM_BINARY_DIR) / "test_cahn_hilliard" / std::to_string(getpid());

  Programs() { fs::create_directories(folder); }
  ~Programs() override { fs::remove_all(folder); }

  int exit_code(const std::string& arguments) const {
    const std::string command = std::string(ESFEM_BINARY_DIR) + "/bin/" + arguments + " --output " +
                                (folder / "table.json").string() + " 2>/dev/null";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  Table table_of(const std::string& arguments) const {
    EXPECT_EQ(exit_code(arguments), exit_done) << arguments;
    return table_from_json(read_json((folder / "table.json").string()), "table.json");
  }
};

TEST_F(Programs, TheEnergyRisesWithTheSurfaceAndTheMassStays) {
  const Table table = table_of("cahn_hilliard_energy --levels 0,1 --end_time 0.03");
  ASSERT_EQ(table.rows.size(), 2u);
  for (const Row& row : table.rows) {
    SCOPED_TRACE(row.cell);
    EXPECT_EQ(row.series.at("t").size(), 301u);
    EXPECT_LT(row.values.at("mass_drift"), 1e-12);
    EXPECT_GT(row.values.at("first_rise"), 0.3);
    EXPECT_GT(row.values.at("first_maximum_time"), 0.005);
    EXPECT_LT(row.values.at("first_maximum_time"), 0.015);
    EXPECT_EQ(row.values.count("first_minimum_time"), 0u) << "beyond the end";
    EXPECT_NEAR(row.values.at("variation"), 1, 1e-6);
    EXPECT_GT(std::abs(row.values.at("variation_as_printed") - 1), 1) << "energy without epsilon";
  }
  EXPECT_EQ(table.rows[0].nodes, 54);
  EXPECT_EQ(table.rows[1].nodes, 120);
}

TEST_F(Programs, TheDerivativeOfUConvergesLikeUAndItsGradientLikeH) {
  const Table table = table_of("cahn_hilliard_ellipsoid --run derivative --levels 1,2 --steps 3");
  ASSERT_EQ(table.rows.size(), 2u);
  const auto order = [&](const char* norm) {
    const auto error = [&](const Row& row) { return row.errors.at("u_derivative").at(norm); };
    return std::log(error(table.rows[0]) / error(table.rows[1])) /
           std::log(table.rows[0].h / table.rows[1].h);
  };
  EXPECT_GT(order("lifted_L2"), 1.7);
  EXPECT_GT(order("lifted_H1_semi"), 0.9);
  EXPECT_LT(order("lifted_H1_semi"), 1.4);
}

TEST_F(Programs, TheLoadAsPrintedIsTooLarge) {
  const auto error = [&](const std::string& runs) {
    return table_of("cahn_hilliard_ellipsoid --bdf 1 --levels 0 --steps 3 --run " + runs)
        .rows.at(0)
        .errors.at("u")
        .at("nodal_L2");
  };
  EXPECT_GT(error("printed"), 3 * error("ritz_theta"));
}

TEST_F(Programs, RefuseStartingValuesThatNobodyKnows) {
  EXPECT_EQ(exit_code("cahn_hilliard_energy --start exact"), exit_usage);
  EXPECT_EQ(exit_code("cahn_hilliard_initial_values --start exact"), exit_usage);
  EXPECT_EQ(exit_code("cahn_hilliard_energy --levels 8"), exit_usage);
  EXPECT_EQ(exit_code("cahn_hilliard_initial_values --levels 4"), exit_usage);
  EXPECT_EQ(exit_code("cahn_hilliard_energy --end_time 0"), exit_usage);
  EXPECT_EQ(exit_code("cahn_hilliard_initial_values --epsilon -1"), exit_usage);
}

TEST_F(Programs, SolutionsDifferByWhatTheInitialValuesSay) {
  const Table table =
      table_of("cahn_hilliard_initial_values --levels 0 --initial interpolation,ritz,interpolation_theta");
  ASSERT_EQ(table.rows.size(), 3u);
  for (const Row& row : table.rows) {
    SCOPED_TRACE(row.cell);
    EXPECT_NEAR(row.values.at("largest_u0"), 1, 1e-9);
    EXPECT_LT(row.values.at("mass_drift"), 1e-11);
    EXPECT_EQ(row.more.at("snapshots").size(), 5u);
    const std::string initial = row.labels.at("initial");
    EXPECT_EQ(row.values.count("u_difference_L2_at_0"), initial == "interpolation" ? 0u : 1u);
    if (initial == "interpolation") continue;
    EXPECT_EQ(row.values.at("u_difference_L2_at_0") == 0, initial == "interpolation_theta");
    EXPECT_GT(row.values.at("w_difference_L2_at_0"), 0.01);
    EXPECT_LT(row.values.at("u_difference_L2_at_5"), 0.1);
  }
}

}  // namespace
}  // namespace esfem::test_energy_and_initial_values
