// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/config.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/initial.hpp"
#include "experiments/evolve/mesh.hpp"
#include "experiments/evolve/series_lines.hpp"
#include "experiments/evolve/start.hpp"
#include "experiments/evolve/units.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/did_you_mean.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/surfaces/named.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {

namespace {

const std::set<std::string> adaptive_keys = {"end_time", "tolerance", "first_step", "largest_step"};
const std::set<std::string> output_keys = {"nodal", "history",    "series", "vtu",
                                           "every", "every_time", "times",  "checkpoint"};

using nlohmann::json;

double positive_or(const JsonReader& reader, const std::string& key, double otherwise) {
  const double value = reader.number_or(key, otherwise);
  if (value > 0) return value;
  throw InputError(
      format("%s: found %s = %g; expected a positive number", reader.where().c_str(), key.c_str(), value));
}

/// The order of BDF where none is given.
int standard_order(const JsonReader& whole, const Entry& entry) {
  return whole.has("surface") ? entry.order : entry.order_on_files;
}

/// Adaptive steps stand in the place of tau, steps and start.
AdaptiveSteps adaptive_grid(const JsonReader& whole, const Entry& entry) {
  if (!entry.takes_adaptive_steps)
    throw InputError(whole.where() + ": problem " + entry.problem +
                     " takes equal steps; expected tau and steps");
  for (const char* key : {"tau", "steps", "start"}) {
    if (whole.has(key))
      throw InputError(whole.where() + ": found adaptive and " + key + "; expected one of them");
  }
  const JsonReader reader(whole.object("adaptive"), whole.where() + ": adaptive");
  reader.accept_only(adaptive_keys);
  AdaptiveSteps grid;
  const int highest = std::min(2, entry.highest_order);
  grid.order = whole.integer_within("bdf", std::min(highest, standard_order(whole, entry)), 1, highest);
  grid.end_time = reader.number("end_time");
  grid.tolerance = positive_or(reader, "tolerance", grid.tolerance);
  grid.first_step = positive_or(reader, "first_step", grid.first_step);
  if (reader.has("largest_step")) grid.largest_step = positive_or(reader, "largest_step", 0);
  if (reader.has("first_step") && grid.end_time > 0 && grid.first_step >= grid.end_time)
    throw InputError(
        format("%s: found first_step = %g and end_time = %g; expected first_step < end_time, since "
               "the first step is not controlled",
               reader.where().c_str(), grid.first_step, grid.end_time));
  return grid;
}

UniformSteps time_grid(const JsonReader& reader, const Entry& entry) {
  UniformSteps grid;
  grid.order = reader.integer_within("bdf", standard_order(reader, entry), 1, entry.highest_order);
  grid.tau = reader.number("tau");
  grid.steps = reader.integer_within("steps", 0, 0, 100000000);
  if (!(grid.tau > 0)) {
    throw InputError(
        format("%s: found tau = %g; expected a positive step size", reader.where().c_str(), grid.tau));
  }
  if (reader.has("start"))
    grid.start = headed(reader.where(), [&] { return parse_start(reader.text("start")); });
  return grid;
}

Quadrature quadrature(const json& description, const std::string& where) {
  const JsonReader reader(description, where);
  const std::string key = reader.only_key({"conical", "degree"});
  return headed(where, [&] {
    return key == "conical" ? conical_quadrature(reader.integer("conical"))
                            : symmetric_quadrature(reader.integer("degree"));
  });
}

/// For messages: the flow, or where it has several the problem.
std::string words_for(const Entry& entry) {
  return entry.problem.empty() ? "flow " + entry.flow : "problem " + entry.problem;
}

/// Refuses keys that are not known at the top, and says where one of this name belongs.
void accept_only_known(const JsonReader& reader, const std::set<std::string>& known) {
  std::map<std::string, std::set<std::string>> parts = {
      {"mesh", mesh_keys()}, {"adaptive", adaptive_keys}, {"output", output_keys}};
  for (const Entry& entry : entries()) {
    parts["variant"].merge(names_of(entry.variant));
    parts["parameters"].merge(names_of(entry.parameters));
  }
  for (const auto& [part, keys] : parts)
    for (const std::string& key : keys)
      if (reader.has(key) && known.count(key) == 0)
        throw InputError(reader.where() + ": found " + key + ", which belongs in \"" + part + "\"");
  reader.accept_only(known);
}

/// What is given under "variant" or "parameters", where the flow has such keys.
Settings settings(const JsonReader& reader, const std::string& key, const std::vector<Key>& known,
                  const Entry& entry) {
  const std::string where = reader.where() + ": " + key;
  const bool takes_any_number = entry.takes_own_parameters && key == "parameters";
  if (!reader.has(key)) return Settings(json::object(), known, where);
  const bool is_variant = key == "variant";
  if (!takes_any_number) {
    for (const std::string& other : names_of(is_variant ? entry.parameters : entry.variant))
      if (reader.object(key).contains(other) && names_of(known).count(other) == 0)
        throw InputError(where + ": found " + other + ", which belongs in \"" +
                         (is_variant ? "parameters" : "variant") + "\"");
    if (known.empty())
      throw InputError(reader.where() + ": " + words_for(entry) + " has no " +
                       (is_variant ? "variants" : key) + "; expected no key " + key);
  }
  return Settings(reader.object(key), known, where, takes_any_number);
}

/// The keys whose values have formulas, of all flows and of any.
std::set<std::string> formula_keys() {
  std::set<std::string> names = {"exact", "definitions"};
  for (const Entry& entry : entries())
    for (const FormulaKey& key : entry.formulas) names.insert(key.name);
  return names;
}

/// Whether a key is "initial" with a file, which has no formulas.
bool names_file(const JsonReader& reader, const std::string& key) {
  return key == "initial" && reader.object(key).contains("file");
}

void read_formulas(const JsonReader& reader, EvolveConfig& config) {
  std::set<std::string> known = {"exact", "definitions"};
  for (const std::string& key : known)
    if (reader.has(key)) config.formulas[key] = reader.object(key);
  const Entry& entry = *config.entry;
  const std::string name = words_for(entry);
  for (const FormulaKey& key : entry.formulas) {
    known.insert(key.name);
    if (reader.has(key.name) && !names_file(reader, key.name))
      config.formulas[key.name] = reader.value(key.name);
    else if (key.is_required)
      throw InputError(reader.where() + ": " + name + " needs the key " + key.name + "; expected \"" +
                       key.name + "\": " + key.example);
  }
  for (const std::string& key : formula_keys())
    if (reader.has(key) && known.count(key) == 0 && !names_file(reader, key))
      throw InputError(reader.where() + ": " + name + " takes no " + key + "; expected no key " + key +
                       (names_of(entry.variant).count(key) > 0 ? " here: \"variant\" has one" : ""));
}

/// Refuses a number of one's own that no formula names: it is misspelt.
void require_named_parameters(const JsonReader& reader, const EvolveConfig& config) {
  std::set<std::string> names = names_in_formulas(config);
  if (reader.has("surface")) names.merge(names_in(reader.object("surface")));
  for (const Key& key : config.entry->parameters) names.insert(key.name);
  std::string others;
  std::vector<std::string> own_names;
  for (const Key& key : config.entry->parameters) own_names.push_back(key.name);
  for (const auto& [name, value] : config.parameters.numbers()) others += (others.empty() ? "" : ", ") + name;
  for (const auto& [name, value] : config.parameters.numbers())
    if (names.count(name) == 0)
      throw InputError(config.source + ": parameters: found " + name +
                       ", which no formula names; found are " + others + did_you_mean(name, own_names));
}

/// "limits": the bounds beyond which a run is singular.
void read_limits(const JsonReader& reader, EvolveConfig& config) {
  reader.accept_only({"curvature_size", "radius_ratio", "normal_length"});
  const std::set<std::string>& known = config.entry->limits;
  const auto read = [&](const char* key, double low, std::optional<double>& limit) {
    if (!reader.has(key)) return;
    if (known.count(key) == 0)
      throw InputError(reader.where() + ": found " + key + ", which " + words_for(*config.entry) +
                       " does not look at; expected " + (known.empty() ? "no key limits" : listed(known)));
    limit = reader.number(key);
    if (!(*limit > low))
      throw InputError(format("%s: found %s = %g; expected a number greater than %g", reader.where().c_str(),
                              key, *limit, low));
  };
  read("curvature_size", 0, config.limits.curvature_size);
  read("radius_ratio", -1, config.limits.radius_ratio);
  read("normal_length", 1, config.limits.normal_length);
}

/// "stop": when a run ends before its last step.
void read_stop(const JsonReader& reader, EvolveConfig& config) {
  reader.accept_only({"speed", "energy_rate", "seconds", "area"});
  if (reader.has("energy_rate")) {
    if (config.entry->energy.empty())
      throw InputError(reader.where() + ": found energy_rate, but " + words_for(*config.entry) +
                       " has no energy; expected speed, area or seconds");
    config.stop.energy_rate = positive_or(reader, "energy_rate", 0);
  }
  if (reader.has("speed")) config.stop.speed = positive_or(reader, "speed", 0);
  if (reader.has("seconds")) config.stop.seconds = positive_or(reader, "seconds", 0);
  if (!reader.has("area")) return;
  config.stop.area = positive_or(reader, "area", 0);
  if (*config.stop.area == 1)
    throw InputError(reader.where() +
                     ": found area = 1, the one at the start; expected a smaller or a larger number");
}

/// "history" of the output: whether the nodal values have those of the past, so that a run can go on from
/// them.
bool wants_history(const JsonReader& output, const EvolveConfig& config) {
  const bool is_possible = !config.adaptive && !config.nodal.empty();
  if (!output.has("history")) return is_possible && config.nodal != "-";
  const bool wanted = output.truth_or("history", false);
  if (wanted && !is_possible)
    throw InputError(output.where() + ": found history = true" +
                     (config.adaptive ? " and adaptive steps; expected equal steps (tau), or a checkpoint"
                                      : "; expected the key nodal, too"));
  return wanted;
}

/// What is expected for surface and mesh, whose names are often given alone.
constexpr char a_surface[] = "an object like {\"name\": \"sphere\"}";
constexpr char a_mesh[] = "an object like {\"edge_length\": 0.2} or {\"file\": \"NAME\"}";

/// Empty when the key is not there.
std::string file_name(const JsonReader& output, const std::string& key) {
  if (!output.has(key)) return "";
  if (!output.text(key).empty()) return output.text(key);
  throw InputError(output.where() + ": found " + key + " = \"\"; expected the name of a file");
}

/// "every", "every_time" and "times" of the output; they need "vtu".
SnapshotPlan snapshot_plan(const JsonReader& output) {
  SnapshotPlan plan;
  plan.pvd = file_name(output, "vtu");
  if (!plan.pvd.empty() && std::filesystem::path(plan.pvd).extension() != ".pvd")
    throw InputError(output.where() + ": found vtu = \"" + plan.pvd +
                     "\"; expected a name that ends in .pvd");
  plan.every = output.integer_within("every", 0, 0, 100000000);
  if (output.has("every_time")) plan.every_time = positive_or(output, "every_time", 0);
  if (output.has("times")) {
    for (const json& time : output.array("times")) {
      if (!time.is_number()) output.wrong_type("times", "an array of numbers", time);
      plan.times.push_back(time);
    }
    if (plan.times.empty()) throw InputError(output.where() + ": times: found none; expected one or more");
  }
  if (plan.pvd.empty() && (output.has("every") || output.has("every_time") || output.has("times"))) {
    throw InputError(output.where() +
                     ": every, every_time and times select snapshots; expected the key vtu, too");
  }
  return plan;
}

/// Refuses snapshots before the run; those after it are missed, as when it is made shorter for a trial.
void check_times(const EvolveConfig& config) {
  const double begin = config.grid.time(0);
  const double end = config.adaptive ? config.adaptive->end_time : config.grid.time(config.grid.steps);
  const double slack = 1e-9 * (end - begin);
  for (const double t : config.snapshots.times) {
    const std::string found = config.source + format(": output: times: found %g, ", t);
    if (t < begin - slack)
      throw InputError(found + format("before the run; expected times from %g on", begin));
    if (t > end + slack) return warn(found + format("after the end of the run at t = %g", end));
  }
}

/// A configuration without its mesh, and what that will be made of.
struct Keys {
  json description;
  std::optional<Initial> earlier;
  std::optional<int> degree;
  EvolveConfig config;
};

/// Reads all keys but those of the mesh.
Keys read_keys(const json& given, const std::string& source) {
  std::set<std::string> known = {"$schema", "flow",       "surface",  "mesh",       "degree",  "bdf",
                                 "tau",     "steps",      "start",    "quadrature", "variant", "output",
                                 "problem", "parameters", "adaptive", "limits",     "initial", "stop"};
  known.merge(formula_keys());
  accept_only_known(JsonReader(given, source), known);
  Keys keys{given, read_initial(given, source), {}, {}};
  if (keys.earlier) keys.description.update(keys.earlier->taken_over);
  const JsonReader reader(keys.description, source);
  EvolveConfig& config = keys.config;
  const Entry& entry =
      entry_named(reader.text("flow"), reader.has("problem") ? reader.text("problem") : "", source);
  config.entry = &entry;
  config.source = source;
  if (reader.has("adaptive"))
    config.adaptive = adaptive_grid(reader, entry);
  else
    config.grid = time_grid(reader, entry);
  config.start_given = reader.has("start");
  if (reader.has("limits")) read_limits(JsonReader(reader.object("limits"), source + ": limits"), config);
  if (reader.has("stop")) read_stop(JsonReader(reader.object("stop"), source + ": stop"), config);
  if (reader.has("output")) {
    const JsonReader output(reader.object("output"), source + ": output");
    output.accept_only(output_keys);
    config.nodal = file_name(output, "nodal");
    config.series = file_name(output, "series");
    config.checkpoint = file_name(output, "checkpoint");
    config.snapshots = snapshot_plan(output);
    config.nodal_has_history = wants_history(output, config);
  }
  config.variant = settings(reader, "variant", entry.variant, entry);
  config.parameters = settings(reader, "parameters", entry.parameters, entry);
  read_formulas(reader, config);
  if (reader.has("surface")) {
    const json& surface = reader.object("surface", a_surface);
    config.surface = headed(source, [&] { return named_surface(surface, given_names(config)); });
  }
  if (config.stop.area && is_at_rest(config))
    throw InputError(source + ": stop: found area, but the surface is at rest; expected speed or seconds");
  // An unknown name in a formula is told before the parameter that it leaves unused.
  if (entry.check) entry.check(config, source);
  if (entry.takes_own_parameters) require_named_parameters(reader, config);
  if (reader.has("degree")) keys.degree = reader.integer_within("degree", 0, 1, max_degree);
  return keys;
}

}  // namespace

bool has_given_motion(const EvolveConfig& config) {
  const json& formulas = config.formulas;
  return config.entry->has_given_motion ||
         (formulas.contains("kinetics") && !formulas.at("kinetics").contains("g"));
}

bool is_at_rest(const EvolveConfig& config) {
  return has_given_motion(config) && !config.formulas.contains("velocity") && !config.entry->moves_as_given;
}

EvolveConfig checked_keys(const json& given, const std::string& source) {
  Keys keys = read_keys(given, source);
  if (!keys.earlier)
    check_mesh_keys(JsonReader(JsonReader(given, source).object("mesh", a_mesh), source + ": mesh"),
                    keys.config.surface.has_value());
  return std::move(keys.config);
}

EvolveConfig evolve_config(const json& given, const std::string& source) {
  Keys keys = read_keys(given, source);
  std::optional<Initial>& earlier = keys.earlier;
  const std::optional<int>& degree = keys.degree;
  EvolveConfig& config = keys.config;
  const Entry& entry = *config.entry;
  const JsonReader reader(keys.description, source);
  const std::string place = earlier ? "initial" : "mesh";
  const JsonReader mesh(reader.object(place, earlier ? "an object" : a_mesh), source + ": " + place);
  if (mesh.has("file") && is_snapshot_of(mesh.text("file"), config.snapshots.pvd))
    throw InputError(
        source + ": output: found vtu = \"" + config.snapshots.pvd +
        "\", but the mesh is one of its snapshots, which a new run removes; expected another name");
  EvolveMesh initial = earlier ? std::move(earlier->surface) : evolve_mesh(mesh, degree, config.surface);
  config.mesh = std::move(initial.start.mesh);
  config.mesh_remarks = std::move(initial.remarks);
  config.fields = std::move(initial.start.fields);
  config.node_numbers = std::move(initial.start.node_numbers);
  config.mesh_origin = std::move(initial.start.origin);
  const int k = config.mesh.degree;
  config.rule = reader.has("quadrature") ? quadrature(reader.object("quadrature"), source + ": quadrature")
                : entry.lumps_linear_elements && k == 1 ? vertex_quadrature()
                                                        : default_quadrature(k);
  if (earlier) take_initial(std::move(*earlier), config);
  move_near_origin(config);
  scale_defaults(reader, config);
  if (earlier) require_start(config, source + ": initial");
  check_times(config);
  take_initial_values(config);
  return std::move(keys.config);
}

}  // namespace esfem
