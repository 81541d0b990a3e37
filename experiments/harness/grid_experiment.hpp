// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "experiments/harness/choice.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"

namespace esfem {

/// An experiment: a grid of independent runs, what one of them does, and how its orders are fitted. Cells,
/// options, labels and the parameters of the table follow.
struct GridExperiment {
  std::string stem, paper;
  std::string help;  ///< what it computes, units, sample command lines: the head of --help
  Grid grid;
  std::function<HalvedSteps(const Choice&)> steps;
  std::function<double(const Choice&)> cost;  ///< estimated seconds on one core
  /// Completes the planned row (level, tau, steps, labels). Other files of the run (snapshots, checkpoint) go
  /// into `folder`, which may not exist yet; "": none are wanted.
  std::function<void(const Choice&, Row& row, const std::string& folder)> run;
  nlohmann::json parameters = nlohmann::json::object();  ///< parameters of a table in addition to the choices
  std::string meshes;                                    ///< how meshes are generated, for the same
  RowRange fit_range = {};
};

int run_experiment(const GridExperiment& experiment, int argc, char** argv);

}  // namespace esfem
