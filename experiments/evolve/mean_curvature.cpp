// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/start.hpp"
#include "solver/problems/exact_states.hpp"

namespace esfem {
namespace {

MeanCurvatureFlow::Variant mean_curvature_variant(const Settings& asked) {
  using Variant = MeanCurvatureFlow::Variant;
  Variant variant;
  variant.velocity = asked.is("velocity", "ritz") ? Variant::ritz : Variant::interpolation;
  variant.tangential = asked.is("tangential", "none") ? Variant::none : Variant::minimal_deformation;
  variant.normalise = asked.truth("normalise");
  variant.stabilise = asked.number("stabilise");
  variant.reinitialise = asked.number_or("reinitialise", 0);
  return variant;
}

void run_mean_curvature(const Run& run) {
  using State = MeanCurvatureFlow::State;
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_mean_curvature_solution(config);
  std::function<State(double)> exact_state;
  if (exact) exact_state = [&](double t) { return exact_mean_curvature_state(*exact, x0, t); };
  State initial = curvature_at_start(config, run.space);
  MeanCurvatureFlow flow(run.space, mean_curvature_variant(config.variant), limits_of(run));
  flow.reinitialise(initial);
  run_flow(flow, run, initial, exact_state);
}

std::string mean_curvature_cure(const EvolveConfig& config) {
  const bool curved = config.mesh.degree > 1;
  const bool is_still = config.variant.has("tangential") && config.variant.is("tangential", "none");
  return "try " + std::string(is_still ? "\"variant\": {\"tangential\": \"minimal_deformation\"}, " : "") +
         "\"flow\": \"dziuk\" or \"bgn\"" + linear_elements(config) + "; on some meshes " + even_elements +
         (curved ? " " : ", \"variant\": {\"normalise\": true} ") + "or " + smaller_steps(config) +
         " are enough";
}

}  // namespace

std::vector<Entry> mean_curvature_entries() {
  Entry entry;
  entry.flow = "mean_curvature";
  entry.help = "mean curvature flow by kll19 (5.1): evolution equations for nu and H";
  entry.fields = "nu, H";
  entry.variant = {word("velocity", {"ritz", "interpolation"},
                        "v_h: Ritz projection of -H_h nu_h, or its nodal values; without \"tangential\""),
                   tangential_key(),
                   {Key::truth, "normalise", false, "nu_h to unit length in the nodes after each step"},
                   {Key::not_negative, "stabilise", 0, "alpha of kll19 §14, 1/time"},
                   reinitialise_key()};
  entry.run = run_mean_curvature;
  entry.check = check_tangential;
  entry.exact_solution = exact_mean_curvature_solution;
  entry.limits = {"curvature_size", "normal_length", "radius_ratio"};
  entry.starts = {{"nu", "H"}};
  entry.energy = "area";
  entry.evolves_curvature = entry.can_shrink_to_nothing = entry.is_mean_curvature_flow = true;
  entry.curvature_cure = [](const EvolveConfig&) {
    return "try \"variant\": {\"reinitialise\": 0.05}, \"flow\": \"dziuk\", or " + resolving_mesh;
  };
  entry.cure = mean_curvature_cure;
  return {entry};
}

}  // namespace esfem
