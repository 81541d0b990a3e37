// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/files.hpp"

#include <algorithm>
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

/// N x c numbers as [[..], ..], or [..] for one column.
template <class Matrix>
json rows(const Matrix& field) {
  json list = json::array();
  for (int j = 0; j < field.rows(); ++j) {
    if (field.cols() == 1) {
      list.push_back(field(j, 0));
    } else {
      list.push_back(std::vector<typename Matrix::Scalar>(field.cols()));
      for (int l = 0; l < field.cols(); ++l) list.back()[l] = field(j, l);
    }
  }
  return list;
}

void write_series(const EvolveConfig& config, RunRecorder& recorder, const std::string& status,
                  const json& config_json, const json& origin) {
  json series = recorder.series();
  series["status"] = status;
  series["config"] = config_json;
  series["provenance"] = origin;
  write_file(config.series, series.dump(1) + "\n");
}

void write_nodal(const EvolveConfig& config, const RunRecorder& recorder, const json& config_json,
                 const json& origin) {
  const RunRecorder::Surface& newest = recorder.newest();
  const Field x = newest.x.rowwise() + config.origin.transpose();
  json nodal = {{"t", newest.t}, {"x", rows(x)}, {"config", config_json}, {"provenance", origin}};
  for (const NodalField& field : newest.fields) nodal[field.name] = rows(field.values);
  nodal["elements"] = rows(config.mesh.elements);
  if (!config.node_numbers.empty()) nodal["node_numbers"] = config.node_numbers;
  write_file(config.nodal, nodal.dump() + "\n");
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
  // Keys whose values are compared after reading, or that change no number of a step.
  for (const char* key : {"$schema", "output", "tau", "steps", "bdf", "start", "adaptive", "mesh", "degree",
                          "quadrature", "limits"})
    identity.erase(key);
  identity["mesh"] = json::array(
      {checksum(bytes_of(config.mesh.elements) + bytes_of(config.mesh.nodes) + bytes_of(config.origin))});
  identity["number of nodes"] = config.mesh.nodes.rows();
  identity["degree"] = config.mesh.degree;
  identity["quadrature"] = config.rule.name;
  identity["build of the program"] = build_identity();
  return identity;
}

std::vector<std::string> write_outputs(const EvolveConfig& config, RunRecorder& recorder,
                                       const std::string& status, const json& config_json, const json& origin,
                                       std::vector<std::string> failures) {
  const auto attempt = [&](auto&& action) {
    try {
      action();
    } catch (const InputError& error) {
      if (std::find(failures.begin(), failures.end(), error.what()) == failures.end())
        failures.push_back(error.what());
    }
  };
  if (!config.series.empty()) attempt([&] { write_series(config, recorder, status, config_json, origin); });
  if (!config.nodal.empty()) attempt([&] { write_nodal(config, recorder, config_json, origin); });
  attempt([&] { recorder.finish(); });
  return failures;
}

std::string joined(const std::vector<std::string>& failures, const EvolveConfig& config) {
  std::string text;
  for (const std::string& failure : failures) text += (text.empty() ? "" : "; ") + failure;
  std::error_code ignored;
  if (!config.checkpoint.empty() && std::filesystem::exists(config.checkpoint, ignored))
    text += "; the same command resumes from " + config.checkpoint;
  return text;
}

}  // namespace esfem
