// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/surfaces/named.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/did_you_mean.hpp"
#include "solver/error.hpp"
#include "solver/surfaces/angenent_torus.hpp"
#include "solver/surfaces/formula_surface.hpp"

namespace esfem {

namespace {

using nlohmann::json;

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// A list of `count` positive numbers from a JSON number or array.
std::vector<double> positive_numbers(const json& value, size_t count, const std::string& what) {
  const json list = value.is_array() ? value : json::array({value});
  bool good = list.size() == count;
  for (const json& entry : list) good = good && entry.is_number() && entry.get<double>() > 0;
  if (!good) {
    const std::string expected = count == 1 ? "a positive number" : format("%zu positive numbers", count);
    throw InputError("surface: " + what + " is " + value.dump() + "; expected " + expected);
  }
  return list.get<std::vector<double>>();
}

Surface checked_perturbed_torus(double major, double minor, double amplitude, double waves) {
  if (waves != std::floor(waves) || waves > 1000)
    throw InputError(
        format("surface: perturbed_torus with waves = %g; expected an integer from 1 to 1000", waves));
  if (amplitude >= minor || minor + amplitude >= major)
    throw InputError(
        format("surface: perturbed_torus with major = %g, minor = %g, amplitude = %g; expected amplitude < "
               "minor and minor + amplitude < major",
               major, minor, amplitude));
  return perturbed_torus(major, minor, amplitude, static_cast<int>(waves));
}

/// One named surface: its parameters with defaults, and how it is made from them (in the order of the
/// defaults).
struct Entry {
  std::string name;
  std::vector<std::pair<std::string, json>> defaults;
  std::function<Surface(const std::vector<std::vector<double>>&)> make;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> list = {
      {"sphere", {{"radius", 1}}, [](const auto& p) { return sphere(p[0][0]); }},
      {"ellipsoid",
       {{"axes", {1, 1, 0.6}}},
       [](const auto& p) { return ellipsoid(p[0][0], p[0][1], p[0][2]); }},
      {"torus",
       {{"major", 1}, {"minor", 0.4}},
       [](const auto& p) {
         if (p[1][0] >= p[0][0]) {
           throw InputError(format("surface: torus with minor = %g and major = %g; expected minor < major",
                                   p[1][0], p[0][0]));
         }
         return torus(p[0][0], p[1][0]);
       }},
      {"dumbbell", {}, [](const auto&) { return dumbbell(); }},
      {"perturbed_torus",
       {{"major", 1}, {"minor", 0.6}, {"amplitude", 0.05}, {"waves", 3}},
       [](const auto& p) { return checked_perturbed_torus(p[0][0], p[1][0], p[2][0], p[3][0]); }},
      {"red_blood_cell", {}, [](const auto&) { return red_blood_cell(); }},
      {"evans_fung_cell", {}, [](const auto&) { return evans_fung_cell(); }},
      {"angenent_torus", {{"scale", 1}}, [](const auto& p) { return angenent_torus(p[0][0]); }},
  };
  return list;
}

Vec3 corner_of(const json& box, int which) {
  Vec3 corner;
  bool good = box.is_array() && box.size() == 2 && box[which].is_array() && box[which].size() == 3;
  for (int i = 0; good && i < 3; ++i) {
    good = box[which][i].is_number();
    if (good) corner[i] = box[which][i];
  }
  if (good) return corner;
  throw InputError("surface: found box = " + box.dump() +
                   "; expected [[x, y, z], [x, y, z]], two corners of a box around the surface");
}

/// {"level_set": "x^2 + y^2 + z^2 - R^2", "box": [[-2, -2, -2], [2, 2, 2]], "parameters": {"R": 1}}
Surface surface_of_formula(const json& description, FormulaNames names) {
  for (const auto& item : description.items())
    if (item.key() != "level_set" && item.key() != "box" && item.key() != "parameters")
      throw InputError("surface: unknown key \"" + item.key() +
                       "\" beside level_set; known: box, level_set, parameters" +
                       did_you_mean(item.key(), {"box", "level_set", "parameters"}));
  const json &formula = description.at("level_set"),
             parameters = description.value("parameters", json::object());
  if (!formula.is_string())
    throw InputError("surface: found level_set = " + formula.dump() +
                     "; expected a formula in x, y, z as text");
  if (!description.contains("box"))
    throw InputError(
        "surface: a level_set needs \"box\": [[x, y, z], [x, y, z]], two corners of a box around "
        "the surface");
  if (!parameters.is_object())
    throw InputError("surface: found parameters = " + parameters.dump() +
                     "; expected {\"name\": number, ..}");
  for (const auto& item : parameters.items()) {
    if (!item.value().is_number())
      throw InputError("surface: parameters: found " + item.key() + " = " + item.value().dump() +
                       "; expected a number");
    names.constants[item.key()] = item.value();
    names.definitions.erase(item.key());
  }
  const json& box = description.at("box");
  try {
    return formula_surface(formula, {corner_of(box, 0), corner_of(box, 1)}, names.constants,
                           "surface: level_set", names.definitions);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.find("unknown name") == std::string::npos) throw;
    throw InputError(message +
                     "; numbers that it names stand in \"parameters\", of the surface or "
                     "of the configuration, parts of formulas in \"definitions\"");
  }
}

}  // namespace

Surface named_surface(const json& description, const FormulaNames& names) {
  if (description.is_object() && description.contains("level_set"))
    return surface_of_formula(description, names);
  const std::string name = description.is_object() ? description.value("name", json()).dump() : "";
  for (const Entry& entry : entries()) {
    if (name != json(entry.name).dump()) continue;
    for (const auto& item : description.items()) {
      const std::string& key = item.key();
      const bool known = key == "name" || std::any_of(entry.defaults.begin(), entry.defaults.end(),
                                                      [&](const auto& p) { return p.first == key; });
      if (known) continue;
      std::vector<std::string> keys = {"name"};
      for (const auto& p : entry.defaults) keys.push_back(p.first);
      throw InputError("surface: unknown key \"" + key + "\" for " + entry.name + "; known: " + joined(keys) +
                       did_you_mean(key, keys));
    }
    std::vector<std::vector<double>> parameters;
    for (const auto& [key, value] : entry.defaults) {
      const json given = description.value(key, value);
      parameters.push_back(positive_numbers(given, value.is_array() ? value.size() : 1, key));
    }
    return entry.make(parameters);
  }
  std::vector<std::string> known;
  for (const Entry& entry : entries()) known.push_back(entry.name);
  const bool has_name = description.is_object() && description.value("name", json()).is_string();
  throw InputError("surface: " + description.dump() + " names no surface; expected {\"name\": one of " +
                   joined(known) + ", ...} or {\"level_set\": a formula, \"box\": ..}" +
                   (has_name ? did_you_mean(description.at("name"), known) : ""));
}

json named_surface_defaults() {
  json defaults = json::object();
  for (const Entry& entry : entries()) {
    defaults[entry.name] = json::object();
    for (const auto& [name, value] : entry.defaults) defaults[entry.name][name] = value;
  }
  return defaults;
}

std::string named_surfaces_help() {
  std::string text;
  for (const Entry& entry : entries()) {
    text += "  " + entry.name;
    for (const auto& [key, value] : entry.defaults) text += ", \"" + key + "\": " + value.dump();
    text += "\n";
  }
  text +=
      "  \"level_set\": \"x^2 + y^2 + z^2/c^2 - 1\", \"box\": [[-2, -2, -2], [2, 2, 2]], \"parameters\": "
      "{\"c\": 0.6}, instead of a name: {d = 0} in a box, for a formula d < 0 inside;\n"
      "      it may name \"definitions\" and given numbers of \"parameters\" of the configuration, too; of "
      "several "
      "components the\n      box contains one\n";
  return text;
}

}  // namespace esfem
