// SPDX-License-Identifier: GPL-3.0-or-later
// Reaction and diffusion of species with kinetics of the user's own, on a surface at rest, with a prescribed
// motion, or driven by the species.
#include <algorithm>
#include <optional>
#include <set>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/error.hpp"
#include "solver/flows/reaction_diffusion.hpp"
#include "solver/problems/formula_data.hpp"

namespace esfem {
namespace {

using nlohmann::json;

struct Kinetics {
  std::vector<Formula> f;
  std::vector<double> diffusion;
  std::optional<Formula> g, alpha, beta;  ///< of a surface that the species drive

  int species() const { return static_cast<int>(f.size()); }
  bool depends_on_curvature() const {
    const auto has_H = [](const Formula& formula) { return formula.depends_on("H"); };
    return (g && has_H(*g)) || std::any_of(f.begin(), f.end(), has_H);
  }
};

std::vector<double> diffusion_in(const JsonReader& reader, std::size_t species) {
  std::vector<double> diffusion;
  for (const json& D : reader.array("diffusion")) {
    if (!D.is_number() || !(D.get<double>() >= 0))
      throw InputError(reader.where() + ": diffusion: found " + D.dump() +
                       "; expected numbers that are not negative");
    diffusion.push_back(D);
  }
  if (diffusion.size() != species)
    throw InputError(reader.where() +
                     format(": found %zu formulas f and %zu diffusion coefficients; expected "
                            "one each for every species",
                            species, diffusion.size()));
  return diffusion;
}

Kinetics kinetics_of(const EvolveConfig& config) {
  const JsonReader reader(config.formulas.at("kinetics"), config.source + ": kinetics");
  reader.accept_only({"f", "diffusion", "g", "alpha", "beta"});
  const int species = static_cast<int>(reader.array("f").size());
  const FormulaNames names = names_of_kinetics(species, names_of(config));
  FormulaNames names_with_H = names;
  // Where H has a meaning in this file already it keeps it.
  const bool is_own_name = names.constants.count("H") + names.definitions.count("H") > 0;
  if (reader.has("g") && !is_own_name) names_with_H.variables.push_back("H");
  Kinetics kinetics;
  kinetics.f = formulas_in(reader, "f", names_with_H);
  kinetics.diffusion = diffusion_in(reader, kinetics.f.size());
  if (reader.has("g")) kinetics.g = formula_in(reader, "g", names_with_H);
  if (reader.has("alpha")) kinetics.alpha = formula_in(reader, "alpha", names);
  if (reader.has("beta")) kinetics.beta = formula_in(reader, "beta", names);
  return kinetics;
}

std::vector<std::vector<std::string>> starts_of_kinetics(const EvolveConfig& config) {
  const Kinetics kinetics = kinetics_of(config);
  std::vector<std::vector<std::string>> starts = {concentration_names(kinetics.species())};
  if (kinetics.g) {
    starts.push_back(starts[0]);
    starts[1].push_back("v");
  }
  return starts;
}

/// Refuses what has no effect without g, or with the dynamic law.
void refuse_useless_keys(const EvolveConfig& config, const Kinetics& kinetics, const std::string& source) {
  // Formulas may name alpha and beta for something of their own.
  const std::set<std::string> names = names_in_formulas(config);
  const auto refuse_number = [&](const char* key, const std::string& why) {
    if (names.count(key) == 0) refuse_given(config.parameters, {key}, source + ": parameters", why);
  };
  if (config.variant.is("law", "dynamic")) refuse_number("beta", "with the dynamic law");
  if (kinetics.g) return;
  for (const char* key : {"alpha", "beta"}) refuse_number(key, "without g of kinetics");
  refuse_given(config.variant, {"law"}, source + ": variant", "without g of kinetics");
  if (config.limits.radius_ratio)
    throw InputError(
        source +
        ": limits: found radius_ratio, which has no effect without g of kinetics; expected no key "
        "limits");
}

void check_kinetics(const EvolveConfig& config, const std::string& source) {
  const Kinetics kinetics = kinetics_of(config);
  exact_values(config, concentration_names(kinetics.species()));
  if ((kinetics.alpha || kinetics.beta) && !kinetics.g)
    throw InputError(source + ": kinetics: found " + (kinetics.alpha ? "alpha" : "beta") +
                     ", of the law of a surface that g drives, without g; expected g, too");
  if (kinetics.beta && config.variant.is("law", "dynamic"))
    throw InputError(source + ": kinetics: found beta, which the dynamic law has not; expected no key beta");
  const bool moves = bool(prescribed_velocity(config, nullptr));
  if (moves && kinetics.g)
    throw InputError(source +
                     ": found a velocity, and g of kinetics, which drives the surface; expected one of "
                     "them");
  if (moves && config.adaptive)
    throw InputError(source + ": a prescribed velocity takes equal steps; expected tau and steps");
  refuse_useless_keys(config, kinetics, source);
}

Field initial_concentrations(const EvolveConfig& config, int species) {
  if (config.history.is_object()) return Field::Zero(config.mesh.nodes.rows(), species);  // is replaced
  const std::vector<std::string> names = concentration_names(species);
  for (const std::string& name : names)
    if (!find(config.fields, name))
      throw InputError(config.source + ": " + name + " has no initial values; expected \"initial\": {\"" +
                       name + "\": a formula, ..}, or a file with nodal values " + name);
  return start_values(config, names);
}

/// The nodal values of the file; without them the surface is at rest at the start.
Field initial_velocity(const EvolveConfig& config, int species) {
  std::vector<std::string> names = concentration_names(species);
  names.push_back("v");
  const Field u_v = start_values(config, names);
  if (u_v.size() == 0) return Field::Zero(config.mesh.nodes.rows(), 3);
  return u_v.rightCols(3);
}

void run_driven(const Run& run, const Kinetics& kinetics, Field u) {
  const EvolveConfig& config = run.config;
  const Field& x = config.mesh.nodes;
  CoupledDiffusionParameters parameters;
  parameters.alpha = config.parameters.number("alpha");
  parameters.beta = config.parameters.number("beta");
  parameters.diffusion = kinetics.diffusion;
  std::vector<Formula> f_and_g = kinetics.f;
  f_and_g.push_back(*kinetics.g);
  VariableLaw law;
  if (kinetics.alpha) law.alpha = formula_nodal_function(*kinetics.alpha);
  if (kinetics.beta) law.beta = formula_nodal_function(*kinetics.beta);
  const CoupledDiffusionVariant variant = {CoupledDiffusionVariant::extrapolated,
                                           config.variant.is("law", "regularised")
                                               ? CoupledDiffusionVariant::regularised
                                               : CoupledDiffusionVariant::dynamic};
  const RegularityLimits limits = limits_of_own_problem(run, u);
  run_flow(
      CoupledKinetics(run.space, formula_kinetics(f_and_g), parameters, variant, limits, law,
                      kinetics.depends_on_curvature()),
      run,
      coupled_diffusion_state(run.space, 0, x, initial_velocity(config, kinetics.species()), std::move(u)));
}

void run_prescribed(const Run& run, const Kinetics& kinetics, Field u) {
  const EvolveConfig& config = run.config;
  const auto exact_u = exact_values(config, concentration_names(static_cast<int>(u.cols())));
  const Velocity velocity = prescribed_velocity(config, &run.space);
  const UniformSteps steps = steps_of(run, exact_u != nullptr);
  const NodalMotion motion = prescribed_motion(config, run.space, steps);
  ReactionDiffusion flow(run.space, formula_kinetics(kinetics.f), kinetics.diffusion, motion, velocity,
                         limits_of_own_problem(run, u));
  std::function<ReactionDiffusionState(double)> exact_state;
  if (exact_u) exact_state = [&](double t) { return flow.state(t, exact_u(motion(t), t)); };
  run_flow(flow, run, flow.state(steps.time(0), std::move(u)), exact_state);
}

void run_kinetics(const Run& run) {
  const Kinetics kinetics = kinetics_of(run.config);
  Field u = initial_concentrations(run.config, kinetics.species());
  if (kinetics.g)
    run_driven(run, kinetics, std::move(u));
  else
    run_prescribed(run, kinetics, std::move(u));
}

FormulaKey kinetics_key() {
  const json formula = formula_schema();
  const json not_negative = {{"type", "number"}, {"minimum", 0}};
  const json properties = {{"f", {{"type", "array"}, {"items", formula}, {"minItems", 1}}},
                           {"diffusion", {{"type", "array"}, {"items", not_negative}, {"minItems", 1}}},
                           {"g", formula},
                           {"alpha", formula},
                           {"beta", formula}};
  return {
      "kinetics",
      "{\"f\": [\"u2 - u1\", \"u1^2 - u2\"], \"diffusion\": [1, 10]}",
      "f_l and D_l of each species; with \"g\": \"u1\" they drive the surface by (2.8), else see velocity; "
      "g and f may then use H, and \"alpha\", \"beta\" be formulas, too",
      {{"type", "object"},
       {"properties", properties},
       {"required", {"f", "diffusion"}},
       {"additionalProperties", false}},
      true};
}

}  // namespace

std::vector<Entry> kinetics_entries() {
  Entry entry;
  entry.flow = "coupled_diffusion";
  entry.problem = "kinetics";
  entry.help =
      "species with kinetics of your own, on a surface that they drive, that moves as given, or at rest";
  entry.fields = "u, or u1, u2, ..";
  entry.variant = {word("law", {"regularised", "dynamic"}, "of the velocity: (2.8), or Kovács, Lubich 2018")};
  entry.parameters = {{Key::positive, "alpha", 1, "of (2.8)", 2}, {Key::not_negative, "beta", 0, "of (2.8)"}};
  entry.takes_own_parameters = true;
  entry.formulas = {kinetics_key(), velocity_key(), initial_key({"u1", "u2"})};
  entry.run = run_kinetics;
  entry.check = check_kinetics;
  entry.limits = {"radius_ratio"};
  entry.own_starts = starts_of_kinetics;
  entry.starts_beside_surface = true;
  entry.can_shrink_to_nothing = true;
  entry.cure = smaller_steps_or_even_elements;
  return {entry};
}

}  // namespace esfem
