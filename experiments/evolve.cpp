// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any flow on any surface or mesh, from a JSON file
//
// Sample runs:  build/bin/evolve reference/examples/sphere.json
//               build/bin/evolve reference/examples/dumbbell.json
//               build/bin/evolve reference/examples/tumour.json
//               build/bin/evolve reference/examples/willmore.json
//               build/bin/evolve reference/examples/genus2.json
//               build/bin/evolve reference/examples/turing.json
//               build/bin/evolve reference/examples/sweep_schnakenberg.json --set parameters.gamma=10,30,100
//                 --set parameters.b=0.7,0.9,1.1 --output build/sweep
//
// Writes the nodal values at the end, a time series and snapshots, as the file says; `evolve --explain keys`
// explains its keys.
#include <iostream>

#include "experiments/evolve/help.hpp"
#include "experiments/evolve/run_configuration.hpp"
#include "experiments/evolve/sweep.hpp"
#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/kept_cells.hpp"
#include "experiments/harness/provenance.hpp"
#include "solver/error.hpp"
#include "solver/thread_count.hpp"

namespace {

using namespace esfem;
using nlohmann::json;

/// Runs the configuration in a file.
int evolve(const std::string& file, const json& origin) {
  const json description = read_json(file);
  const EvolveConfig config = evolve_config(description, file);
  run_configuration(config, description, origin);
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] {
    std::string file, explained;
    int threads = 1;
    bool schema = false;
    std::vector<std::string> sets;
    CellRequest request;
    CommandLine line(evolve_help(), "evolve");
    line.optional_argument("config", file, "the configuration", "CONFIG.json");
    line.text("--explain", explained, "explain a flow, or what else is listed above", "NAME");
    line.flag("--schema", schema,
              "print the keys of a configuration as JSON Schema; editors complete a configuration that "
              "has \"$schema\": \"schema.json\"");
    line.texts("--set", sets,
               "a key and its values, such as parameters.gamma=10,20,30; repeatable: see --explain sweeps",
               "KEY=VALUES");
    add_kept_cell_options(line, request);
    line.integer("--threads", 1, 1024, threads, "threads that the factorisations may use");
    if (!line.parse(argc, argv)) return static_cast<int>(exit_done);
    if (!explained.empty()) {
      std::cout << evolve_explanation(explained);
      return static_cast<int>(exit_done);
    }
    if (schema) {
      std::cout << evolve_schema().dump(1) << std::endl;
      return static_cast<int>(exit_done);
    }
    if (file.empty()) throw InputError("config is required: expected CONFIG.json (see --help)");
    set_thread_count(threads);
    const json origin = provenance(argc, argv);
    const bool asks_for_cells = request.list || !request.cell.empty() || !request.collect_from.empty();
    if (sets.empty() && request.output.empty() && !asks_for_cells) return evolve(file, origin);
    sweep(read_json(file), file, sets, request, origin);
    return static_cast<int>(exit_done);
  });
}
