// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_files.hpp"

#include <filesystem>
#include <utility>
#include <vector>

#include "experiments/harness/provenance.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

using nlohmann::json;

/// The same for all names of a file.
std::string place_of(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(file, error), error);
  return error ? file : place.string();
}

template <class Matrix>
std::string bytes_of(const Matrix& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(typename Matrix::Scalar)};
}

}  // namespace

void prepare_outputs(const EvolveConfig& config, const json& json, const std::string& source) {
  using Named = std::pair<std::string, std::string>;
  const auto mesh = json.at("mesh").find("file");
  std::vector<Named> inputs = {{"the configuration", source}};
  if (mesh != json.at("mesh").end()) inputs.emplace_back("the mesh", mesh->get<std::string>());
  const std::vector<Named> outputs = {{"nodal", config.nodal},
                                      {"series", config.series},
                                      {"checkpoint", config.checkpoint},
                                      {"vtu", config.snapshots.pvd}};
  std::vector<Named> taken;
  for (const auto& [what, file] : inputs) taken.emplace_back(what, place_of(file));
  for (const auto& [key, file] : outputs) {
    if (file.empty() || file == "-") continue;
    for (const auto& [what, place] : taken)
      if (place == place_of(file))
        throw InputError(source + ": output: found " + key + " = \"" + file + "\", which is " + what +
                         "; expected a file of its own");
    taken.emplace_back(key, place_of(file));
  }
  for (const std::string& file : {config.nodal, config.series})
    if (!file.empty()) prepare_output(file);
}

json run_identity(const EvolveConfig& config, const json& description) {
  json identity = description;
  // What is compared as it is after reading, or changes no number of a step.
  for (const char* key :
       {"output", "tau", "steps", "bdf", "start", "adaptive", "mesh", "degree", "quadrature", "limits"})
    identity.erase(key);
  identity["mesh"] = json::array(
      {checksum(bytes_of(config.mesh.elements) + bytes_of(config.mesh.nodes) + bytes_of(config.origin))});
  identity["number of nodes"] = config.mesh.nodes.rows();
  identity["degree"] = config.mesh.degree;
  identity["quadrature"] = config.rule.name;
  identity["build of the program"] = build_identity();
  return identity;
}

}  // namespace esfem
