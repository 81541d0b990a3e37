// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/initial.hpp"

#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/history.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/read_json.hpp"

namespace esfem {
namespace {

using nlohmann::json;

/// What a nodal output has beside nodal values.
const std::set<std::string> other_keys = {"t",    "x",       "elements", "node_numbers", "degree",
                                          "flow", "problem", "config",   "history",      "provenance"};

/// Numbers, or arrays of numbers of the same length, one for each node.
Field nodal_values(const json& list, const std::string& where) {
  if (!list.is_array() || list.empty()) throw InputError(where + ": expected an array, one row per node");
  const int columns = list[0].is_array() ? static_cast<int>(list[0].size()) : 1;
  if (columns == 0) throw InputError(where + ": expected numbers in each row");
  Field values(list.size(), columns);
  for (int i = 0; i < values.rows(); ++i)
    for (int l = 0; l < columns; ++l) {
      const json& row = list[i];
      const bool is_row = row.is_array() ? row.size() == std::size_t(columns) : columns == 1;
      const json* number = !is_row ? nullptr : row.is_array() ? &row[l] : &row;
      if (!number || !number->is_number())
        throw InputError(
            format("%s: row %d (counted from 1) is not of %d numbers", where.c_str(), i + 1, columns));
      values(i, l) = number->get<double>();
    }
  return values;
}

Mesh mesh_of(const JsonReader& file) {
  Mesh mesh;
  mesh.nodes = nodal_values(file.array("x"), file.where() + ": x");
  if (mesh.nodes.cols() != 3) throw InputError(file.where() + ": x: expected three coordinates per node");
  const Field elements = nodal_values(file.array("elements"), file.where() + ": elements");
  if (elements.array().floor().matrix() != elements || elements.minCoeff() < 0 ||
      elements.maxCoeff() >= double(mesh.nodes.rows()))
    throw InputError(format("%s: elements: expected nodes from 0 to %d", file.where().c_str(),
                            int(mesh.nodes.rows()) - 1));
  mesh.elements = elements.cast<int>();
  while (mesh.degree <= max_degree && nodes_per_element(mesh.degree) != mesh.elements.cols()) ++mesh.degree;
  if (mesh.degree > max_degree)
    throw InputError(format("%s: elements: found %d nodes in each; expected 3, 6, 10 or 15 (degree 1 to 4)",
                            file.where().c_str(), int(mesh.elements.cols())));
  return mesh;
}

/// The mesh and all nodal values beside x.
std::pair<Mesh, NodalFields> surface_of(const json& content, const std::string& name) {
  std::pair<Mesh, NodalFields> surface = {mesh_of(JsonReader(content, name)), {}};
  for (const auto& [key, values] : content.items()) {
    if (other_keys.count(key)) continue;
    surface.second.push_back({key, nodal_values(values, name + ": " + key)});
    if (surface.second.back().values.rows() != surface.first.nodes.rows())
      throw InputError(name + ": " + key + ": expected a row per node");
  }
  return surface;
}

/// The history of a file, complete enough to be looked at; null without one.
json history_in(const JsonReader& file) {
  if (!file.has("history")) return {};
  const JsonReader history(file.object("history"), file.where() + ": history");
  for (const char* key : {"tau", "start_time"}) history.number(key);
  for (const char* key : {"step", "bdf"}) history.integer(key);
  history.array("states");
  return file.object("history");
}

/// What differs between the configuration and that of the earlier run; "" when the run can go on.
std::string difference(const json& description, const JsonReader& whole, const JsonReader& file,
                       const json& history) {
  const json earlier = file.has("config") ? file.object("config") : json::object();
  std::set<std::string> equations = {"definitions"};
  for (const Entry& entry : entries())
    for (const FormulaKey& key : entry.formulas)
      if (key.name != "initial") equations.insert(key.name);
  const auto differs = [&](const char* key) {
    const bool is_there = earlier.contains(key);
    if (!whole.has(key)) return is_there && std::string(key) != "surface";
    return !is_there || description.at(key) != earlier.at(key);
  };
  for (const char* key : {"flow", "problem", "surface", "variant", "parameters", "quadrature"})
    if (differs(key)) return std::string("another ") + key;
  for (const std::string& key : equations)
    if (differs(key.c_str())) return "another \"" + key + "\"";
  if (whole.has("adaptive")) return "equal steps, not adaptive ones";
  if (whole.has("tau") && whole.number("tau") != history.at("tau"))
    return format("another tau (%g)", history.at("tau").get<double>());
  if (whole.has("bdf") && whole.integer("bdf") != history.at("bdf"))
    return format("another bdf (%d)", history.at("bdf").get<int>());
  return "";
}

void take_history(const JsonReader& whole, const JsonReader& file, Initial& initial) {
  Field& x = initial.surface.start.mesh.nodes;
  in_history_of(initial.file, [&] {
    const Field start = field_in_numbers(initial.history.at("start"));
    if (start.rows() != x.rows() || start.cols() != 3) throw InputError("start: expected a row per node");
    for (int l = 0; l < 3; ++l) initial.history.at("origin").at(l).get<double>();
    x = start;
    initial.surface.start.fields.clear();
    initial.surface.remarks.push_back(
        format("%s: the run goes on from step %d, t = %g, with the states before", initial.file.c_str(),
               initial.history.at("step").get<int>(), initial.t.value()));
  });
  const json earlier = file.has("config") ? file.object("config") : json::object();
  if (!whole.has("surface") && earlier.contains("surface"))
    initial.taken_over["surface"] = earlier.at("surface");
  if (!whole.has("bdf")) initial.taken_over["bdf"] = initial.history.at("bdf");
}

Initial from_nodal_output(const json& description, const JsonReader& whole, const std::string& name) {
  const json content = read_json(name);
  const JsonReader file(content, name);
  if (file.has("t") && content.at("t").is_array())
    throw InputError(name + ": a series; expected the file that \"nodal\" of the earlier run names");
  Initial initial{name, file.has("flow") ? file.text("flow") : "", {}, file.number("t"), history_in(file)};
  ReadMesh& start = initial.surface.start;
  std::tie(start.mesh, start.fields) = surface_of(content, name);
  if (file.has("node_numbers"))
    for (const json& number : file.array("node_numbers"))
      start.node_numbers.push_back(number.is_number() ? number.get<long>() : 0);
  std::string why_not = "it has no \"history\"";
  if (!initial.history.is_null()) why_not = difference(description, whole, file, initial.history);
  if (why_not.empty()) {
    take_history(whole, file, initial);
  } else {
    if (!initial.history.is_null()) why_not = "its history is of " + why_not;
    initial.history = nullptr;
    initial.surface.remarks.push_back(
        format("%s: the run starts from its state at t = %g alone: ", name.c_str(), *initial.t) + why_not);
  }
  if (initial.history.is_null() && whole.has("surface"))
    throw InputError(whole.where() +
                     ": found initial and surface; expected no surface, since that is the one of " + name +
                     " (" + why_not + ")");
  start.origin.source = name;
  initial.surface.remarks.push_back(check_closed_surface(start.mesh, name));
  return initial;
}

Initial from_mesh_file(const JsonReader& whole, const std::string& name) {
  if (whole.has("surface"))
    throw InputError(whole.where() +
                     ": found initial and surface; expected one of them: the surface is that of " + name);
  Initial initial{name, "", {read_mesh(name), {}}, {}, nullptr};
  initial.t = initial.surface.start.t;
  if (!initial.surface.start.remark.empty())
    initial.surface.remarks.push_back(name + ": " + initial.surface.start.remark);
  return initial;
}

}  // namespace

ReadMesh read_nodal_output(const std::string& file) {
  const json content = read_json(file);
  ReadMesh surface;
  surface.t = JsonReader(content, file).number("t");
  std::tie(surface.mesh, surface.fields) = surface_of(content, file);
  return surface;
}

std::optional<Initial> read_initial(const json& description, const std::string& source) {
  const JsonReader whole(description, source);
  if (!whole.has("initial")) return {};
  const bool has_file = whole.object("initial").contains("file");
  if (whole.has("mesh") && !has_file) return {};
  if (whole.has("mesh")) throw InputError(whole.where() + ": found initial and mesh; expected one of them");
  const JsonReader asked(whole.object("initial"), whole.where() + ": initial");
  for (const auto& item : whole.object("initial").items())
    if (item.key() != "file" && item.key() != "time")
      throw InputError(asked.where() + ": found " + item.key() +
                       " beside file, which gives all values; for formulas on the nodes of a file expected "
                       "\"mesh\": {\"file\": ..}, and \"initial\" without file");
  const std::string file = asked.text("file");
  const bool is_json = std::filesystem::path(file).extension() == ".json";
  Initial initial = is_json ? from_nodal_output(description, whole, file) : from_mesh_file(whole, file);
  const int degree = initial.surface.start.mesh.degree;
  if (whole.has("degree") && whole.integer("degree") != degree)
    throw InputError(
        format("%s: found degree = %d, but the elements of %s have degree %d; expected no key degree",
               whole.where().c_str(), whole.integer("degree"), file.c_str(), degree));
  if (asked.has("time")) {
    if (initial.t)
      throw InputError(format("%s: found time, but %s has t = %g; expected no key time",
                              asked.where().c_str(), file.c_str(), *initial.t));
    initial.t = asked.number("time");
  }
  return initial;
}

void take_initial(Initial initial, EvolveConfig& config) {
  config.initial_file = initial.file;
  config.initial_flow = initial.flow;
  config.history = std::move(initial.history);
  if (config.history.is_null()) {
    config.grid.start_time = initial.t.value_or(0);
    if (config.adaptive) config.adaptive->start_time = config.grid.start_time;
    return;
  }
  config.grid.first = config.history.at("step").get<int>();
  config.grid.start_time = config.history.at("start_time").get<double>();
}

}  // namespace esfem
