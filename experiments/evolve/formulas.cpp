// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <regex>

#include "experiments/evolve/start.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/problems/formula_evolution.hpp"

namespace esfem {
namespace {

using nlohmann::json;

std::string text_of(const json& value, const std::string& where) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  throw InputError(where + ": found " + value.dump() + "; expected a formula as text, or a number");
}

json list_schema(int count) {
  return {{"type", "array"}, {"items", formula_schema()}, {"minItems", count}, {"maxItems", count}};
}

bool is_initial_name(const std::string& name) {
  return name[0] == 'u' || name[0] == 'w';
}

/// The sets of scalar fields from which a configuration's runs start.
std::vector<std::vector<std::string>> possible_initial_values(const EvolveConfig& config) {
  std::vector<std::vector<std::string>> sets;
  for (const auto& names : starts_of(config))
    if (std::all_of(names.begin(), names.end(), is_initial_name)) sets.push_back(names);
  return sets;
}

}  // namespace

Formula formula_in(const JsonReader& reader, const std::string& key, const FormulaNames& names) {
  const std::string where = reader.where() + ": " + key;
  return {text_of(reader.value(key), where), names, where};
}

std::vector<Formula> formulas_in(const JsonReader& reader, const std::string& key,
                                 const FormulaNames& names) {
  std::vector<Formula> formulas;
  for (const json& value : reader.array(key)) {
    const std::string where = reader.where() + ": " + key + "[" + std::to_string(formulas.size()) + "]";
    formulas.emplace_back(text_of(value, where), names, where);
  }
  if (formulas.empty()) throw InputError(reader.where() + ": found " + key + " = []; expected formulas");
  return formulas;
}

FormulaNames names_of(const EvolveConfig& config) {
  FormulaNames names = {{}, config.parameters.numbers()};
  if (!config.formulas.contains("definitions")) return names;
  const JsonReader reader(config.formulas.at("definitions"), config.source + ": definitions");
  for (const auto& item : config.formulas.at("definitions").items())
    names.definitions[item.key()] = text_of(item.value(), reader.where() + ": " + item.key());
  return names;
}

FormulaNames given_names(const EvolveConfig& config) {
  FormulaNames names = names_of(config);
  for (const Key& key : config.entry->parameters)
    if (!config.parameters.is_given(key.name)) names.constants.erase(key.name);
  return names;
}

std::set<std::string> names_in(const json& value) {
  static const std::regex name("[A-Za-z_][A-Za-z_0-9]*");
  std::set<std::string> names;
  for (const json& part : value.flatten()) {
    if (!part.is_string()) continue;
    const std::string text = part;
    for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found)
      names.insert(found->str());
  }
  return names;
}

std::set<std::string> names_in_formulas(const EvolveConfig& config) {
  return names_in(config.formulas);
}

FormulaKey initial_key(const std::vector<std::string>& names) {
  std::string example;
  for (const std::string& name : names)
    example += (example.empty() ? "{\"" : ", \"") + name + "\": \"1 + x*y\"";
  return {"initial",
          example + "}",
          "values at t = 0, of x, y, z; instead of those above or of the mesh file",
          {{"type", "object"}, {"additionalProperties", formula_schema()}}};
}

FormulaKey velocity_key() {
  const json one_key = {{"type", "object"},
                        {"properties", {{"level_set", formula_schema()}, {"normal", formula_schema()}}},
                        {"minProperties", 1},
                        {"maxProperties", 1},
                        {"additionalProperties", false}};
  return {
      "velocity",
      "[\"x*t\", \"0\", \"0\"]",
      "or {\"normal\": \"V\"}, along the surface's normals, or {\"level_set\": \"d\"}: the normal velocity "
      "-d_t/|grad d|; default: at rest",
      {{"anyOf", {list_schema(3), one_key}}}};
}

void take_initial_values(EvolveConfig& config) {
  FormulaNames names = names_of(config);
  if (!config.formulas.contains("initial")) return;
  const JsonReader reader(config.formulas.at("initial"), config.source + ": initial");
  std::set<std::string> given;
  for (const auto& item : config.formulas.at("initial").items()) given.insert(item.key());
  if (const auto sets = possible_initial_values(config); !sets.empty()) {
    std::string expected;
    for (const auto& names : sets) {
      const std::set<std::string> set(names.begin(), names.end());
      if (set == given) expected.clear();
      if (set == given) break;
      expected += (expected.empty() ? "" : "; or ") + listed(set);
    }
    if (!expected.empty())
      throw InputError(reader.where() + ": found " + (given.empty() ? "{}" : listed(given)) + "; expected " +
                       expected);
  }
  names.variables = {"x", "y", "z"};
  for (const std::string& name : given) {
    Field values;
    try {
      values = CompiledFormulas({formula_in(reader, name, names)})(config.mesh.nodes);
    } catch (const NumericsError& error) {
      throw InputError(error.what());
    }
    auto& fields = config.fields;
    fields.erase(std::remove_if(fields.begin(), fields.end(),
                                [&](const NodalField& field) { return field.name == name; }),
                 fields.end());
    fields.push_back({name, values});
  }
  config.initial = given;
}

std::function<Field(const Field& x, double t)> exact_values(const EvolveConfig& config,
                                                            const std::vector<std::string>& names) {
  if (!config.formulas.contains("exact")) return {};
  const JsonReader reader(config.formulas.at("exact"), config.source + ": exact");
  std::vector<Formula> formulas;
  for (const std::string& name : names) {
    if (!reader.has(name)) return {};
    formulas.push_back(formula_in(reader, name, names_in_space_time(names_of(config))));
  }
  return [compiled = CompiledFormulas(formulas)](const Field& x, double t) {
    return nodal_values(compiled, x, t);
  };
}

Velocity prescribed_velocity(const EvolveConfig& config, const SurfaceSpace* space, const std::string& key) {
  if (!config.formulas.contains(key)) return {};
  const json& given = config.formulas.at(key);
  const FormulaNames names = names_in_space_time(names_of(config));
  if (!given.is_object() && !given.is_array())
    throw InputError(config.source + ": " + key + ": found " + given.dump() +
                     "; expected three formulas in [..], {\"normal\": ..} or {\"level_set\": ..}");
  if (given.is_object()) {
    const JsonReader reader(given, config.source + ": " + key);
    if (reader.only_key({"level_set", "normal"}) == "level_set")
      return formula_normal_velocity(formula_in(reader, "level_set", names));
    const CompiledFormulas speed({formula_in(reader, "normal", names)});
    const auto surface = space ? std::make_shared<DiscreteCurvature>(*space) : nullptr;
    return [speed, surface](double t, const Field& x, Field& v) {
      surface->compute(x);
      v = surface->nu().array().colwise() * nodal_values(speed, x, t).col(0).array();
    };
  }
  const JsonReader reader(config.formulas, config.source);
  const std::vector<Formula> components = formulas_in(reader, key, names);
  if (components.size() != 3)
    throw InputError(config.source +
                     format(": %s: found %zu components; expected 3", key.c_str(), components.size()));
  return formula_velocity(components);
}

namespace {

/// Nodes that follow a velocity from a time on, by Runge-Kutta steps of a size each.
NodalMotion motion_from(double start, const Velocity& velocity, const Field& x, double tau) {
  const Velocity since_start = [=](double t, const Field& at, Field& v) { velocity(start + t, at, v); };
  const auto nodes = std::make_shared<MovingNodes>(since_start, x, tau);
  return [nodes, start](double t) -> const Field& { return nodes->at(t - start); };
}

}  // namespace

Distance farthest_from(const Surface& surface, const Field& x) {
  Distance farthest = {-1, Vec3::Zero()};
  for (const Vec3 at : x.rowwise()) {
    const LevelSetJet d = surface.level_set(at);
    const double distance = std::abs(d.value) / d.gradient.norm();
    if (!(distance <= farthest.value)) farthest = {distance, at};
    if (std::isnan(distance)) break;
  }
  return farthest;
}

std::string distance_text(const Distance& farthest, double h) {
  return format("the farthest, at (%g, %g, %g), is at a distance of about %.2g (longest edge: %.2g)",
                farthest.at[0], farthest.at[1], farthest.at[2], farthest.value, h);
}

void compare_with_nodes(const Surface& surface, const Mesh& mesh, double t, const std::string& where) {
  const double h = mesh_quality(mesh.elements, mesh.nodes).h;
  const Distance found = farthest_from(surface, mesh.nodes);
  if (found.value <= 1e-3 * h) return;
  const std::string remark =
      where + format(": nodes are not on the level set at t = %g: ", t) + distance_text(found, h);
  if (found.value <= h) return warn(remark);
  throw InputError(remark + "; expected zeros of it in the nodes");
}

NodalMotion prescribed_motion(const EvolveConfig& config, const SurfaceSpace& space,
                              const UniformSteps& steps) {
  const Field& x = config.mesh.nodes;
  const Velocity velocity = prescribed_velocity(config, &space);
  if (!velocity) return [&x](double) -> const Field& { return x; };
  const NodalMotion fine =
      motion_from(steps.start_time, velocity, x, steps.tau / steps.start.substeps_per_step);
  const json& given = config.formulas.at("velocity");
  if (given.is_object() && given.contains("level_set")) {
    const std::string where = config.source + ": velocity";
    const Formula d =
        formula_in(JsonReader(given, where), "level_set", names_in_space_time(names_of(config)));
    const Surface at_start = formula_level_set(d, space.length())(steps.start_time);
    compare_with_nodes(at_start, config.mesh, steps.start_time, where);
  }
  if (!given.is_object() || !given.contains("normal")) return fine;
  // A velocity along discrete normals costs a factorisation: substeps only where the starting values need
  // them.
  const double changes = steps.start_time + (steps.order - 1) * steps.tau;
  return [=, coarse = NodalMotion()](double t) mutable -> const Field& {
    if (t < changes + steps.tau / 2) return fine(t);
    if (!coarse) coarse = motion_from(changes, velocity, fine(changes), steps.tau);
    return coarse(t);
  };
}

json formula_schema() {
  return {{"type", {"string", "number"}}};
}

json exact_schema() {
  const json field = {{"anyOf", {formula_schema(), list_schema(3)}}};
  return {
      {"type", "object"},
      {"additionalProperties", field},
      {"description",
       "a solution, of x, y, z, t; x: where the nodes are that start in x, y, z; level_set: its surface"}};
}

json definitions_schema() {
  return {{"type", "object"},
          {"additionalProperties", formula_schema()},
          {"description", "names for parts of formulas"}};
}

std::string formulas_help() {
  return "Formulas are text (or a number) with + - * / ^ and parentheses, numbers, pi, and the functions\n "
         " " +
         formula_functions() +
         ".\nThey name the coordinates x, y, z, the time t, concentrations (u, or u1, u2, .. of several "
         "species), "
         "and every number of\n\"parameters\". step(a) is 1 for a >= 0, else 0. An error names the column.\n";
}

}  // namespace esfem
