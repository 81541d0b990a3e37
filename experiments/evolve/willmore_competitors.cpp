// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "solver/flows/bgn_willmore_flow.hpp"
#include "solver/flows/dziuk_willmore_flow.hpp"

namespace esfem {
namespace {

Entry first_order_entry(const std::string& flow) {
  Entry entry;
  entry.flow = flow;
  entry.highest_order = entry.order = entry.order_on_files = 1;
  entry.time_power = 4;
  entry.energy = "willmore_energy";
  entry.records_kappa_energy = true;
  entry.cure = smaller_steps_or_even_elements;
  return entry;
}

}  // namespace

std::vector<Entry> willmore_competitor_entries() {
  Entry dziuk = first_order_entry("dziuk_willmore");
  dziuk.help = "Willmore flow by Dziuk 2008: positions and the curvature vector";
  dziuk.fields = "w, the curvature vector";
  dziuk.run = [](const Run& run) {
    run_flow(DziukWillmoreFlow(run.space), run, dziuk_willmore_state_on(run.space, run.config.mesh.nodes));
  };
  Entry bgn = first_order_entry("bgn_willmore");
  bgn.help = "Willmore flow by Barrett, Garcke, Nürnberg 2008: tangential motion keeps the mesh good";
  bgn.fields = "H";
  bgn.run = [](const Run& run) {
    run_flow(BgnWillmoreFlow(run.space), run, bgn_willmore_state_on(run.space, run.config.mesh.nodes));
  };
  return {dziuk, bgn};
}

}  // namespace esfem
