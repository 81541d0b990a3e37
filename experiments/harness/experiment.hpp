// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/command_line.hpp"
#include "solver/tables/fit_orders.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// Options that every convergence experiment takes; what is not given follows the preset.
struct Options {
  std::string preset = "paper";            ///< --preset check|paper
  std::optional<int> degree;               ///< --degree 1..4
  std::optional<int> bdf;                  ///< --bdf 1..5
  std::optional<std::vector<int>> levels;  ///< --levels 0,1,2 or 0-4: mesh levels
  std::optional<std::vector<int>> steps;   ///< --steps 0,1 or 0-7: exponents k of tau = tau_0 2^-k
  std::optional<Start> start;              ///< --start exact|cascade|substeps:K
  std::vector<std::string> meshes;         ///< --mesh FILE (repeatable): these instead of generated meshes
};

/// One independent run.
struct Cell {
  std::string name;  ///< unique, no blanks or slashes, e.g. "h2_tau5"
  double cost;       ///< estimated seconds on one core
  /// Completes the planned row: everything but cell, peak_memory_mb and seconds; only when it resumes from a
  /// checkpoint it sets seconds, to those of earlier processes. Other files of the run (snapshots,
  /// checkpoint_file) go into `folder`, which may not exist yet; "": none are wanted. It is cells/STEM/CELL
  /// beside the table.
  std::function<Row(Row row, const std::string& folder)> run;
  Row planned = {};  ///< what is known beforehand (level, tau, steps, ...): the row of a run that fails
};

/// Where the cell with this folder keeps its checkpoint; it is removed when the row is written.
inline std::string checkpoint_file(const std::string& folder) {
  return folder + "/checkpoint";
}

/// One experiment: a grid of cells, and how its orders are fitted.
struct Experiment {
  std::string stem, paper;
  std::string help;  ///< what it computes, units, sample command lines: the head of --help
  std::function<void(CommandLine&)> add_options = [](CommandLine&) {};  ///< options of this experiment alone
  std::function<std::vector<Cell>(const Options&)> cells;
  std::function<nlohmann::json(const Options&)> parameters;  ///< the table's "parameters"
  RowRange fit_range;
};

/// The main function of every experiment: --help, --list, --cell, --collect, --output, presets, progress with
/// ETA, provenance, exit codes. A NumericsError of a cell becomes a row with status "failed: why"; everything
/// else ends the program.
int run_experiment(const Experiment& experiment, int argc, char** argv);

/// Runs `body` and maps exceptions to a one-line message on standard error and an exit code: InputError 1,
/// everything else 2.
int guarded_main(const std::function<int()>& body);

}  // namespace esfem
