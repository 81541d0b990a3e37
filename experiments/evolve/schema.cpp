// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/formulas.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem {
namespace {

using nlohmann::json;

json described(json schema, const std::string& help) {
  schema["description"] = help;
  return schema;
}

json object_of(const json& properties) {
  return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

json schema_of(const Key& key) {
  json schema = {{"description", key.help}};
  switch (key.kind) {
  case Key::truth:
    schema["type"] = "boolean";
    break;
  case Key::word:
    schema["enum"] = key.words;
    break;
  case Key::truth_or_word:
    schema["enum"] = {true, false};
    for (const std::string& word : key.words) schema["enum"].push_back(word);
    break;
  case Key::words_of:
    schema.update({{"type", "array"}, {"items", {{"enum", key.words}}}, {"uniqueItems", true}});
    break;
  case Key::number_or_formula:
    schema.update(formula_schema());
    break;
  case Key::seed:
    schema.update({{"type", "integer"}, {"minimum", 0}, {"maximum", 1000000}});
    break;
  case Key::positive:
    schema.update({{"type", "number"}, {"exclusiveMinimum", 0}});
    break;
  case Key::not_negative:
    schema.update({{"type", "number"}, {"minimum", 0}});
    break;
  case Key::number:
    schema["type"] = "number";
    break;
  }
  if (!key.otherwise.is_null() && key.length_power == 0) schema["default"] = key.otherwise;
  return schema;
}

json schema_of(const std::vector<Key>& keys, bool takes_any_number = false) {
  json properties = json::object();
  for (const Key& key : keys) properties[key.name] = schema_of(key);
  json schema = object_of(properties);
  if (takes_any_number) schema["additionalProperties"] = {{"type", "number"}};
  return schema;
}

/// "initial" with a file.
json initial_file_schema() {
  const json text = {{"type", "string"}};
  json schema = object_of(
      {{"file", described(text, "nodal output of an earlier run, snapshot, or mesh with nodal values")},
       {"time", described({{"type", "number"}}, "of a file that does not say it")}});
  schema["required"] = {"file"};
  return described(schema, "instead of mesh: goes on from an earlier run");
}

/// What "variant", "parameters" and "bdf" may be for one entry, described by its help.
json rule_of(const Entry& entry, bool is_default) {
  json is = {{"properties", {{"flow", {{"const", entry.flow}}}}}, {"required", {"flow"}}};
  json then = {{"variant", schema_of(entry.variant)},
               {"parameters", schema_of(entry.parameters, entry.takes_own_parameters)}};
  then["bdf"] = {{"maximum", entry.highest_order}};
  if (entry.problem.empty()) {
    then["problem"] = false;
  } else {
    is["properties"]["problem"] = {{"const", entry.problem}};
    if (!is_default) is["required"].push_back("problem");
  }
  json limits = json::object();
  for (const char* key : {"curvature_size", "normal_length", "radius_ratio"})
    if (entry.limits.count(key) == 0) limits[key] = false;
  if (!limits.empty()) then["limits"] = {{"properties", limits}};
  if (!entry.takes_adaptive_steps) then["adaptive"] = false;
  json required = json::array();
  for (const Entry& other : entries())
    for (const FormulaKey& key : other.formulas) then[key.name] = false;
  then["initial"] = initial_file_schema();
  for (const FormulaKey& key : entry.formulas) {
    then[key.name] = described(key.schema, key.help);
    if (key.name == "initial") then[key.name] = {{"anyOf", {then[key.name], initial_file_schema()}}};
    if (key.is_required) required.push_back(key.name);
  }
  return {{"if", is}, {"then", described({{"properties", then}, {"required", required}}, entry.help)}};
}

/// A named surface with its parameters, or a formula.
json surface_schema() {
  const json positive = {{"type", "number"}, {"exclusiveMinimum", 0}}, number = {{"type", "number"}};
  const json surfaces = named_surface_defaults();
  json choices = json::array();
  for (const auto& [name, defaults] : surfaces.items()) {
    json properties = {{"name", {{"const", name}}}};
    for (const auto& [parameter, value] : defaults.items()) {
      properties[parameter] = value.is_array() ? json{{"type", "array"},
                                                      {"items", positive},
                                                      {"minItems", value.size()},
                                                      {"maxItems", value.size()}}
                                               : positive;
      properties[parameter]["default"] = value;
    }
    choices.push_back(object_of(properties));
    choices.back()["required"] = json::array({"name"});
  }
  const json corner = {{"type", "array"}, {"items", number}, {"minItems", 3}, {"maxItems", 3}};
  choices.push_back(
      object_of({{"level_set", described({{"type", "string"}}, "a formula d(x, y, z), d < 0 inside")},
                 {"box", described({{"type", "array"}, {"items", corner}, {"minItems", 2}, {"maxItems", 2}},
                                   "two corners of a box around the surface")},
                 {"parameters", described({{"type", "object"}, {"additionalProperties", number}},
                                          "numbers that the formula names")}}));
  choices.back()["required"] = json::array({"level_set", "box"});
  return {{"description", "exact initial surface and its parameters"}, {"oneOf", choices}};
}

/// The keys that all flows have.
json common_properties() {
  const json positive = {{"type", "number"}, {"exclusiveMinimum", 0}}, text = {{"type", "string"}};
  const auto integer = [](int low, int high) {
    return json{{"type", "integer"}, {"minimum", low}, {"maximum", high}};
  };
  const json number = {{"type", "number"}};
  const json mesh = {
      {"file", described(text, "a mesh file")},
      {"remesh", described(positive, "replaces flat triangles by new ones with edges of about this length")},
      {"curve",
       {{"description", "puts the nodes on a smooth surface through the corners"},
        {"anyOf", {{{"type", "boolean"}}, object_of({{"feature_angle", {{"type", "number"}}}})}}}},
      {"refine", described(integer(0, 8), "how often each triangle of the file is cut into four")},
      {"edge_length", described(positive, "largest edge of a generated mesh")},
      {"grading",
       {{"type", "number"},
        {"exclusiveMinimum", 0},
        {"maximum", 1},
        {"description", "of a generated mesh: edges are at most this times the radius of curvature"}}},
      {"subdivisions", described(integer(0, 10), "of an icosahedron")}};
  const json adaptive = {{"end_time", {{"type", "number"}, {"minimum", 0}}},
                         {"tolerance", positive},
                         {"first_step", positive},
                         {"largest_step", positive}};
  const json output = {
      {"nodal", described(text, "nodal values at the end, JSON")},
      {"series", described(text, "what is recorded of each step, JSON; .csv: as lines while it runs")},
      {"history", described({{"type", "boolean"}}, "nodal values with those of the steps before")},
      {"vtu", described(text, "snapshots for ParaView, .pvd")},
      {"checkpoint", described(text, "the same command resumes from it")},
      {"every", described(integer(0, 100000000), "snapshots at every n-th step")},
      {"every_time", described(positive, "snapshots at multiples of this time")},
      {"times", {{"type", "array"}, {"minItems", 1}, {"items", {{"type", "number"}}}}}};
  const json stop = {
      {"speed", described(positive, "stationary: largest |v| in the nodes below this")},
      {"energy_rate", described(positive, "stationary: |dE/dt| of the flow's energy below this")},
      {"area", described(positive, "area relative to that at the start")},
      {"seconds", described(positive, "of wall-clock time")}};
  const json limits = {{"curvature_size", positive},
                       {"radius_ratio", {{"type", "number"}, {"exclusiveMinimum", -1}}},
                       {"normal_length", {{"type", "number"}, {"exclusiveMinimum", 1}}}};
  return {{"$schema", text},
          {"surface", surface_schema()},
          {"mesh", object_of(mesh)},
          {"initial", {{"type", "object"}}},
          {"stop", described(object_of(stop), "ends the run before its last step")},
          {"degree", described(integer(1, max_degree), "of the finite elements")},
          {"bdf", described(integer(1, max_bdf_order), "order of the backward difference formula")},
          {"tau", described(positive, "step size")},
          {"steps", described(integer(0, 100000000), "end time = steps tau")},
          {"start", {{"type", "string"}, {"pattern", "^(exact|cascade|substeps:[1-9][0-9]*)$"}}},
          {"adaptive", described(object_of(adaptive), "instead of tau, steps and start")},
          {"quadrature", object_of({{"conical", integer(1, 20)}, {"degree", integer(1, 20)}})},
          {"limits", object_of(limits)},
          {"exact", exact_schema()},
          {"definitions", definitions_schema()},
          {"output", object_of(output)}};
}

}  // namespace

json evolve_schema() {
  json properties = common_properties(), rules = json::array(), flows = json::array(),
       problems = json::array();
  for (const Entry& entry : entries()) {
    const bool is_first = std::find(flows.begin(), flows.end(), entry.flow) == flows.end();
    if (is_first) flows.push_back(entry.flow);
    if (!entry.problem.empty()) problems.push_back(entry.problem);
    for (const FormulaKey& key : entry.formulas) properties[key.name] = json::object();
    rules.push_back(rule_of(entry, is_first));
  }
  properties["flow"] = {{"enum", flows}};
  properties["problem"] = {{"enum", problems}};
  properties["variant"] = properties["parameters"] = {{"type", "object"}};
  json schema = object_of(properties);
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Configuration of evolve";
  schema["required"] = {"flow"};
  schema["anyOf"] = {{{"required", {"mesh"}}},
                     {{"required", {"initial"}}, {"properties", {{"initial", {{"required", {"file"}}}}}}}};
  schema["allOf"] = rules;
  return schema;
}

}  // namespace esfem
