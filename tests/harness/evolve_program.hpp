// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "solver/error.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// The program evolve as a user meets it: configurations in, files, messages and exit codes out.
class EvolveProgram : public testing::Test {
 protected:
  const std::filesystem::path folder =
      std::filesystem::path(ESFEM_BINARY_DIR) / "test_evolve" / std::to_string(getpid());
  const std::string nodal = (folder / "nodal.json").string(), series = (folder / "series.json").string();
  std::string message;                  ///< what the last run printed on standard error
  bool root_heeds_permissions = false;  ///< root may write what permissions forbid, unless this is set

  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  nlohmann::json config(const nlohmann::json& changes = nlohmann::json::object()) const {
    nlohmann::json result = {{"flow", "mean_curvature"},
                             {"surface", {{"name", "sphere"}, {"radius", 1}}},
                             {"mesh", {{"subdivisions", 1}}},
                             {"bdf", 2},
                             {"tau", 0.01},
                             {"steps", 4},
                             {"output", {{"nodal", nodal}, {"series", series}}}};
    result.merge_patch(changes);
    return result;
  }

  int run(const nlohmann::json& configuration) {
    const std::string file = (folder / "config.json").string(), errors = (folder / "errors.txt").string();
    write_file(file, configuration.dump());
    const int status = run_command(ESFEM_BINARY_DIR "/bin/evolve " + file + " 2>" + errors);
    std::ifstream stream(errors);
    message.assign(std::istreambuf_iterator<char>(stream), {});
    return status;
  }

  /// Runs to the end; returns the nodal values there.
  nlohmann::json end_of(const nlohmann::json& configuration) {
    EXPECT_EQ(run(configuration), exit_done) << message;
    return read_json(nodal);
  }

  /// Runs to the end; returns the series.
  nlohmann::json series_of(const nlohmann::json& configuration) {
    EXPECT_EQ(run(configuration), exit_done) << message;
    return read_json(series);
  }

  /// The message with which a configuration is refused.
  std::string refusal(const nlohmann::json& configuration) {
    EXPECT_EQ(run(configuration), exit_usage) << message;
    return message;
  }

  /// Runs a command of the shell; returns its exit code.
  int run_command(const std::string& command) const {
    const pid_t child = fork();
    if (child == 0) {
      const bool drops = root_heeds_permissions && geteuid() == 0;
      if (!drops || prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE) == 0)
        execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  }
};

/// The largest difference of the numbers of two arrays, infinite where their sizes differ.
inline double largest_difference(const nlohmann::json& a, const nlohmann::json& b) {
  if (a.is_number()) return std::abs(a.get<double>() - b.get<double>());
  double largest = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, largest_difference(a[i], b[i]));
  return largest;
}

}  // namespace esfem
