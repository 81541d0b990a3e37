// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps over values of a configuration's keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/harness/cells.hpp"

namespace esfem {

/// A key of a configuration, "parameters.gamma", and the values that it takes one after the other.
struct VariedKey {
  std::string key;
  std::vector<nlohmann::json> values;
};

/// Reads "parameters.gamma=10,20" or "kinetics.diffusion=[1,10],[1,20]": values are JSON, separated by
/// commas; what is no JSON is text (start=exact,substeps:16). Throws InputError that names --set.
VariedKey varied_key(const std::string& text);

/// The configuration with this value under a dotted key; a number in it counts from 0 in an array. Throws
/// InputError where the configuration has neither object nor array on the way, and for a place that an array
/// does not have.
nlohmann::json with_value(nlohmann::json configuration, const std::string& key, const nlohmann::json& value);

/// A configuration, the name of its cell, and the values that distinguish it.
struct SweptConfiguration {
  std::string cell;
  nlohmann::json configuration, labels;
};

/// All combinations of the values, the last key varying fastest. tau and steps are no labels: rows have them.
std::vector<SweptConfiguration> swept(const nlohmann::json& configuration,
                                      const std::vector<VariedKey>& keys);

/// `evolve CONFIG.json --set ..`, whose texts are `sets`. Every configuration is checked before the first
/// run.
void sweep(const nlohmann::json& configuration, const std::string& source,
           const std::vector<std::string>& sets, const CellRequest& request, const nlohmann::json& origin);

/// The paragraph of --help.
std::string sweep_help();

}  // namespace esfem
