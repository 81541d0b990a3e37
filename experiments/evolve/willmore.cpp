// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/willmore.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

using nlohmann::json;
using Variant = WillmoreFlow::Variant;

Variant::Projection projection_of(const Settings& asked) {
  if (asked.is("project", "coefficients")) return Variant::in_coefficients;
  return asked.truth("project") ? Variant::after_steps : Variant::none;
}

/// What is given, or else the default, as far as the steps admit it (Variant::relaxation).
double relaxation_of(const Run& run, double otherwise) {
  const EvolveConfig& config = run.config;
  if (config.variant.has("relaxation")) return config.variant.number("relaxation");
  const double rate = otherwise * std::pow(4 * pi / run.space.area(config.mesh.nodes), 2),
               tau = config.adaptive ? config.adaptive->largest_step : config.grid.tau;
  return tau > 0 ? std::min(rate, 0.2 / tau) : rate;
}

Variant willmore_variant(const Run& run, const WillmoreProblem& problem, const WillmoreDefaults& defaults) {
  const Settings& asked = run.config.variant;
  Variant variant;
  variant.law = problem.law;
  variant.prescribed = problem.prescribed;
  variant.F = asked.is("F", "extrapolated") ? Variant::extrapolated : Variant::implicit;
  variant.projection = projection_of(asked);
  variant.relaxation = relaxation_of(run, defaults.relaxation);
  variant.reinitialise = asked.number_or("reinitialise", 0);
  if (asked.is("tangential", "minimal_deformation"))
    variant.tangential = MeanCurvatureFlow::Variant::minimal_deformation;
  return variant;
}

/// theta needs exact data, and is on where there are such.
bool has_theta(const EvolveConfig& config) {
  return config.variant.has("theta") ? config.variant.truth("theta") : config.surface.has_value();
}

void check_theta(const EvolveConfig& config, const std::string& source) {
  if (has_theta(config) && !config.surface)
    throw InputError(
        source + ": variant: theta needs exact initial data; expected a \"surface\", or \"theta\": false");
}

WillmoreStart willmore_start(const Run& run, const WillmoreProblem& problem) {
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  const auto& [law, prescribed] = problem;
  const Field nu_H = start_values(config, {"nu", "H"}), all = start_values(config, {"nu", "H", "V", "z"});
  if (nu_H.size() > 0) {
    Field u(nu_H.rows(), 4);
    u << nu_H.col(3), nu_H.leftCols(3);
    const Field w = all.size() > 0 ? Field(all.rightCols(4)) : Field();
    return willmore_start_from(run.space, x0, std::move(u), w, law, prescribed);
  }
  return config.surface
             ? willmore_start_on(run.space, *config.surface, x0, law, has_theta(config), prescribed)
             : discrete_willmore_start(run.space, x0, law, prescribed);
}

Key theta_key(const json& otherwise) {
  const std::string help = "the correction (3.7)";
  return {Key::truth, "theta", otherwise,
          help + (otherwise.is_null() ? "; default: true with a \"surface\", false without" : "")};
}

Key relaxation_key(double otherwise) {
  const std::string help = "rate (1/time) of relaxation to the geometry of the surface; at most 0.2/tau";
  if (otherwise == 0) return {Key::not_negative, "relaxation", 0, help};
  return {Key::not_negative, "relaxation", nullptr,
          format("%s; default: %g (4 pi/area)², or 0.2/tau", help.c_str(), otherwise)};
}

}  // namespace

Entry willmore_entry(const std::function<WillmoreProblem(const Run&)>& problem, bool starts_from_V,
                     const WillmoreDefaults& defaults) {
  Entry entry;
  entry.fields = "nu, H, V, z";
  entry.variant = {
      word("F", {"extrapolated", "implicit"}, "F(x, u) w of (3.5a)"),
      {Key::truth_or_word,
       "project",
       defaults.project,
       "nu_h to unit length, z_h to the tangent plane, in the nodes: after each step, or in f, g and F alone",
       0,
       {"coefficients"}},
      theta_key(defaults.theta),
      relaxation_key(defaults.relaxation),
      tangential_key(),
      reinitialise_key()};
  entry.run = [problem, defaults](const Run& run) {
    const WillmoreProblem chosen = problem(run);
    WillmoreStart start = willmore_start(run, chosen);
    WillmoreFlow flow(run.space, willmore_variant(run, chosen, defaults), start.theta, limits_of(run));
    flow.reinitialise(start.state);
    run_flow(flow, run, start.state);
  };
  entry.check = check_theta;
  entry.limits = {"curvature_size", "normal_length", "radius_ratio"};
  entry.time_power = 4;
  entry.starts = {{"nu", "H"}};
  if (starts_from_V) entry.starts.push_back({"nu", "H", "V", "z"});
  entry.evolves_curvature = entry.records_kappa_energy = true;
  entry.curvature_cure =
      "try \"variant\": {\"relaxation\": ..} or {\"reinitialise\": 0.05}, or " + resolving_mesh;
  entry.cure = [](const EvolveConfig& config) {
    return "try " + smaller_steps(config) + ", \"variant\": {\"relaxation\": ..}, or " + even_elements;
  };
  return entry;
}

std::vector<Entry> willmore_entries() {
  Entry willmore = willmore_entry([](const Run&) { return WillmoreProblem{willmore_law()}; }),
        surface_diffusion =
            willmore_entry([](const Run&) { return WillmoreProblem{surface_diffusion_law()}; });
  willmore.flow = "willmore";
  willmore.energy = "willmore_energy";
  willmore.help = "Willmore flow by kll21 (3.4)-(3.5): V = Delta H + Q, which decreases 1/2 int H²";
  surface_diffusion.flow = "surface_diffusion";
  surface_diffusion.energy = "area";
  surface_diffusion.help =
      "surface diffusion by kll21 (3.4)-(3.5) with Q = 0: V = Delta H, which keeps the volume";
  return {willmore, surface_diffusion};
}

}  // namespace esfem
