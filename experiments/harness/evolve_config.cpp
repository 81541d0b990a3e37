// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_config.hpp"

#include <algorithm>
#include <map>

#include "experiments/harness/evolve_mesh.hpp"
#include "experiments/harness/evolve_units.hpp"
#include "solver/analysis/json_reader.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem {

namespace {

using nlohmann::json;

const std::set<std::string> known_flows = {
    "mean_curvature", "dziuk", "bgn", "coupled_diffusion", "willmore", "surface_diffusion", "cahn_hilliard"};

double positive_or(const JsonReader& reader, const std::string& key, double otherwise) {
  const double value = reader.number_or(key, otherwise);
  if (value > 0) return value;
  throw InputError(
      format("%s: found %s = %g; expected a positive number", reader.where().c_str(), key.c_str(), value));
}

/// The order of BDF where none is given. With a higher one than 1 the nodes of Dziuk's scheme drift along
/// surfaces that are rough, as meshes of files are, until elements degenerate (DziukFlow).
int standard_order(const JsonReader& whole, const std::string& flow) {
  const bool rough = flow == "dziuk" && !whole.has("surface");
  return flow == "bgn" || rough ? 1 : 3;
}

/// Adaptive steps stand in the place of tau, steps and start.
AdaptiveSteps adaptive_grid(const JsonReader& whole, const std::string& flow) {
  for (const char* key : {"tau", "steps", "start"}) {
    if (whole.has(key))
      throw InputError(whole.where() + ": found adaptive and " + key + "; expected one of them");
  }
  const JsonReader reader(whole.object("adaptive"), whole.where() + ": adaptive");
  reader.accept_only({"end_time", "tolerance", "first_step", "largest_step"});
  AdaptiveSteps grid;
  const int highest = flow == "bgn" ? 1 : 2;
  grid.order = whole.integer_within("bdf", std::min(highest, standard_order(whole, flow)), 1, highest);
  grid.end_time = reader.number("end_time");
  grid.tolerance = positive_or(reader, "tolerance", grid.tolerance);
  grid.first_step = positive_or(reader, "first_step", grid.first_step);
  if (reader.has("largest_step")) grid.largest_step = positive_or(reader, "largest_step", 0);
  if (reader.has("first_step") && grid.end_time > 0 && grid.first_step >= grid.end_time)
    throw InputError(
        format("%s: found first_step = %g, which is not controlled, and end_time = %g; expected a "
               "first step that is smaller",
               reader.where().c_str(), grid.first_step, grid.end_time));
  return grid;
}

UniformSteps time_grid(const JsonReader& reader, const std::string& flow) {
  UniformSteps grid;
  const bool one_step = flow == "bgn";
  grid.order = reader.integer_within("bdf", standard_order(reader, flow), 1, one_step ? 1 : max_bdf_order);
  grid.tau = reader.number("tau");
  grid.steps = reader.integer_within("steps", 0, 0, 100000000);
  if (!(grid.tau > 0)) {
    throw InputError(
        format("%s: found tau = %g; expected a positive step size", reader.where().c_str(), grid.tau));
  }
  if (reader.has("start")) grid.start = parse_start(reader.text("start"));
  return grid;
}

Quadrature quadrature(const json& description, const std::string& where) {
  const JsonReader reader(description, where);
  const std::string key = reader.only_key({"conical", "degree"});
  return key == "conical" ? conical_quadrature(reader.integer("conical"))
                          : symmetric_quadrature(reader.integer("degree"));
}

MeanCurvatureFlow::Variant mean_curvature_variant(const json& description, const std::string& where) {
  using Variant = MeanCurvatureFlow::Variant;
  const JsonReader reader(description, where);
  reader.accept_only({"velocity", "normalise", "stabilise", "reinitialise"});
  Variant variant;
  if (reader.has("velocity")) {
    const std::string velocity = reader.text("velocity");
    if (velocity != "ritz" && velocity != "interpolation") {
      throw InputError(where + ": found velocity = \"" + velocity + "\"; expected ritz or interpolation");
    }
    variant.velocity = velocity == "ritz" ? Variant::ritz : Variant::interpolation;
  }
  variant.normalise = reader.truth_or("normalise", false);
  variant.stabilise = reader.number_or("stabilise", 0);
  if (!(variant.stabilise >= 0)) {
    throw InputError(
        format("%s: found stabilise = %g; expected a number >= 0", where.c_str(), variant.stabilise));
  }
  if (reader.has("reinitialise")) variant.reinitialise = positive_or(reader, "reinitialise", 0);
  return variant;
}

/// The value of a key that is one of some words, by their names.
template <class Value>
Value choice(const JsonReader& reader, const std::string& key, const std::map<std::string, Value>& words,
             Value otherwise) {
  if (!reader.has(key)) return otherwise;
  const auto found = words.find(reader.text(key));
  if (found != words.end()) return found->second;
  std::set<std::string> names;
  for (const auto& [name, value] : words) names.insert(name);
  throw InputError(reader.where() + ": found " + key + " = \"" + reader.text(key) + "\"; expected one of " +
                   listed(names));
}

/// Variant of Willmore flow and surface diffusion. theta needs exact data, and is on where there are such.
void read_willmore_variant(const json& description, const std::string& where, EvolveConfig& config) {
  using Variant = WillmoreFlow::Variant;
  const JsonReader reader(description, where);
  reader.accept_only({"F", "project", "theta", "relaxation", "reinitialise"});
  Variant& variant = config.willmore;
  variant.law = config.flow == "willmore" ? Variant::willmore : Variant::surface_diffusion;
  variant.F = choice<Variant::Coupling>(
      reader, "F", {{"extrapolated", Variant::extrapolated}, {"implicit", Variant::implicit}}, variant.F);
  variant.project = reader.truth_or("project", variant.project);
  variant.relaxation = reader.number_or("relaxation", 0);
  if (!(variant.relaxation >= 0)) {
    throw InputError(
        format("%s: found relaxation = %g; expected a number >= 0", where.c_str(), variant.relaxation));
  }
  if (reader.has("reinitialise")) variant.reinitialise = positive_or(reader, "reinitialise", 0);
  config.willmore_theta = reader.truth_or("theta", config.surface.has_value());
  if (config.willmore_theta && !config.surface)
    throw InputError(where + ": theta needs exact initial data; expected a \"surface\", or \"theta\": false");
}

void require_unit_sphere(const EvolveConfig& config, const std::string& what) {
  if (config.surface && config.surface->name == "sphere" && config.surface->parameters.at("radius") == 1)
    return;
  throw InputError(
      what + " starts from the unit sphere; expected \"surface\": {\"name\": \"sphere\", \"radius\": 1}");
}

/// The manufactured solution on an ellipsoid that starts as the unit sphere, bk22 §9, or the separation of a
/// disturbed mixture on a surface at rest.
void read_cahn_hilliard(const JsonReader& reader, const std::string& source, EvolveConfig& config) {
  auto& run = config.cahn_hilliard;
  using Run = std::decay_t<decltype(run)>;
  run.problem =
      choice(reader, "problem", {{"ellipsoid", Run::ellipsoid}, {"phase_separation", Run::phase_separation}},
             run.problem);
  const bool on_ellipsoid = run.problem == Run::ellipsoid;
  if (on_ellipsoid) {
    require_unit_sphere(config, source + ": problem ellipsoid");
    if (config.adaptive)
      throw InputError(source + ": problem ellipsoid takes equal steps; expected tau and steps");
  }
  if (reader.has("parameters")) {
    const JsonReader parameters(reader.object("parameters"), source + ": parameters");
    parameters.accept_only(on_ellipsoid ? std::set<std::string>{"epsilon"}
                                        : std::set<std::string>{"epsilon", "mean", "disturbance", "seed"});
    run.epsilon = positive_or(parameters, "epsilon", run.epsilon);
    run.mean = parameters.number_or("mean", run.mean);
    run.disturbance = parameters.number_or("disturbance", run.disturbance);
    run.seed = parameters.integer_within("seed", run.seed, 0, 1000000);
  }
  if (!reader.has("variant")) return;
  if (!on_ellipsoid)
    throw InputError(source + ": problem phase_separation has no variants; expected no key variant");
  const json& description = reader.object("variant");
  const JsonReader variant(description, source + ": variant");
  variant.accept_only({"theta", "initial"});
  run.theta = variant.truth_or("theta", false);
  run.initial = choice<StartValues>(
      variant, "initial", {{"interpolation", StartValues::interpolation}, {"ritz", StartValues::ritz}},
      StartValues::interpolation);
}

/// "mass", "law" and, for the growing sphere, "coupling".
void read_coupled_variant(const JsonReader& variant, EvolveConfig::Coupled& coupled) {
  using Variant = CoupledDiffusionVariant;
  using Problem = GrowingSphereProblem;
  const bool is_sphere = coupled.problem == EvolveConfig::Coupled::growing_sphere;
  variant.accept_only(is_sphere ? std::set<std::string>{"mass", "law", "coupling"}
                                : std::set<std::string>{"mass", "law"});
  coupled.variant.mass = choice<Variant::Mass>(
      variant, "mass", {{"extrapolated", Variant::extrapolated}, {"reassembled", Variant::reassembled}},
      Variant::extrapolated);
  coupled.variant.law = choice<Variant::Law>(
      variant, "law", {{"regularised", Variant::regularised}, {"dynamic", Variant::dynamic}},
      Variant::regularised);
  coupled.coupling = choice<Problem::Coupling>(
      variant, "coupling",
      {{"additive", Problem::additive}, {"quotient", Problem::quotient}, {"none", Problem::none}},
      Problem::additive);
}

void read_growing_sphere(const JsonReader& parameters, const EvolveConfig& config,
                         EvolveConfig::Coupled& coupled) {
  require_unit_sphere(config, parameters.where() + ": problem growing_sphere");
  parameters.accept_only({"alpha", "beta"});
  coupled.parameters.alpha = parameters.number_or("alpha", 1);
  coupled.parameters.beta = parameters.number_or("beta", 1);
}

void read_tumour_growth(const JsonReader& parameters, EvolveConfig::Coupled& coupled) {
  parameters.accept_only({"alpha", "epsilon", "D", "a", "b", "gamma", "delta", "disturbance", "seed"});
  coupled.parameters = tumour_growth_parameters();
  coupled.parameters.alpha = parameters.number_or("alpha", coupled.parameters.alpha);
  coupled.parameters.beta = parameters.number_or("epsilon", coupled.parameters.beta);
  coupled.parameters.diffusion[1] = parameters.number_or("D", coupled.parameters.diffusion[1]);
  TumourGrowth::Kinetics& kinetics = coupled.kinetics;
  kinetics.a = parameters.number_or("a", kinetics.a);
  kinetics.b = parameters.number_or("b", kinetics.b);
  kinetics.gamma = parameters.number_or("gamma", kinetics.gamma);
  coupled.parameters.reaction_rate = kinetics.gamma;
  kinetics.delta = parameters.number_or("delta", kinetics.delta);
  coupled.disturbance = parameters.number_or("disturbance", coupled.disturbance);
  coupled.seed = parameters.integer_within("seed", coupled.seed, 0, 1000000);
}

EvolveConfig::Coupled coupled_problem(const JsonReader& reader, const EvolveConfig& config) {
  using Coupled = EvolveConfig::Coupled;
  Coupled coupled;
  coupled.problem = choice<Coupled::Problem>(
      reader, "problem",
      {{"growing_sphere", Coupled::growing_sphere}, {"tumour_growth", Coupled::tumour_growth}},
      Coupled::growing_sphere);
  static const json none = json::object();  // the reader keeps a reference
  const json& given = reader.has("parameters") ? reader.object("parameters") : none;
  const JsonReader parameters(given, reader.where() + ": parameters");
  if (coupled.problem == Coupled::growing_sphere)
    read_growing_sphere(parameters, config, coupled);
  else
    read_tumour_growth(parameters, coupled);
  if (reader.has("variant"))
    read_coupled_variant(JsonReader(reader.object("variant"), reader.where() + ": variant"), coupled);
  return coupled;
}

/// "limits": the bounds beyond which a run is singular.
void read_limits(const JsonReader& reader, EvolveConfig& config) {
  reader.accept_only({"curvature_size", "radius_ratio", "normal_length"});
  const auto read = [&](const char* key, double low, std::optional<double>& limit) {
    if (!reader.has(key)) return;
    limit = reader.number(key);
    if (!(*limit > low))
      throw InputError(format("%s: found %s = %g; expected a number greater than %g", reader.where().c_str(),
                              key, *limit, low));
  };
  read("curvature_size", 0, config.limits.curvature_size);
  read("radius_ratio", -1, config.limits.radius_ratio);
  read("normal_length", 1, config.limits.normal_length);
}

/// Empty when the key is not there.
std::string file_name(const JsonReader& output, const std::string& key) {
  if (!output.has(key)) return "";
  if (!output.text(key).empty()) return output.text(key);
  throw InputError(output.where() + ": found " + key + " = \"\"; expected the name of a file");
}

/// "every" and "times" of the output; they need "vtu".
SnapshotPlan snapshot_plan(const JsonReader& output) {
  SnapshotPlan plan;
  plan.pvd = file_name(output, "vtu");
  plan.every = output.integer_within("every", 0, 0, 100000000);
  if (output.has("times")) {
    for (const json& time : output.array("times")) {
      if (!time.is_number()) output.wrong_type("times", "an array of numbers", time);
      plan.times.push_back(time);
    }
  }
  if (plan.pvd.empty() && (output.has("every") || output.has("times"))) {
    throw InputError(output.where() +
                     ": every and times are about snapshots; expected the key vtu beside them");
  }
  return plan;
}

}  // namespace

EvolveConfig evolve_config(const json& description, const std::string& source) {
  const JsonReader reader(description, source);
  EvolveConfig config;
  config.flow = reader.text("flow");
  if (known_flows.count(config.flow) == 0) {
    throw InputError(source + ": found flow = \"" + config.flow + "\"; expected one of " +
                     listed(known_flows));
  }
  reader.accept_only({"flow", "surface", "mesh", "degree", "bdf", "tau", "steps", "start", "quadrature",
                      "variant", "output", "problem", "parameters", "adaptive", "limits"});
  if (reader.has("adaptive"))
    config.adaptive = adaptive_grid(reader, config.flow);
  else
    config.grid = time_grid(reader, config.flow);
  config.start_given = reader.has("start");
  if (reader.has("limits")) read_limits(JsonReader(reader.object("limits"), source + ": limits"), config);
  if (reader.has("output")) {
    const JsonReader output(reader.object("output"), source + ": output");
    output.accept_only({"nodal", "series", "vtu", "every", "times", "checkpoint"});
    config.nodal = file_name(output, "nodal");
    config.series = file_name(output, "series");
    config.checkpoint = file_name(output, "checkpoint");
    config.snapshots = snapshot_plan(output);
  }
  if (reader.has("surface")) config.surface = named_surface(reader.object("surface"));
  if (config.flow == "coupled_diffusion") {
    config.coupled = coupled_problem(reader, config);
  } else if (config.flow == "cahn_hilliard") {
    read_cahn_hilliard(reader, source, config);
  } else {
    for (const char* key : {"problem", "parameters"}) {
      if (reader.has(key))
        throw InputError(source + ": flow " + config.flow + " has none; expected no key " + key);
    }
    static const json none = json::object();
    const json& variant = reader.has("variant") ? reader.object("variant") : none;
    const std::string where = source + ": variant";
    if (config.flow == "mean_curvature")
      config.mean_curvature = mean_curvature_variant(variant, where);
    else if (config.flow == "willmore" || config.flow == "surface_diffusion")
      read_willmore_variant(variant, where, config);
    else if (reader.has("variant"))
      throw InputError(source + ": flow " + config.flow + " has no variants; expected no key variant");
  }
  std::optional<int> degree;
  if (reader.has("degree")) degree = reader.integer_within("degree", 0, 1, max_degree);
  const JsonReader mesh(reader.object("mesh"), source + ": mesh");
  if (mesh.has("file") && is_snapshot_of(mesh.text("file"), config.snapshots.pvd))
    throw InputError(
        source + ": output: found vtu = \"" + config.snapshots.pvd +
        "\", but the mesh is one of its snapshots, which a new run removes; expected another name");
  EvolveMesh initial = evolve_mesh(mesh, degree, config.surface);
  config.mesh = std::move(initial.start.mesh);
  config.mesh_remarks = std::move(initial.remarks);
  config.fields = std::move(initial.start.fields);
  config.node_numbers = std::move(initial.start.node_numbers);
  config.mesh_origin = std::move(initial.start.origin);
  const int k = config.mesh.degree;
  config.rule = reader.has("quadrature") ? quadrature(reader.object("quadrature"), source + ": quadrature")
                : config.flow == "bgn" && k == 1 ? vertex_quadrature()
                                                 : default_quadrature(k);
  move_near_origin(config);
  scale_defaults(reader, config);
  return config;
}

}  // namespace esfem
