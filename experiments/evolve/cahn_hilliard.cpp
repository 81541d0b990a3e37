// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"
#include "solver/flows/phase_separation.hpp"
#include "solver/problems/disturbed_mixture.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"

namespace esfem {
namespace {

void run_ellipsoid(const Run& run) {
  const EvolveConfig& config = run.config;
  const UniformSteps steps = steps_of(run, true);
  const StartValues values =
      config.variant.is("initial", "ritz") ? StartValues::ritz : StartValues::interpolation;
  const ManufacturedCahnHilliard exact(EvolvingEllipsoid(), config.parameters.number("epsilon"));
  MovingNodes nodes(exact.ellipsoid().velocity(), config.mesh.nodes,
                    steps.tau / steps.start.substeps_per_step);
  const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
  const auto exact_state = [&](double t) {
    return exact_cahn_hilliard_state(run.space, exact, nodes.at(t), t, values);
  };
  const CahnHilliardState start = exact_state(0);
  Field theta;
  if (config.variant.truth("theta"))
    theta = cahn_hilliard_theta(run.space, DoubleWell(), exact.epsilon(), start);
  run_flow(CahnHilliard(run.space, exact.problem(), motion, exact.epsilon(), theta, {}, {},
                        limits_of_own_problem(run, start.u)),
           run, start, exact_state);
}

CahnHilliardState start_of_mixture(const Run& run, double epsilon) {
  const EvolveConfig& config = run.config;
  const Field& x = config.mesh.nodes;
  const Field u = start_values(config, {"u"}), u_w = start_values(config, {"u", "w"});
  if (u_w.size() > 0) return cahn_hilliard_state(run.space, 0, x, u, u_w.col(1));
  if (u.size() > 0) return cahn_hilliard_start(run.space, DoubleWell(), epsilon, 0, x, u);
  return disturbed_mixture(run.space, x, epsilon, config.parameters.number("mean"),
                           config.parameters.number("disturbance"), config.parameters.integer("seed"),
                           config.disturbance_origin);
}

void run_phase_separation(const Run& run) {
  const double epsilon = run.config.parameters.number("epsilon");
  const CahnHilliardState start = start_of_mixture(run, epsilon);
  PhaseSeparation flow(run.space, run.config.mesh.nodes, epsilon);
  run_flow(flow, run, start);
  if (flow.replaced_steps() > 0)
    warn(format("steps in which the energy would have risen, replaced by smaller backward Euler steps: %d",
                flow.replaced_steps()));
}

Entry cahn_hilliard_entry(const std::string& problem) {
  Entry entry;
  entry.flow = "cahn_hilliard";
  entry.problem = problem;
  entry.fields = "u, w";
  entry.time_power = 3;
  entry.energy = "energy";
  entry.has_given_motion = true;
  entry.cure = smaller_steps_or_even_elements;
  return entry;
}

}  // namespace

std::vector<Entry> cahn_hilliard_entries() {
  Entry ellipsoid = cahn_hilliard_entry("ellipsoid");
  ellipsoid.help = "bk22 (8.3): exp(-6t) x1 x2 on an ellipsoid that starts as the unit sphere";
  ellipsoid.variant = {
      {Key::truth, "theta", false, "the correction (3.13)"},
      word("initial", {"interpolation", "ritz"}, "starting values: nodal ones, or Ritz maps")};
  ellipsoid.parameters = {{Key::positive, "epsilon", 0.5, "width of the interface"}};
  ellipsoid.run = run_ellipsoid;
  ellipsoid.takes_adaptive_steps = false;
  ellipsoid.moves_as_given = true;
  ellipsoid.check = [](const EvolveConfig& config, const std::string& source) {
    require_unit_sphere(config, source + ": problem ellipsoid");
  };

  Entry mixture = cahn_hilliard_entry("phase_separation");
  mixture.help =
      "separation of a disturbed mixture on any stationary surface; implicit, for steps of any size: a step "
      "in which the energy would rise is replaced by smaller backward Euler steps";
  mixture.parameters = {{Key::positive, "epsilon", 0.5, "width of the interface", 1},
                        {Key::number, "mean", 0, "of u over the surface"},
                        {Key::number, "disturbance", 0.1, "of u"},
                        {Key::seed, "seed", 1, "of the disturbance"}};
  mixture.formulas = {initial_key({"u"})};
  mixture.check = [](const EvolveConfig& config, const std::string& source) {
    if (config.formulas.contains("initial"))
      refuse_given(config.parameters, {"mean", "disturbance", "seed"}, source + ": parameters",
                   "with initial values");
  };
  mixture.run = run_phase_separation;
  mixture.starts = {{"u"}, {"u", "w"}};
  mixture.starts_beside_surface = true;
  return {ellipsoid, mixture};
}

}  // namespace esfem
