// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/coupled_diffusion.hpp"

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/problems/growing_sphere.hpp"
#include "solver/problems/tumour_growth.hpp"

namespace esfem {
namespace {

CoupledDiffusionVariant coupled_variant(const Settings& asked) {
  using Variant = CoupledDiffusionVariant;
  return {asked.is("mass", "extrapolated") ? Variant::extrapolated : Variant::reassembled,
          asked.is("law", "regularised") ? Variant::regularised : Variant::dynamic};
}

GrowingSphereProblem::Coupling coupling_of(const Settings& asked) {
  if (asked.is("coupling", "quotient")) return GrowingSphereProblem::quotient;
  return asked.is("coupling", "none") ? GrowingSphereProblem::none : GrowingSphereProblem::additive;
}

void run_growing_sphere(const Run& run) {
  const Settings& asked = run.config.parameters;
  CoupledDiffusionParameters parameters;
  parameters.alpha = asked.number("alpha");
  parameters.beta = asked.number("beta");
  const CoupledDiffusionVariant variant = coupled_variant(run.config.variant);
  const ExactEvolution exact = growing_sphere();
  const auto exact_state = [&](double t) {
    return exact_growing_sphere_state(run.space, exact, run.config.mesh.nodes, t);
  };
  const CoupledDiffusionState initial = exact_state(0);
  const GrowingSphereProblem problem(parameters, variant.law, coupling_of(run.config.variant));
  run_flow(CoupledDiffusion(run.space, problem, parameters, variant,
                            limits_of(run, initial.u.cwiseAbs().maxCoeff())),
           run, initial, exact_state);
}

CoupledDiffusionState start_of_tumour(const Run& run, const TumourGrowth::Kinetics& kinetics) {
  const EvolveConfig& config = run.config;
  const Field& x = config.mesh.nodes;
  const Field u = start_values(config, {"u1", "u2"}), u_v = start_values(config, {"u1", "u2", "v"});
  if (u.size() > 0)
    return coupled_diffusion_state(
        run.space, 0, x, u_v.size() > 0 ? Field(u_v.rightCols(3)) : Field(Field::Zero(x.rows(), 3)), u);
  return tumour_growth_state(run.space, x, kinetics, config.parameters.number("disturbance"),
                             config.parameters.integer("seed"), config.disturbance_origin);
}

void run_tumour_growth(const Run& run) {
  const Settings& asked = run.config.parameters;
  TumourGrowth::Kinetics kinetics;
  kinetics.a = asked.number("a");
  kinetics.b = asked.number("b");
  kinetics.gamma = asked.number("gamma");
  kinetics.delta = asked.number("delta");
  CoupledDiffusionParameters parameters = tumour_growth_parameters();
  parameters.alpha = asked.number("alpha");
  parameters.beta = asked.number("epsilon");
  parameters.diffusion[1] = asked.number("D");
  parameters.reaction_rate = kinetics.gamma;
  const CoupledDiffusionState initial = start_of_tumour(run, kinetics);
  // u may grow from zero to its steady state, which is not a blow-up.
  const double size_of_u =
      std::max(initial.u.cwiseAbs().maxCoeff(), TumourGrowth::steady_state(kinetics).cwiseAbs().maxCoeff());
  run_flow(CoupledDiffusion(run.space, TumourGrowth(kinetics), parameters,
                            coupled_variant(run.config.variant), limits_of(run, size_of_u)),
           run, initial);
}

Entry coupled_entry(const std::string& problem) {
  Entry entry;
  entry.flow = "coupled_diffusion";
  entry.problem = problem;
  entry.variant = {
      word("mass", {"extrapolated", "reassembled"}, "(2.19), or (7.2), which loses an order in time"),
      word("law", {"regularised", "dynamic"}, "of the velocity: (2.8), or Kovács, Lubich 2018")};
  entry.limits = {"radius_ratio"};
  entry.can_shrink_to_nothing = true;
  entry.cure = smaller_steps_or_even_elements;
  return entry;
}

}  // namespace

std::vector<Entry> coupled_diffusion_entries() {
  Entry sphere = coupled_entry("growing_sphere");
  sphere.help = "nick18 (2.19)-(2.21), 7.3: a unit sphere whose growth is driven by diffusion on it";
  sphere.fields = "u";
  sphere.variant.push_back(word("coupling", {"additive", "quotient", "none"}, "of g to u"));
  sphere.parameters = {{Key::number, "alpha", 1, "of (2.8)"}, {Key::number, "beta", 1, "of (2.8)"}};
  sphere.run = run_growing_sphere;
  sphere.exact_solution = [](const EvolveConfig&) -> std::optional<ExactEvolution> {
    return growing_sphere();
  };
  sphere.check = [](const EvolveConfig& config, const std::string& source) {
    require_unit_sphere(config, source + ": parameters: problem growing_sphere");
  };

  const TumourGrowth::Kinetics kinetics;
  const CoupledDiffusionParameters parameters = tumour_growth_parameters();
  Entry tumour = coupled_entry("tumour_growth");
  tumour.help = "activator and substrate (Schnakenberg) on any surface, from a disturbed steady state";
  tumour.fields = "u1, u2";
  tumour.parameters = {
      {Key::number, "alpha", parameters.alpha, "of (2.8)", 2},
      {Key::number, "epsilon", parameters.beta, "of the curvature, beta of (2.8)"},
      {Key::number, "D", parameters.diffusion[1], "diffusion of the substrate; the activator's is 1"},
      {Key::number, "a", kinetics.a, "of the kinetics"},
      {Key::number, "b", kinetics.b, "of the kinetics"},
      {Key::number, "gamma", kinetics.gamma, "rate of the kinetics", -2},
      {Key::number, "delta", kinetics.delta, "of growth by the activator", -1},
      {Key::number, "disturbance", 0.01, "of the steady state"},
      {Key::seed, "seed", 1, "of the disturbance"}};
  tumour.formulas = {initial_key({"u1", "u2"})};
  tumour.check = [](const EvolveConfig& config, const std::string& source) {
    if (config.variant.is("law", "dynamic"))
      refuse_given(config.parameters, {"epsilon"}, source + ": parameters", "with the dynamic law");
    if (config.formulas.contains("initial"))
      refuse_given(config.parameters, {"disturbance", "seed"}, source + ": parameters",
                   "with initial values");
  };
  tumour.run = run_tumour_growth;
  tumour.starts = {{"u1", "u2"}, {"u1", "u2", "v"}};
  tumour.starts_beside_surface = true;
  return {sphere, tumour};
}

}  // namespace esfem
