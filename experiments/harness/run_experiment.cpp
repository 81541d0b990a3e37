// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/peak_memory.hpp"
#include "experiments/harness/progress.hpp"
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
  bool list = false;
  std::string cell, collect_from, output = "-";
  int threads = 1;
};

/// One independent run.
struct Cell {
  Choice choice;
  Row planned;  ///< what is known beforehand (cell, level, tau, steps, labels)
  double cost;  ///< estimated seconds on one core
};

void add_run_options(CommandLine& line, Request& request) {
  line.group("Run");
  line.one_of("--preset", {"check", "paper"}, request.preset,
              "paper: as published; check: the smallest part that shows the orders");
  line.flag("--list", request.list,
            "print the cells, one a line: name and estimated seconds on one core, most expensive first");
  line.text("--cell", request.cell,
            "run this cell alone and write a table of one row; a run that fails numerically is a row with "
            "status \"failed: why\", and exit code 0",
            "NAME");
  line.text("--collect", request.collect_from,
            "run nothing: make the table from the files DIR/NAME.json of all cells", "DIR");
  line.exclude("--cell", "--list");
  line.exclude("--collect", "--list");
  line.exclude("--collect", "--cell");
  line.text("--output", request.output,
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
  return {choice, row, experiment.cost(choice)};
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

std::vector<Cell> most_expensive_first(std::vector<Cell> cells) {
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.cost > b.cost; });
  return cells;
}

const Cell& find_cell(const std::vector<Cell>& cells, const Request& request) {
  for (const Cell& cell : cells)
    if (cell.planned.cell == request.cell) return cell;
  throw InputError("--cell: found '" + request.cell + "', expected one of the " +
                   std::to_string(cells.size()) + " cells of preset " + request.preset +
                   " that --list prints, such as " + cells.front().planned.cell);
}

/// The name of an output FILE.json without its extension; "" for others.
std::string without_extension(const std::string& output) {
  const std::string extension = ".json";
  const bool has_it = output.size() > extension.size() &&
                      output.compare(output.size() - extension.size(), extension.size(), extension) == 0;
  return has_it ? output.substr(0, output.size() - extension.size()) : "";
}

/// Where a cell of a table keeps other files: beside it; "" when there is no such place.
std::string cell_folder(const std::string& output, const std::string& stem, const Cell& cell) {
  if (without_extension(output).empty()) return "";
  return (std::filesystem::path(output).parent_path() / "cells" / stem / cell.planned.cell).string();
}

/// The row is written: the checkpoint is no longer needed.
void remove_checkpoint(const std::string& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::remove(checkpoint_file(folder), ignored);
}

/// The row of a run; of one that fails, what is known beforehand, and of its mesh.
Row run_cell(const Experiment& experiment, const Cell& cell, const std::string& folder) {
  const Progress clock(1, cell.cost);
  reset_peak_memory();
  Row row = cell.planned;
  try {
    experiment.run(cell.choice, row, folder);
  } catch (const NumericsError& error) {
    const double h = row.h;
    const int nodes = row.nodes;
    row = cell.planned;
    row.h = h;
    row.nodes = nodes;
    row.status = std::string("failed: ") + error.what();
  }
  row.seconds += clock.elapsed_seconds();
  row.peak_memory_mb = peak_memory_mb();
  if (row.status == "ok") return row;
  const std::string why = experiment.known_end(cell.choice);
  std::cerr << program_invocation_short_name << ": cell " << row.cell << ": " << row.status
            << (why.empty() ? "" : "; as expected: " + why) << std::endl;
  return row;
}

std::vector<Row> run_all(const Experiment& experiment, const std::vector<Cell>& cells,
                         const std::string& output) {
  double total_cost = 0;
  for (const Cell& cell : cells) total_cost += cell.cost;
  Progress progress(cells.size(), total_cost);
  std::vector<Row> rows;
  for (const Cell& cell : cells) {
    progress.cell_starts(cell.planned.cell);
    rows.push_back(run_cell(experiment, cell, cell_folder(output, experiment.stem, cell)));
    progress.cell_ends(cell.cost);
  }
  return rows;
}

void require_all_files(const std::vector<Cell>& cells, const std::string& folder) {
  std::vector<std::string> missing;
  for (const Cell& cell : cells)
    if (!std::ifstream(folder + "/" + cell.planned.cell + ".json")) missing.push_back(cell.planned.cell);
  if (!missing.empty())
    throw InputError(folder + "/" + missing.front() + ".json is missing: cell " + missing.front() +
                     " has not been run (nor have " + std::to_string(missing.size() - 1) + " others of " +
                     std::to_string(cells.size()) + "); expected a file for every cell");
}

/// Reads the rows of all cells into `table`, which says what experiment and parameters they must have.
void collect(const std::vector<Cell>& cells, const std::string& folder, Table& table) {
  require_all_files(cells, folder);
  std::vector<nlohmann::json> origins;
  for (const Cell& cell : cells) {
    const std::string file = folder + "/" + cell.planned.cell + ".json";
    const Table found = table_from_json(read_json(file), file);
    if (found.experiment != table.experiment || found.rows.size() != 1 ||
        found.rows[0].cell != cell.planned.cell)
      throw InputError(file + ": expected a table with one row, of cell " + cell.planned.cell + " of " +
                       table.experiment);
    if (found.parameters != table.parameters)
      throw InputError(file + ": found parameters " + found.parameters.dump() + ", expected " +
                       table.parameters.dump());
    table.rows.push_back(found.rows[0]);
    origins.push_back(found.provenance);
  }
  table.provenance = collected_provenance(origins, table.provenance);
}

void write_json(const Table& table, const std::string& output) {
  write_file(output, to_json(table).dump(1) + "\n");
}

/// The JSON comes last: if it exists, so do the others.
void write_table(const Table& table, const std::string& output) {
  const std::string base = without_extension(output);
  if (!base.empty()) {
    write_file(base + ".csv", to_csv(table));
    write_file(base + ".tex", to_latex(table));
  }
  write_json(table, output);
}

void prepare_table(const std::string& output) {
  const std::string base = without_extension(output);
  if (base.empty()) return;
  prepare_output(base + ".csv");
  prepare_output(base + ".tex");
}

void write_list(const std::vector<Cell>& cells, const std::string& output) {
  std::string text;
  for (const Cell& cell : most_expensive_first(cells))
    text += format("%s %.2f\n", cell.planned.cell.c_str(), cell.cost);
  write_file(output, text);
}

void write_cell(const Experiment& experiment, const Cell& cell, const std::string& output, Table table) {
  const std::string folder = without_extension(output);
  table.rows = {run_cell(experiment, cell, folder)};
  write_json(table, output);
  remove_checkpoint(folder);
}

void answer(const Experiment& experiment, const Request& request, Table table) {
  const GridRequest asked = grid_request(request);
  const std::vector<Choice> runs = choices(experiment.grid, asked);
  const std::vector<Cell> cells = cells_of(experiment, runs);
  const std::string& output = request.output;
  prepare_output(output);
  if (request.list) return write_list(cells, output);
  table.parameters = parameters_of(experiment, asked, runs);
  if (!request.cell.empty())
    return write_cell(experiment, find_cell(cells, request), output, std::move(table));
  prepare_table(output);
  if (request.collect_from.empty())
    table.rows = run_all(experiment, cells, output);
  else
    collect(cells, request.collect_from, table);
  for (const Comparison& comparison : experiment.comparisons) add_ratios(comparison, table);
  table.fits = fit_table(table, experiment.fit_range);
  write_table(table, output);
  if (request.collect_from.empty())
    for (const Cell& cell : cells) remove_checkpoint(cell_folder(output, experiment.stem, cell));
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
