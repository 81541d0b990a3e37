// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "experiments/evolve/series_lines.hpp"
#include "experiments/harness/progress.hpp"
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

void write_series(const Run& run, const std::string& status, const json& config_json, const json& origin) {
  const std::string& file = run.config.series;
  if (is_csv(file)) return write_file(file, csv_lines(run.recorder.series()));
  json series = run.recorder.series();
  series["status"] = status;
  series["config"] = config_json;
  series["provenance"] = origin;
  write_file(file, series.dump(1) + "\n");
}

void write_nodal(const Run& run, const json& config_json, const json& origin) {
  const EvolveConfig& config = run.config;
  const RunRecorder::Surface& newest = run.recorder.newest();
  const Field x = newest.x.rowwise() + config.origin.transpose();
  json nodal = {{"flow", config.entry->flow},   {"t", newest.t},         {"x", rows(x)},
                {"degree", config.mesh.degree}, {"config", config_json}, {"provenance", origin}};
  if (!config.entry->problem.empty()) nodal["problem"] = config.entry->problem;
  if (!run.outcome.history.is_null()) nodal["history"] = run.outcome.history;
  for (const NodalField& field : newest.fields) nodal[field.name] = rows(field.values);
  nodal["elements"] = rows(config.mesh.elements);
  if (!config.node_numbers.empty()) nodal["node_numbers"] = config.node_numbers;
  write_file(config.nodal, nodal.dump() + "\n");
}

bool has_checkpoint(const EvolveConfig& config) {
  std::error_code ignored;
  return !config.checkpoint.empty() && std::filesystem::exists(config.checkpoint, ignored);
}

}  // namespace

void prepare_outputs(const EvolveConfig& config, const json& json, const std::string& source) {
  using Named = std::pair<std::string, std::string>;
  std::vector<Named> inputs = {{"the configuration", source}};
  for (const auto& [key, what] : {Named("mesh", "the mesh"), Named("initial", "the initial state")})
    if (json.contains(key) && json.at(key).contains("file"))
      inputs.emplace_back(what, json.at(key).at("file").get<std::string>());
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
                          "quadrature", "limits", "initial", "stop"})
    identity.erase(key);
  identity["mesh"] = json::array(
      {checksum(bytes_of(config.mesh.elements) + bytes_of(config.mesh.nodes) + bytes_of(config.origin))});
  identity["number of nodes"] = config.mesh.nodes.rows();
  identity["degree"] = config.mesh.degree;
  identity["quadrature"] = config.rule.name;
  identity["build of the program"] = build_identity();
  return identity;
}

std::vector<std::string> write_outputs(const Run& run, const std::string& status, const json& config_json,
                                       const json& origin, std::vector<std::string> failures) {
  const EvolveConfig& config = run.config;
  const auto attempt = [&](auto&& action) {
    try {
      action();
    } catch (const InputError& error) {
      if (std::find(failures.begin(), failures.end(), error.what()) == failures.end())
        failures.push_back(error.what());
    }
  };
  if (!config.series.empty()) attempt([&] { write_series(run, status, config_json, origin); });
  if (!config.nodal.empty()) attempt([&] { write_nodal(run, config_json, origin); });
  attempt([&] { run.recorder.finish(); });
  return failures;
}

std::string summary(const Run& run, double seconds) {
  const EvolveConfig& config = run.config;
  const Series& series = run.recorder.series();
  const auto change = [&](const char* name) {
    return format("%s %.6g -> %.6g", name, series.at(name).front(), series.at(name).back());
  };
  std::string files;
  const auto list = [&](const std::string& file, const std::string& more = "") {
    if (!file.empty()) files += (files.empty() ? "" : ", ") + (file == "-" ? "standard output" : file) + more;
  };
  list(config.nodal);
  list(config.series);
  list(config.snapshots.pvd, format(" (%zu snapshots)", run.recorder.snapshots().size()));
  if (has_checkpoint(config)) list(config.checkpoint);
  const int steps = run.recorder.newest().step;
  if (steps == 0 && !config.adaptive && config.grid.steps == 0)
    files += " (no step was asked for: \"steps\" is 0)";
  return format("%d step%s to t = %g in %s; ", steps, steps == 1 ? "" : "s", run.recorder.newest().t,
                duration_text(seconds).c_str()) +
         change("area") + ", " + change("volume") + (files.empty() ? "" : "; written: " + files);
}

std::string how_to_go_on(const Run& run, const std::vector<std::string>& failures) {
  const EvolveConfig& config = run.config;
  if (has_checkpoint(config)) return "the same command resumes from " + config.checkpoint;
  if (!failures.empty()) return "";
  if (config.nodal.empty() || config.nodal == "-")
    return "a run whose output has a \"checkpoint\" can be resumed";
  return "\"initial\": {\"file\": \"" + config.nodal + "\"} in the place of \"mesh\" goes on from there" +
         (run.outcome.history.is_null() ? ", with new starting steps" : "");
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() || part.empty() ? "" : "; ") + part;
  return text;
}

}  // namespace esfem
