// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/choice.hpp"
#include "solver/tables/comparison.hpp"
#include "solver/tables/fit_orders.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// An experiment: a grid of independent runs (cells), what one of them does, and how its orders are fitted.
/// Options, names of cells, labels and the parameters of the table follow from the grid.
struct Experiment {
  using Run = std::function<void(const Choice&, Row& row, const std::string& folder)>;

  std::string stem, paper;  ///< names of its files; key of the paper in tables
  std::string help;         ///< what it computes, units, sample command lines: the head of --help
  Grid grid;
  std::function<HalvedSteps(const Choice&)> steps;
  std::function<double(const Choice&)> cost;  ///< estimated seconds on one core
  /// Completes the planned row (cell, level, tau, steps, labels): everything but peak_memory_mb and seconds,
  /// which are those of earlier processes where it goes on from a checkpoint. Other files of the run
  /// (snapshots, checkpoint_file) go into `folder`, which may not exist yet; "": none are wanted. It is
  /// cells/STEM/CELL beside the table.
  Run run;
  /// Why a run is known to end before its last step: its message says so. "": it is not.
  std::function<std::string(const Choice&)> known_end = [](const Choice&) { return ""; };
  nlohmann::json parameters = nlohmann::json::object();  ///< what a table says beside the choices
  std::string meshes = "";                               ///< how meshes are generated, for the same
  RowRange fit_range = {};
  std::vector<Comparison> comparisons = {};  ///< of rows of the whole table

  /// What none can be without, and the presets if these are not just the grid's defaults (Grid).
  Experiment(std::string stem, std::string paper, Run run, std::function<Block(bool paper)> otherwise,
             std::function<std::vector<Block>(bool paper)> preset = {})
      : stem(std::move(stem)), paper(std::move(paper)), run(std::move(run)) {
    grid.otherwise = std::move(otherwise);
    grid.preset = std::move(preset);
  }
};

/// Where the cell with this folder keeps its checkpoint; it is removed when the row is written.
inline std::string checkpoint_file(const std::string& folder) {
  return folder + "/checkpoint";
}

/// The main function of every experiment: --help, --list, --cell, --collect, --output, presets, progress with
/// ETA, provenance, exit codes. A NumericsError of a cell becomes a row with status "failed: why"; everything
/// else ends the program.
int run_experiment(const Experiment& experiment, int argc, char** argv);

/// Runs `body` and maps exceptions to a one-line message on standard error and an exit code: InputError 1,
/// StoppedError after a signal 128 and its number, as shells do, everything else 2.
int guarded_main(const std::function<int()>& body);

}  // namespace esfem
