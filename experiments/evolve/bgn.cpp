// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "solver/flows/bgn_flow.hpp"

namespace esfem {

std::vector<Entry> bgn_entries() {
  Entry entry;
  entry.flow = "bgn";
  entry.help = "mean curvature flow by Barrett, Garcke, Nürnberg 2008: tangential motion keeps the mesh good";
  entry.fields = "H";
  entry.run = [](const Run& run) {
    run_flow(BgnFlow(run.space, limits_of(run)), run, bgn_state_on(run.space, run.config.mesh.nodes));
  };
  entry.limits = {"curvature_size", "radius_ratio"};
  entry.highest_order = entry.order = entry.order_on_files = 1;
  entry.lumps_linear_elements = true;
  entry.energy = "area";
  entry.can_shrink_to_nothing = entry.is_mean_curvature_flow = entry.slides_nodes = true;
  // In its first step, however small, this flow slides its nodes.
  entry.cure = [](const EvolveConfig& config) {
    return "try \"flow\": \"dziuk\"" + linear_elements(config) + "; on some meshes " + even_elements +
           " are enough";
  };
  return {entry};
}

}  // namespace esfem
