// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <map>
#include <optional>

#include "experiments/harness/cells.hpp"
#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/provenance.hpp"
#include "solver/error.hpp"
#include "solver/thread_count.hpp"

namespace esfem {

namespace {

/// What the command line asks for.
struct Request {
  std::string preset = "paper", rule;
  std::optional<int> degree, bdf;
  std::optional<std::vector<int>> levels, steps;
  std::optional<Start> start;
  std::vector<std::string> meshes;
  std::map<std::string, std::vector<std::string>> names;  ///< on the experiment's own axes
  std::map<std::string, std::vector<double>> numbers;     ///< the same
  CellRequest cells;
  int threads = 1;
};

void add_run_options(CommandLine& line, Request& request) {
  line.group("Run");
  line.one_of("--preset", {"check", "paper"}, request.preset,
              "paper: as published; check: the smallest part that shows the orders");
  add_cell_options(line, request.cells);
  line.text("--output", request.cells.output,
            "where the table (or list) goes; a table of all cells in FILE.json is written to FILE.csv and "
            "FILE.tex, too; - is standard output",
            "FILE");
  line.integer("--threads", 1, 1024, request.threads, "threads that the factorisations may use");
}

void add_grid_options(CommandLine& line, const Grid& grid, Request& request) {
  line.group("Method (none of these: the runs of the preset; else all combinations of the values given)");
  line.integer("--degree", 1, 4, request.degree, "polynomial degree of the finite elements");
  line.integer("--bdf", 1, 5, request.bdf, "order of the backward difference formula");
  line.parsed(
      "--levels", [&](const std::string& text) { request.levels = parse_list(text, "--levels"); },
      "mesh levels, such as 0,1,2 or 0-4", "LIST");
  line.parsed(
      "--steps", [&](const std::string& text) { request.steps = parse_list(text, "--steps"); },
      "exponents k of the step sizes tau_0 2^-k, such as 0,1 or 0-7", "LIST");
  line.parsed(
      "--start", [&](const std::string& text) { request.start = parse_start(text); },
      "starting values: exact | cascade (lower orders, same step size) | substeps:K (step size tau/K)",
      "START");
  line.files("--mesh", request.meshes,
             "mesh file (Gmsh, OFF, OBJ, PLY, STL) instead of generated meshes; repeatable");
  for (const Axis& axis : grid.axes) {
    if (axis.known.empty())
      line.positive("--" + axis.name, request.numbers[axis.name], axis.help);
    else
      line.names("--" + axis.name, axis.known, request.names[axis.name], axis.help);
  }
  line.text("--quadrature", request.rule,
            "rule on each element: conical:N (N x N Gauss points) | degree:D (symmetric)", "RULE");
}

GridRequest grid_request(const Request& request) {
  GridRequest asked;
  asked.paper = request.preset == "paper";
  asked.meshes = request.meshes;
  asked.rule = request.rule;
  const auto give = [&](const std::string& axis, const Values& values) {
    asked.given.insert_or_assign(axis, values);
  };
  if (request.degree) give("degree", *request.degree);
  if (request.bdf) give("bdf", *request.bdf);
  if (request.levels) give("level", *request.levels);
  if (request.steps) give("step", *request.steps);
  if (request.start) give("start", to_string(*request.start).c_str());
  for (const auto& [axis, values] : request.names)
    if (!values.empty()) give(axis, values);
  for (const auto& [axis, values] : request.numbers)
    if (!values.empty()) give(axis, values);
  return asked;
}

Cell cell_of(const Experiment& experiment, const Choice& choice) {
  const int level = choice.has("level") ? choice.level() : 0, k = choice.has("step") ? choice.step() : 0;
  Row row = planned_row(level, experiment.steps(choice), k, labels(experiment.grid, choice));
  row.cell = cell_name(experiment.grid, choice);
  const auto run = [&experiment, choice](Row& completed, const std::string& folder) {
    experiment.run(choice, completed, folder);
  };
  return {row, experiment.cost(choice), run, experiment.known_end(choice)};
}

std::vector<Cell> cells_of(const Experiment& experiment, const std::vector<Choice>& runs) {
  std::vector<Cell> cells;
  for (const Choice& choice : runs) cells.push_back(cell_of(experiment, choice));
  if (cells.empty()) throw InputError("the values given select no run; expected some that do (see --help)");
  return cells;
}

/// What the table's "parameters" say.
nlohmann::json parameters_of(const Experiment& experiment, const GridRequest& asked,
                             const std::vector<Choice>& runs) {
  nlohmann::json parameters = {{"preset", asked.paper ? "paper" : "check"},
                               {"quadrature", asked.rule.empty() ? "that of the degree" : asked.rule}};
  parameters.update(common_values(experiment.grid, runs));
  if (!experiment.meshes.empty() || !asked.meshes.empty())
    parameters["meshes"] = mesh_parameter(asked.meshes, experiment.meshes);
  parameters.update(experiment.parameters);
  return parameters;
}

/// Where a cell of a table keeps other files: beside it; "" when there is no such place.
std::string cell_folder(const std::string& output, const std::string& stem, const Cell& cell) {
  if (without_extension(output).empty()) return "";
  return (std::filesystem::path(output).parent_path() / "cells" / stem / cell.planned.cell).string();
}

void write_cell(const Cell& cell, const std::string& output, Table table) {
  const std::string folder = without_extension(output);
  table.rows = {run_cell(cell, folder)};
  write_json(table, output);
  remove_checkpoint(folder);
}

void answer(const Experiment& experiment, const Request& request, Table table) {
  const GridRequest asked = grid_request(request);
  const std::vector<Choice> runs = choices(experiment.grid, asked);
  const std::vector<Cell> cells = cells_of(experiment, runs);
  const std::string& output = request.cells.output;
  prepare_output(output);
  if (request.cells.list) return write_list(cells, output);
  table.parameters = parameters_of(experiment, asked, runs);
  if (!request.cells.cell.empty())
    return write_cell(find_cell(cells, request.cells.cell, " of preset " + request.preset), output,
                      std::move(table));
  prepare_table(output);
  const auto folder_of = [&](const Cell& cell) { return cell_folder(output, experiment.stem, cell); };
  if (request.cells.collect_from.empty())
    table.rows = run_cells(cells, folder_of);
  else
    collect(cells, request.cells.collect_from, table);
  for (const Comparison& comparison : experiment.comparisons) add_ratios(comparison, table);
  table.fits = fit_table(table, experiment.fit_range);
  write_table(table, output);
  if (request.cells.collect_from.empty())
    for (const Cell& cell : cells) remove_checkpoint(folder_of(cell));
}

}  // namespace

int run_experiment(const Experiment& experiment, int argc, char** argv) {
  return guarded_main([&] {
    Request request;
    CommandLine line(experiment.help, experiment.stem);
    add_run_options(line, request);
    add_grid_options(line, experiment.grid, request);
    if (!line.parse(argc, argv)) return exit_done;
    set_thread_count(request.threads);

    Table table;
    table.experiment = experiment.stem;
    table.paper = experiment.paper;
    table.provenance = provenance(argc, argv);
    answer(experiment, request, table);
    return exit_done;
  });
}

}  // namespace esfem
