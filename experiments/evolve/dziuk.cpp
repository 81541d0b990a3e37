// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/problems/exact_states.hpp"

namespace esfem {
namespace {

void run_dziuk(const Run& run) {
  const Field& x0 = run.config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_mean_curvature_solution(run.config);
  std::function<DziukFlow::State(double)> exact_state;
  if (exact) exact_state = [&](double t) { return exact_dziuk_state(*exact, x0, t); };
  warn(dziuk_warning(run.config.adaptive ? run.config.adaptive->order : run.config.grid.order));
  run_flow(DziukFlow(run.space, limits_of(run)), run, dziuk_state_on(run.space, x0), exact_state);
}

}  // namespace

std::vector<Entry> dziuk_entries() {
  Entry entry;
  entry.flow = "dziuk";
  entry.help = "mean curvature flow by Dziuk's scheme, kll19 (3.6); unstable with bdf 4 and 5";
  entry.run = run_dziuk;
  entry.limits = {"curvature_size", "radius_ratio"};
  entry.exact_solution = exact_mean_curvature_solution;
  // With a higher order the nodes drift along surfaces that are rough, as meshes of files are, until elements
  // degenerate (DziukFlow).
  entry.order_on_files = 1;
  entry.energy = "area";
  entry.can_shrink_to_nothing = entry.is_mean_curvature_flow = true;
  entry.cure = [](const EvolveConfig& config) {
    return "try \"flow\": \"bgn\"" + linear_elements(config) + "; on some meshes " + even_elements + " or " +
           smaller_steps(config) + " with \"bdf\": 1 are enough";
  };
  return {entry};
}

}  // namespace esfem
