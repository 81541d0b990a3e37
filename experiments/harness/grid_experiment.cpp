// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/grid_experiment.hpp"

#include <map>

#include "experiments/harness/method_options.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

/// What is given on the axes of one experiment.
struct AxisOptions {
  std::map<std::string, std::vector<std::string>> names;
  std::map<std::string, std::vector<double>> numbers;
  std::string rule;

  void add_to(CommandLine& line, const Grid& grid) {
    for (const Axis& axis : grid.axes) {
      const std::string option = "--" + axis.name;
      if (axis.known.empty())
        line.positive(option, numbers[axis.name], axis.help);
      else
        line.names(option, axis.known, names[axis.name], axis.help);
    }
    add_quadrature_option(line, rule);
  }

  GridRequest request(const Options& options) const {
    GridRequest request;
    request.paper = options.preset == "paper";
    request.meshes = options.meshes;
    request.rule = rule;
    const auto give = [&](const std::string& axis, const Values& values) {
      request.given.insert_or_assign(axis, values);
    };
    if (options.degree) give("degree", *options.degree);
    if (options.bdf) give("bdf", *options.bdf);
    if (options.levels) give("level", *options.levels);
    if (options.steps) give("step", *options.steps);
    if (options.start) give("start", to_string(*options.start).c_str());
    for (const auto& [axis, values] : names)
      if (!values.empty()) give(axis, values);
    for (const auto& [axis, values] : numbers)
      if (!values.empty()) give(axis, values);
    return request;
  }
};

/// The row of a run; of one that fails, what is known beforehand, and of its mesh.
Row row_of(const GridExperiment& experiment, const Choice& choice, const Row& planned,
           const std::string& folder) {
  Row row = planned;
  try {
    experiment.run(choice, row, folder);
  } catch (const NumericsError& error) {
    const double h = row.h;
    const int nodes = row.nodes;
    row = planned;
    row.h = h;
    row.nodes = nodes;
    row.status = std::string("failed: ") + error.what();
  }
  return row;
}

Cell cell_of(const GridExperiment& experiment, const Choice& choice) {
  const auto run = [&experiment, choice](const Row& planned, const std::string& folder) {
    return row_of(experiment, choice, planned, folder);
  };
  const HalvedSteps steps = experiment.steps(choice);
  const int k = choice.has("step") ? choice.step() : 0;
  Row row = planned_row(choice.has("level") ? choice.level() : 0, steps, k, labels(experiment.grid, choice));
  row.cell = cell_name(experiment.grid, choice);
  return {row.cell, experiment.cost(choice), run, row};
}

nlohmann::json parameters(const GridExperiment& experiment, const GridRequest& request) {
  nlohmann::json parameters = {{"preset", request.paper ? "paper" : "check"},
                               {"quadrature", request.rule.empty() ? "that of the degree" : request.rule}};
  parameters.update(common_values(experiment.grid, choices(experiment.grid, request)));
  if (!experiment.meshes.empty() || !request.meshes.empty())
    parameters["meshes"] = mesh_parameter(request.meshes, experiment.meshes);
  parameters.update(experiment.parameters);
  return parameters;
}

}  // namespace

int run_experiment(const GridExperiment& given, int argc, char** argv) {
  AxisOptions axes;
  Experiment experiment;
  experiment.stem = given.stem;
  experiment.paper = given.paper;
  experiment.help = given.help;
  experiment.fit_range = given.fit_range;
  experiment.add_options = [&](CommandLine& line) { axes.add_to(line, given.grid); };
  experiment.cells = [&](const Options& options) {
    std::vector<Cell> cells;
    for (const Choice& choice : choices(given.grid, axes.request(options)))
      cells.push_back(cell_of(given, choice));
    return cells;
  };
  experiment.parameters = [&](const Options& options) { return parameters(given, axes.request(options)); };
  return run_experiment(experiment, argc, argv);
}

}  // namespace esfem
