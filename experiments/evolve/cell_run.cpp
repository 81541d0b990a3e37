// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/cell_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/evolve/run_configuration.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

using nlohmann::json;

json output_in(const std::string& folder, const json& configuration, bool wants_nodal) {
  json output = configuration.value("output", json::object());
  if (output.value("nodal", "") == "-") output.erase("nodal");
  for (const char* key : {"nodal", "series", "vtu"})
    if (output.contains(key) && output[key].is_string())
      output[key] = folder + "/" + std::filesystem::path(output[key].get<std::string>()).filename().string();
  if (wants_nodal) output["nodal"] = folder + "/" + nodal_file;
  if (wants_nodal) output["history"] = false;
  output["checkpoint"] = checkpoint_file(folder);
  return output;
}

/// Splits "u1_nodal_L2" into quantity and norm; false for what is no error.
bool is_error(const std::string& name, std::string& quantity, std::string& norm) {
  for (const char* kind : {"_nodal_", "_lifted_", "_unlifted_"}) {
    const std::size_t place = name.find(kind);
    if (place == std::string::npos) continue;
    quantity = name.substr(0, place);
    norm = name.substr(place + 1);
    return true;
  }
  return false;
}

void take_series(const Series& series, Row& row) {
  std::string quantity, norm;
  for (const auto& [name, values] : series) {
    if (values.empty()) continue;
    if (is_error(name, quantity, norm))
      row.errors[quantity][norm] = *std::max_element(values.begin(), values.end());
    else if (std::isfinite(values.back()))
      row.values[name == "h" ? "h_end" : name] = values.back();  // "h" of a row is that at the start
  }
}

void take_extremes(const NodalFields& fields, Row& row) {
  for (const NodalField& field : fields) {
    if (!field.values.allFinite() || field.values.size() == 0) continue;
    const bool is_scalar = field.values.cols() == 1;
    if (is_scalar) row.values.emplace("min_" + field.name, field.values.minCoeff());
    row.values.emplace("max_" + field.name,
                       is_scalar ? field.values.maxCoeff() : field.values.rowwise().norm().maxCoeff());
  }
}

bool starts_with(const std::string& text, const char* start) {
  return text.rfind(start, 0) == 0;
}

void complete(const Run& run, const std::string& status, Row& row) {
  const RunRecorder& recorder = run.recorder;
  if (recorder.empty()) return;
  take_series(recorder.series(), row);
  take_extremes(recorder.newest().fields, row);
  row.steps = recorder.newest().step;
  const std::vector<double>& t = recorder.series().at("t");
  if (run.config.adaptive && row.steps > 0) row.tau = (t.back() - t.front()) / row.steps;
  if (run.checkpoint) row.seconds = run.checkpoint->seconds_before();
  if (status != "ok") row.more["remark"] = status;
  if (run.outcome.is_unfinished) row.status = "failed: " + status;
}

}  // namespace

void run_as_cell(json configuration, const std::string& source, const json& origin, bool wants_nodal,
                 const std::string& folder, Row& row) {
  configuration["output"] = output_in(folder, configuration, wants_nodal);
  EvolveConfig config = evolve_config(configuration, source);
  if (!wants_nodal && !configuration["output"].contains("nodal")) config.nodal.clear();
  describe_mesh(config.mesh, row);
  try {
    run_configuration(config, configuration, origin,
                      [&](const Run& run, const std::string& status) { complete(run, status, row); });
  } catch (const NumericsError& error) {
    if (row.values.empty()) throw;  // no step has been recorded
    const std::string why = error.what();
    row.more.erase("remark");
    row.status = starts_with(why, "singular") ? why : "failed: " + why;
  }
}

Row planned_row(const json& configuration, const std::string& cell) {
  Row row;
  row.cell = cell;
  row.tau = configuration.contains("tau") ? configuration["tau"].get<double>() : 0;
  row.steps = configuration.contains("steps") ? configuration["steps"].get<int>() : 0;
  return row;
}

double estimated_seconds(const json& configuration, double nodes) {
  const double steps_of_adaptive_runs = 300, starting_steps = 20;  // orders of magnitude, as they are usual
  const double steps = configuration.contains("adaptive")
                           ? steps_of_adaptive_runs
                           : starting_steps + planned_row(configuration, "").steps;
  return 1e-5 * nodes * steps;
}

int NodeCounts::of(const json& configuration, const std::string& source) {
  json mesh = json::object();
  for (const char* key : {"surface", "mesh", "degree", "initial"})
    if (configuration.contains(key)) mesh[key] = configuration[key];
  const auto [known, is_new] = known_.emplace(mesh.dump(), 0);
  if (is_new) known->second = static_cast<int>(evolve_config(configuration, source).mesh.nodes.rows());
  return known->second;
}

}  // namespace esfem
