// SPDX-License-Identifier: GPL-3.0-or-later
// Reaction and diffusion of species with kinetics of the user's own, on a surface at rest, with a prescribed
// motion, or driven by the species.
#include <optional>

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
  std::optional<Formula> g;
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
  reader.accept_only({"f", "diffusion", "g"});
  const int species = static_cast<int>(reader.array("f").size());
  const FormulaNames names = names_of_kinetics(species, names_of(config));
  Kinetics kinetics;
  kinetics.f = formulas_in(reader, "f", names);
  kinetics.diffusion = diffusion_in(reader, kinetics.f.size());
  if (reader.has("g")) kinetics.g = formula_in(reader, "g", names);
  return kinetics;
}

void check_kinetics(const EvolveConfig& config, const std::string& source) {
  const Kinetics kinetics = kinetics_of(config);
  exact_values(config, concentration_names(static_cast<int>(kinetics.f.size())));
  const bool moves = bool(prescribed_velocity(config, nullptr));
  if (moves && kinetics.g)
    throw InputError(source +
                     ": found a velocity, and g of kinetics, which drives the surface; expected one of "
                     "them");
  if (moves && config.adaptive)
    throw InputError(source + ": a prescribed velocity takes equal steps; expected tau and steps");
}

Field initial_concentrations(const EvolveConfig& config, int species) {
  Field u(config.mesh.nodes.rows(), species);
  for (const std::string& name : concentration_names(species))
    if (config.initial.count(name) == 0)
      throw InputError(config.source + ": " + name + " has no initial values; expected \"initial\": {\"" +
                       name + "\": a formula, ..}");
  if (config.initial.size() != std::size_t(species))
    throw InputError(config.source + format(": initial values of %zu concentrations, kinetics of %d",
                                            config.initial.size(), species));
  const std::vector<std::string> names = concentration_names(species);
  for (int l = 0; l < species; ++l) u.col(l) = *find(config.fields, names[l]);
  return u;
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
  const CoupledDiffusionVariant variant = {CoupledDiffusionVariant::extrapolated,
                                           config.variant.is("law", "regularised")
                                               ? CoupledDiffusionVariant::regularised
                                               : CoupledDiffusionVariant::dynamic};
  run_flow(CoupledKinetics(run.space, formula_kinetics(f_and_g), parameters, variant, limits_of(run)), run,
           coupled_diffusion_state(run.space, 0, x, Field::Zero(x.rows(), 3), std::move(u)));
}

void run_prescribed(const Run& run, const Kinetics& kinetics, Field u) {
  const EvolveConfig& config = run.config;
  const auto exact_u = exact_values(config, concentration_names(static_cast<int>(u.cols())));
  const Velocity velocity = prescribed_velocity(config, &run.space);
  const UniformSteps steps = steps_of(run, exact_u != nullptr);
  const NodalMotion motion = prescribed_motion(config, run.space, steps);
  ReactionDiffusion flow(run.space, formula_kinetics(kinetics.f), kinetics.diffusion, motion, velocity);
  std::function<ReactionDiffusionState(double)> exact_state;
  if (exact_u) exact_state = [&](double t) { return flow.state(t, exact_u(motion(t), t)); };
  run_flow(flow, run, flow.state(0, std::move(u)), exact_state);
}

void run_kinetics(const Run& run) {
  const Kinetics kinetics = kinetics_of(run.config);
  Field u = initial_concentrations(run.config, static_cast<int>(kinetics.f.size()));
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
                           {"g", formula}};
  return {
      "kinetics",
      "{\"f\": [\"u2 - u1\", \"u1^2 - u2\"], \"diffusion\": [1, 10]}",
      "f_l and D_l of each species; with \"g\": \"u1\" they drive the surface by (2.8), else see velocity",
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
  entry.can_shrink_to_nothing = true;
  entry.cure = smaller_steps_or_even_elements;
  return {entry};
}

}  // namespace esfem
