// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/evolve/config.hpp"

namespace esfem {

/// Before the first step of a run: makes sure that its output files can be written (prepare_output; the
/// checkpoint and the collection of snapshots do so themselves), and that none of them is written over
/// another one, over `source`, the configuration, or over the mesh. Throws InputError that names the file.
void prepare_outputs(const EvolveConfig& config, const nlohmann::json& json, const std::string& source);

/// What the numbers of a run depend on beside its time steps and its initial state, for its checkpoint: the
/// mesh as it is used, not the name of its file; nothing of the output, and not how long the run is.
nlohmann::json run_identity(const EvolveConfig& config, const nlohmann::json& json);

/// Writes all that is asked for; what cannot be written keeps nothing else from it. Returns `failures` with
/// what could not be written.
std::vector<std::string> write_outputs(const EvolveConfig& config, RunRecorder& recorder,
                                       const std::string& status, const nlohmann::json& config_json,
                                       const nlohmann::json& origin, std::vector<std::string> failures = {});

/// The failures of write_outputs in one line, with what is left to do.
std::string joined(const std::vector<std::string>& failures, const EvolveConfig& config);

}  // namespace esfem
