// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/start.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/error.hpp"

namespace esfem {

std::vector<std::vector<std::string>> starts_of(const EvolveConfig& config) {
  return config.entry->own_starts ? config.entry->own_starts(config) : config.entry->starts;
}

namespace {

using Names = std::vector<std::string>;

/// What a run can start from: sets of nodal values, which the file must have as a whole.
std::vector<Names> possible_starts(const EvolveConfig& config) {
  if (config.surface && !config.entry->starts_beside_surface) return {};
  return starts_of(config);
}

bool has_all(const EvolveConfig& config, const Names& names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return find(config.fields, name); });
}

/// The file of the nodal values.
std::string file_of(const EvolveConfig& config) {
  return config.initial_file.empty() ? config.mesh_origin.source : config.initial_file;
}

/// The node under the number that the mesh file has for it.
std::string node_named(const EvolveConfig& config, int i) {
  if (i < int(config.node_numbers.size())) return format("node %ld", config.node_numbers[i]);
  return format("node %d (counted from 1)", i + 1);
}

void check_values(const EvolveConfig& config, const std::string& name, const Field& values) {
  const bool is_vector = name == "nu" || name == "z" || name == "v";
  if (values.cols() != (is_vector ? 3 : 1))
    throw InputError(format("%s: %s has %d components, %d expected", file_of(config).c_str(), name.c_str(),
                            int(values.cols()), is_vector ? 3 : 1));
  for (int i = 0; i < values.rows(); ++i)
    if (!values.row(i).allFinite())
      throw InputError(file_of(config) + ": " + name + " has no finite value at " + node_named(config, i) +
                       ", one at each node expected");
}

/// Normals of the file have about unit length and point outward, as those of the elements do.
void check_normals(const EvolveConfig& config, const Field& nu) {
  const Mesh& mesh = config.mesh;
  for (int i = 0; i < nu.rows(); ++i)
    if (const double length = nu.row(i).norm(); !(length > 0.5 && length < 2))
      throw InputError(format("%s: nu has length %g at ", file_of(config).c_str(), length) +
                       node_named(config, i) + ", 1 expected");
  double along = 0, area = 0;
  for (const auto& element : mesh.elements.rowwise()) {
    const Vec3 a = mesh.nodes.row(element[0]), b = mesh.nodes.row(element[1]), c = mesh.nodes.row(element[2]);
    const Vec3 normal = (b - a).cross(c - a);
    area += normal.norm();
    for (int i = 0; i < 3; ++i) along += normal.dot(Vec3(nu.row(element[i]))) / 3;
  }
  if (!(along > 0.5 * area))
    throw InputError(
        format("%s: nu is not the outward normal, the mean of nu . n over the "
               "surface is %.3g, about 1 expected",
               file_of(config).c_str(), along / area));
}

}  // namespace

Field start_values(const EvolveConfig& config, const Names& names) {
  const std::vector<Names> possible = possible_starts(config);
  if (std::find(possible.begin(), possible.end(), names) == possible.end() || !has_all(config, names))
    return {};
  Field values(config.mesh.nodes.rows(), 0);
  for (const std::string& name : names) {
    const Field& field = *find(config.fields, name);
    check_values(config, name, field);
    if (name == "nu") check_normals(config, field);
    Field both(values.rows(), values.cols() + field.cols());
    both << values, field;
    values = std::move(both);
  }
  return values;
}

MeanCurvatureFlow::State curvature_at_start(const EvolveConfig& config, const SurfaceSpace& space) {
  const Field& x = config.mesh.nodes;
  if (const Field nu_H = start_values(config, {"nu", "H"}); nu_H.size() > 0)
    return mean_curvature_state(0, x, nu_H.leftCols(3), nu_H.col(3));
  return config.surface ? mean_curvature_state_on(*config.surface, x)
                        : discrete_mean_curvature_state(space, x);
}

void require_unit_sphere(const EvolveConfig& config, const std::string& what) {
  if (config.surface && config.surface->name == "sphere" && config.surface->parameters.at("radius") == 1)
    return;
  throw InputError(
      what + " starts from the unit sphere; expected \"surface\": {\"name\": \"sphere\", \"radius\": 1}");
}

void require_start(const EvolveConfig& config, const std::string& where) {
  const std::vector<Names> starts = starts_of(config);
  if (config.history.is_object() || starts.empty()) return;
  std::string expected, found;
  for (const Names& names : starts) {
    if (has_all(config, names)) return;
    expected += expected.empty() ? "" : " or ";
    for (const std::string& name : names) expected += (&name == &names.front() ? "" : ", ") + name;
  }
  for (const NodalField& field : config.fields) found += (found.empty() ? "" : ", ") + field.name;
  const std::string& flow = config.initial_flow;
  throw InputError(
      where + ": flow " + config.entry->flow + " starts from " + expected + "; found " +
      (found.empty() ? "no nodal values" : found) + " in " + config.initial_file +
      (flow.empty() || flow == config.entry->flow ? "" : ", which flow " + flow + " has written"));
}

std::string curvature_start_remark(const EvolveConfig& config) {
  if (!config.entry->evolves_curvature || config.surface || config.history.is_object()) return "";
  if (start_values(config, {"nu", "H"}).size() > 0) return "";
  return "no exact surface is given: nu and H at the start are computed on the discrete surface";
}

std::string start_remark(const EvolveConfig& config) {
  std::map<std::string, bool> used;
  for (const NodalField& field : config.fields)
    if (config.initial.count(field.name) == 0) used[field.name] = false;
  for (const Names& names : possible_starts(config))
    if (has_all(config, names))
      for (const std::string& name : names)
        if (config.initial.count(name) == 0) used[name] = true;
  std::string taken, ignored;
  for (const auto& [name, is_used] : used) {
    std::string& list = is_used ? taken : ignored;
    list += (list.empty() ? "" : ", ") + name;
  }
  const std::string file = config.initial_file.empty() ? "the mesh file" : config.initial_file;
  if (!taken.empty()) taken += " from " + file;
  if (!ignored.empty()) ignored += " of " + file + " not used";
  return taken + (taken.empty() || ignored.empty() ? "" : "; ") + ignored;
}

}  // namespace esfem
