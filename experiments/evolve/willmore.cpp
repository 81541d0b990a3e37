// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/willmore.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/assembly/size.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/extrapolation.hpp"

namespace esfem {
namespace {

using nlohmann::json;
using Variant = WillmoreFlow::Variant;

Variant::Projection projection_of(const Settings& asked) {
  if (asked.is("project", "coefficients")) return Variant::in_coefficients;
  return asked.truth("project") ? Variant::after_steps : Variant::none;
}

/// 100 in units of the surface's time scale, or the largest rate that the steps admit (Variant::relaxation).
double suitable_relaxation(const EvolveConfig& config, double area) {
  const double rate = 100 * std::pow(4 * pi / area, 2),
               tau = config.adaptive ? config.adaptive->largest_step : config.grid.tau;
  return tau > 0 ? std::min(rate, 0.2 / tau) : rate;
}

double relaxation_of(const Run& run) {
  const EvolveConfig& config = run.config;
  return config.variant.has("relaxation") ? config.variant.number("relaxation")
                                          : suitable_relaxation(config, run.space.area(config.mesh.nodes));
}

/// A key of "variant" for advice, with two digits of its value; "" where the run has it already.
std::string relaxation_to_try(const EvolveConfig& config) {
  const double rate = suitable_relaxation(config, area_of_triangles(config.mesh));
  if (!config.variant.has("relaxation") || config.variant.number("relaxation") > rate / 2) return "";
  return format("\"relaxation\": %g", std::stod(format("%.1e", rate)));
}

std::string curvature_cure(const EvolveConfig& config) {
  const std::string relaxation = relaxation_to_try(config),
                    or_finer = "{\"reinitialise\": 0.05}, or " + resolving_mesh;
  return "try \"variant\": " + (relaxation.empty() ? "" : "{" + relaxation + "} or ") + or_finer;
}

std::string willmore_cure(const EvolveConfig& config) {
  const std::string relaxation = relaxation_to_try(config);
  return "try " + smaller_steps(config) + (relaxation.empty() ? "" : ", \"variant\": {" + relaxation + "}") +
         ", or " + even_elements;
}

Variant willmore_variant(const Run& run, const WillmoreProblem& problem) {
  const Settings& asked = run.config.variant;
  Variant variant;
  variant.law = problem.law;
  variant.prescribed = problem.prescribed;
  variant.F = asked.is("F", "extrapolated") ? Variant::extrapolated : Variant::implicit;
  variant.projection = projection_of(asked);
  variant.relaxation = relaxation_of(run);
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

Key relaxation_key(const json& otherwise) {
  const std::string help = "rate (1/time) of relaxation to the geometry of the surface, for long runs; ";
  return {Key::not_negative, "relaxation", otherwise,
          help + (otherwise.is_null() ? "default: 100 (4 pi/area)², or 0.2/tau, the smaller one"
                                      : "such as 100 (4 pi/area)², at most 0.2/tau")};
}

}  // namespace

void look_at_steps(const Run& run, const WillmoreFlow::State& state) {
  const EvolveConfig& config = run.config;
  const int n = run.recorder.newest().step, order = config.grid.order;
  const bool is_time = n > 0 && (n % steps_between_comparisons == 0 || n == config.grid.steps);
  if (config.adaptive || !is_time || !run.outcome.remark.empty() || !config.variant.is("F", "extrapolated"))
    return;
  const double A_squared = largest_weingarten_squared(run.space, state.x, state.u), tau = config.grid.tau,
               bound = stable_willmore_step(order, A_squared);
  if (tau <= bound) return;
  run.outcome.remark = format("steps of %g with BDF%d can be unstable where |A|² is %.3g, as it is at t = %g",
                              tau, order, A_squared, state.t);
  warn(run.outcome.remark + format("; try steps of at most %.2g", bound) +
       (order > 2 ? format(", %.2g with \"bdf\": 2", stable_willmore_step(2, A_squared)) : "") +
       ", or \"adaptive\"");
}

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
  entry.run = [problem](const Run& run) {
    const WillmoreProblem chosen = problem(run);
    WillmoreStart start = willmore_start(run, chosen);
    WillmoreFlow flow(run.space, willmore_variant(run, chosen), start.theta, limits_of(run));
    flow.reinitialise(start.state);
    run_flow(flow, run, start.state);
  };
  entry.check = check_theta;
  entry.limits = {"curvature_size", "normal_length", "radius_ratio"};
  entry.time_power = 4;
  entry.starts = {{"nu", "H"}};
  if (starts_from_V) entry.starts.push_back({"nu", "H", "V", "z"});
  entry.evolves_curvature = entry.records_kappa_energy = true;
  entry.curvature_cure = curvature_cure;
  entry.cure = willmore_cure;
  return entry;
}

std::vector<Entry> willmore_entries() {
  Entry willmore = willmore_entry([](const Run&) { return WillmoreProblem{willmore_law()}; }),
        surface_diffusion =
            willmore_entry([](const Run&) { return WillmoreProblem{surface_diffusion_law()}; });
  willmore.flow = "willmore";
  willmore.energy = "willmore_energy";
  willmore.help =
      "Willmore flow by kll21 (3.4)-(3.5): V = Delta H + Q, which decreases 1/2 int H²; in the series "
      "willmore_energy is that of H_h, kappa_energy that of the surface itself";
  surface_diffusion.flow = "surface_diffusion";
  surface_diffusion.energy = "area";
  surface_diffusion.help =
      "surface diffusion by kll21 (3.4)-(3.5) with Q = 0: V = Delta H, which keeps the volume";
  return {willmore, surface_diffusion};
}

}  // namespace esfem
