// SPDX-License-Identifier: GPL-3.0-or-later
// The program mcf_dumbbell on a coarse mesh, as a user meets it: runs that end at the singularity.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/error.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_mcf_dumbbell {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr, testing::StartsWith;

TEST(McfDumbbell, KeepsWhatItHasComputedUntilTheSingularity) {
  const fs::path folder = fs::path(ESFEM_BINARY_DIR) / "test_mcf_dumbbell" / std::to_string(getpid());
  fs::create_directories(folder);
  const std::string program = std::string(ESFEM_BINARY_DIR) + "/bin/mcf_dumbbell",
                    mesh = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/dumbbell_450.msh",
                    output = (folder / "table.json").string();
  std::vector<Row> rows;
  for (const std::string options :
       {"--flow mean_curvature --variant plain,normalised", "--flow dziuk", "--flow bgn --degree 1"}) {
    const std::string command =
        program + " " + options + " --start cascade --mesh " + mesh + " --output " + output + " 2>/dev/null";
    ASSERT_EQ(WEXITSTATUS(std::system(command.c_str())), exit_done) << options;
    const Table table = table_from_json(read_json(output), "table.json");
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  }

  ASSERT_EQ(rows.size(), 4u);
  for (const Row& row : rows) {
    SCOPED_TRACE(row.cell);
    EXPECT_THAT(row.status, StartsWith("singular at t = 0.0"));
    const std::vector<double>& t = row.series.at("t");
    EXPECT_GT(t.back(), 0.05);
    EXPECT_LT(t.back(), 0.12) << "it does not continue after the pinch";
    for (const auto& [name, values] : row.series) {
      EXPECT_EQ(values.size(), t.size()) << name;
      for (double value : values) ASSERT_TRUE(std::isfinite(value)) << name;
    }
    for (const char* name : {"area", "volume", "max_H", "neck_radius", "worst_angle", "worst_radius_ratio"})
      EXPECT_EQ(row.series.count(name), 1u) << name;
    const std::string flow = row.labels.at("flow").get<std::string>();
    EXPECT_EQ(row.series.count("min_nu"), flow == "mean_curvature") << "normals of its own";

    // The nodes become dense near the widest circles, except with BGN's scheme.
    EXPECT_GT(row.series.at("smallest_elements").front(), 0.5);
    if (flow == "bgn") {
      EXPECT_GT(row.values.at("smallest_elements_at_0.06"), 0.75);
    } else {
      EXPECT_LT(row.values.at("smallest_elements_at_0.06"), 0.6);
      EXPECT_NEAR(row.values.at("smallest_elements_x3_at_0.06"), 1, 0.35);
    }

    const auto& snapshots = row.more.at("snapshots");
    EXPECT_GE(snapshots.size(), 3u);
    EXPECT_EQ(snapshots.back().at("t").get<double>(), t.back()) << "the last good surface";
    for (const auto& snapshot : snapshots)
      EXPECT_TRUE(
          fs::exists(folder / "cells/mcf_dumbbell" / row.cell / snapshot.at("file").get<std::string>()));
    EXPECT_TRUE(fs::exists(folder / "cells/mcf_dumbbell" / row.cell / "surfaces.pvd"));
    const auto& singular = row.more.at("singular_surface");
    EXPECT_GT(singular.at("t").get<double>(), t.back());
    EXPECT_EQ(singular.at("extrapolated").get<bool>(),
              row.status.find("on the extrapolated surface") != std::string::npos)
        << row.status;
    EXPECT_TRUE(
        fs::exists(folder / "cells/mcf_dumbbell" / row.cell / singular.at("file").get<std::string>()));
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace esfem::test_mcf_dumbbell
