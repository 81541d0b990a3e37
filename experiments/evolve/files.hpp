// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/evolve/run_flow.hpp"

namespace esfem {

/// Before the first step of a run: makes sure that its output files can be written (prepare_output; the
/// checkpoint and the collection of snapshots do so themselves), and that none of them is written over
/// another one, over `source`, the configuration, or over the mesh. Throws InputError that names the file.
void prepare_outputs(const EvolveConfig& config, const nlohmann::json& json, const std::string& source);

/// What the numbers of a run depend on beside its time steps and its initial state, for its checkpoint: the
/// mesh as it is used, not the name of its file; not the output, and not the length of the run.
nlohmann::json run_identity(const EvolveConfig& config, const nlohmann::json& json);

/// Writes all requested outputs; one that cannot be written does not prevent the others. Returns `failures`
/// with those that could not be written.
std::vector<std::string> write_outputs(const Run& run, const std::string& status,
                                       const nlohmann::json& config_json, const nlohmann::json& origin,
                                       std::vector<std::string> failures = {});

/// How far the run has come, and which files have been written, in one line.
std::string summary(const Run& run, double seconds);

/// How a run goes on that has been stopped; "" when the files are not there for it.
std::string how_to_go_on(const Run& run, const std::vector<std::string>& failures);

/// In one line; those that are empty are left out.
std::string joined(const std::vector<std::string>& parts);

}  // namespace esfem
