// SPDX-License-Identifier: GPL-3.0-or-later
// Configurations as cells of a table.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "solver/tables/table.hpp"

namespace esfem {

/// Runs a configuration as a cell whose files go into `folder`: those of "output", under their names without
/// folders, a checkpoint, and where wants_nodal is true nodal_file. Completes the planned row: mesh, steps,
/// the last value of each series of evolve, min_F and max_F of each field F at the end (of vectors max_F, of
/// their lengths), as errors the maxima over time of those in the series, and the status.
void run_as_cell(nlohmann::json configuration, const std::string& source, const nlohmann::json& origin,
                 bool wants_nodal, const std::string& folder, Row& row);

/// The nodal values at the end of a cell, in its folder.
constexpr const char* nodal_file = "end.json";

/// What is known of a configuration's row beforehand: name, tau, steps.
Row planned_row(const nlohmann::json& configuration, const std::string& cell);

/// Estimated seconds on one core of a configuration with so many nodes.
double estimated_seconds(const nlohmann::json& configuration, double nodes);

/// Numbers of nodes of the meshes of configurations, each of which is made once.
class NodeCounts {
 public:
  int of(const nlohmann::json& configuration, const std::string& source);

 private:
  std::map<std::string, int> known_;
};

}  // namespace esfem
