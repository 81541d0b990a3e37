// SPDX-License-Identifier: GPL-3.0-or-later
// The Cahn-Hilliard equation with a potential, a motion and data of the user's own.
#include "experiments/evolve/mixture.hpp"

#include <optional>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/error.hpp"

namespace esfem {

FormulaMixture mixture_of(const EvolveConfig& config) {
  const JsonReader reader(config.formulas, config.source);
  FormulaNames names = names_in_space_time(names_of(config));
  std::vector<Formula> source;
  if (reader.has("source")) source.push_back(formula_in(reader, "source", names));
  names.variables.push_back("u");
  const std::string where = config.source + ": potential";
  return {
      reader.has("potential") ? formula_in(reader, "potential", names) : Formula("(u^2-1)^2/4", names, where),
      source};
}

namespace {

using nlohmann::json;

Mobility mobility_of(const EvolveConfig& config) {
  if (!config.formulas.contains("mobility")) return {};
  FormulaNames names = names_in_space_time(names_of(config));
  names.variables.push_back("u");
  return formula_mobility(formula_in(JsonReader(config.formulas, config.source), "mobility", names));
}

void check_mixture(const EvolveConfig& config, const std::string& source) {
  mixture_of(config);
  mobility_of(config);
  exact_values(config, {"u", "w"});
  prescribed_velocity(config, nullptr, "tangential");
  if (config.formulas.contains("tangential") && !config.formulas.at("tangential").is_array())
    throw InputError(
        source +
        ": tangential: found a velocity along the normals, which moves nothing along the surface; "
        "expected three formulas in [..]");
  if (prescribed_velocity(config, nullptr) && config.adaptive)
    throw InputError(source + ": a prescribed velocity takes equal steps; expected tau and steps");
}

void run_mixture(const Run& run) {
  const EvolveConfig& config = run.config;
  const double epsilon = config.parameters.number("epsilon");
  const FormulaMixture mixture = mixture_of(config);
  const auto exact = exact_values(config, {"u", "w"});
  const UniformSteps steps = steps_of(run, exact != nullptr);
  const NodalMotion motion = prescribed_motion(config, run.space, steps);
  std::function<CahnHilliardState(double)> exact_state;
  if (exact)
    exact_state = [&](double t) {
      const Field x = motion(t), u_w = exact(x, t);
      return cahn_hilliard_state(run.space, t, x, u_w.col(0), u_w.col(1));
    };
  const Field& x = config.mesh.nodes;
  const double t0 = steps.time(0);
  Field u = start_values(config, {"u"});
  const Field u_w = start_values(config, {"u", "w"});
  if (config.history.is_object()) u.setZero(x.rows(), 1);  // is replaced, as is theta
  if (u.size() == 0)
    throw InputError(config.source +
                     ": u has no initial values; expected \"initial\": {\"u\": a formula}, "
                     "or a file with nodal values u");
  const CahnHilliardState start = u_w.size() > 0
                                      ? cahn_hilliard_state(run.space, t0, x, u_w.col(0), u_w.col(1))
                                      : cahn_hilliard_start(run.space, mixture, epsilon, t0, x, u);
  if (config.variant.truth("theta") && u_w.size() == 0 && !config.history.is_object())
    throw InputError(
        config.source +
        ": variant: theta is 0, since w comes from the second equation; expected initial values of "
        "w, too, or no theta");
  Field theta;
  if (config.variant.truth("theta")) theta = cahn_hilliard_theta(run.space, mixture, epsilon, start);
  const double well = config.formulas.contains("potential") ? 0 : 1;  // where the double well is lowest
  run_flow(CahnHilliard(run.space, mixture, motion, epsilon, theta,
                        prescribed_velocity(config, &run.space, "tangential"), mobility_of(config),
                        limits_of_own_problem(run, start.u, well)),
           run, start, exact_state);
}

}  // namespace

std::vector<Entry> mixture_entries() {
  const json formula = formula_schema();
  Entry entry;
  entry.flow = "cahn_hilliard";
  entry.problem = "mixture";
  entry.help =
      "bk22 (8.3) with potential, motion, source and initial values of your own; the potential "
      "is explicit: for the double well steps below 0.4 epsilon³";
  entry.fields = "u, w";
  entry.variant = {{Key::truth, "theta", false, "the correction (3.13)"}};
  entry.parameters = {{Key::positive, "epsilon", 0.5, "width of the interface", 1}};
  entry.takes_own_parameters = true;
  FormulaKey tangential = velocity_key();
  tangential.name = "tangential";
  tangential.example = "[\"0\", \"z*t\", \"-y*t\"]";
  tangential.schema = tangential.schema.at("anyOf").at(0);
  tangential.help = "the part of the velocity that the nodes have, but not the material; default: none";
  entry.formulas = {
      {"potential", "\"(u^2-1)^2/4\"", "F(u), double-well by default", formula},
      {"mobility", "\"max(1 - u^2, 0)\"",
       "m of d•u + u div v - div(m grad w), of x, y, z, t, u, not negative; 1 by default", formula},
      velocity_key(),
      tangential,
      {"source", "\"x*y\"", "b of bk22 (9.1), of x, y, z, t", formula},
      initial_key({"u"})};
  entry.run = run_mixture;
  entry.check = check_mixture;
  entry.time_power = 3;
  entry.has_given_motion = true;
  entry.energy = "energy";
  entry.starts = {{"u"}, {"u", "w"}};
  entry.starts_beside_surface = true;
  entry.cure = smaller_steps_or_even_elements;
  return {entry};
}

}  // namespace esfem
