// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/problems/power_law_sphere.hpp"

namespace esfem {
namespace {

std::optional<ExactEvolution> exact_sphere(const EvolveConfig& config) {
  if (!config.surface || config.surface->name != "sphere") return {};
  return power_law_sphere(config.surface->parameters.at("radius"),
                          PowerLaw(config.parameters.number("power")));
}

void run_generalised_mean_curvature(const Run& run) {
  using State = GeneralisedMeanCurvatureFlow::State;
  using Variant = MeanCurvatureFlow::Variant;
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  const PowerLaw law(config.parameters.number("power"));
  const std::optional<ExactEvolution> exact = exact_sphere(config);
  std::function<State(double)> exact_state;
  if (exact) exact_state = [&](double t) { return exact_generalised_mean_curvature_state(*exact, x0, t); };
  const Field nu_V = start_values(config, {"nu", "V"});
  State initial;
  if (nu_V.size() > 0) {
    const Field v = -(nu_V.leftCols(3).array().colwise() * nu_V.col(3).array()).matrix();
    initial = {0, x0, v, nu_V};
  } else {
    const Field nu_H = curvature_at_start(config, run.space).u;
    initial = generalised_mean_curvature_state(law, x0, nu_H.leftCols(3), nu_H.col(3));
  }
  const auto velocity = config.variant.is("velocity", "ritz") ? Variant::ritz : Variant::interpolation;
  const auto tangential =
      config.variant.is("tangential", "none") ? Variant::none : Variant::minimal_deformation;
  run_flow(GeneralisedMeanCurvatureFlow(run.space, law, velocity, limits_of(run), tangential), run, initial,
           exact_state);
}

}  // namespace

std::vector<Entry> generalised_mean_curvature_entries() {
  Entry entry;
  entry.flow = "generalised_mean_curvature";
  entry.help =
      "Binz, Kovács 2022: v = -V(H) nu, V = H^power, or -H^power for negative powers (-1: inverse mean "
      "curvature flow), H > 0";
  entry.fields = "nu, V";
  entry.variant = {word("velocity", {"ritz", "interpolation"},
                        "v_h: Ritz projection of -V_h nu_h, or its nodal values; without \"tangential\""),
                   tangential_key()};
  entry.parameters = {{Key::number, "power", 2, "of H, not 0"}};
  entry.run = run_generalised_mean_curvature;
  entry.exact_solution = exact_sphere;
  entry.check = [](const EvolveConfig& config, const std::string& source) {
    check_tangential(config, source);
    PowerLaw(config.parameters.number("power"));
  };
  entry.limits = {"curvature_size", "normal_length", "radius_ratio"};
  entry.starts = {{"nu", "H"}, {"nu", "V"}};
  entry.can_shrink_to_nothing = true;
  entry.cure = smaller_steps_or_even_elements;
  return {entry};
}

}  // namespace esfem
