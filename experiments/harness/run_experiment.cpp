// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <set>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/peak_memory.hpp"
#include "experiments/harness/progress.hpp"
#include "experiments/harness/provenance.hpp"
#include "solver/error.hpp"
#include "solver/thread_count.hpp"

namespace esfem {

namespace {

/// What the command line asks for.
struct Request {
  Options options;
  bool list = false;
  std::string cell, collect_from, output = "-";
  int threads = 1;
};

void add_run_options(CommandLine& line, Request& request) {
  line.group("Run");
  line.one_of("--preset", {"check", "paper"}, request.options.preset,
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

void add_method_options(CommandLine& line, Options& options) {
  line.group("Method (none of these: the runs of the preset; else all combinations of the values given)");
  line.integer("--degree", 1, 4, options.degree, "polynomial degree of the finite elements");
  line.integer("--bdf", 1, 5, options.bdf, "order of the backward difference formula");
  line.parsed(
      "--levels", [&](const std::string& text) { options.levels = parse_list(text, "--levels"); },
      "mesh levels, such as 0,1,2 or 0-4", "LIST");
  line.parsed(
      "--steps", [&](const std::string& text) { options.steps = parse_list(text, "--steps"); },
      "exponents k of the step sizes tau_0 2^-k, such as 0,1 or 0-7", "LIST");
  line.parsed(
      "--start", [&](const std::string& text) { options.start = parse_start(text); },
      "starting values: exact | cascade (lower orders, same step size) | substeps:K (step size tau/K)",
      "START");
  line.files("--mesh", options.meshes,
             "mesh file (Gmsh, OFF, OBJ, PLY, STL) instead of generated meshes; repeatable");
}

std::vector<Cell> checked_cells(const Experiment& experiment, const Options& options) {
  static const std::regex file_name("[A-Za-z0-9_.+-]+");
  std::vector<Cell> cells = experiment.cells(options);
  if (cells.empty())
    throw InputError("the grid has no such cell; expected --levels and --steps that select some");
  std::set<std::string> seen;
  for (const Cell& cell : cells)
    if (!std::regex_match(cell.name, file_name) || !seen.insert(cell.name).second)
      throw std::logic_error("cell name '" + cell.name +
                             "' is not unique or not of letters, digits and _.+-");
  return cells;
}

std::vector<Cell> most_expensive_first(std::vector<Cell> cells) {
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.cost > b.cost; });
  return cells;
}

const Cell& find_cell(const std::vector<Cell>& cells, const Request& request) {
  for (const Cell& cell : cells)
    if (cell.name == request.cell) return cell;
  throw InputError("--cell: found '" + request.cell + "', expected one of the " +
                   std::to_string(cells.size()) + " cells of preset " + request.options.preset +
                   " that --list prints, such as " + cells.front().name);
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
  return (std::filesystem::path(output).parent_path() / "cells" / stem / cell.name).string();
}

/// The row is written: the checkpoint is no longer needed.
void remove_checkpoint(const std::string& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::remove(checkpoint_file(folder), ignored);
}

Row run_cell(const Cell& cell, const std::string& folder) {
  const Progress clock(1, cell.cost);
  reset_peak_memory();
  Row row = cell.planned;
  try {
    row = cell.run(cell.planned, folder);
  } catch (const NumericsError& error) {
    row.status = std::string("failed: ") + error.what();
  }
  row.cell = cell.name;
  row.seconds += clock.elapsed_seconds();
  row.peak_memory_mb = peak_memory_mb();
  if (row.status != "ok")
    std::cerr << program_invocation_short_name << ": cell " << cell.name << ": " << row.status << std::endl;
  return row;
}

std::vector<Row> run_all(const std::vector<Cell>& cells, const std::string& output, const std::string& stem) {
  double total_cost = 0;
  for (const Cell& cell : cells) total_cost += cell.cost;
  Progress progress(cells.size(), total_cost);
  std::vector<Row> rows;
  for (const Cell& cell : cells) {
    progress.cell_starts(cell.name);
    rows.push_back(run_cell(cell, cell_folder(output, stem, cell)));
    progress.cell_ends(cell.cost);
  }
  return rows;
}

void require_all_files(const std::vector<Cell>& cells, const std::string& folder) {
  std::vector<std::string> missing;
  for (const Cell& cell : cells)
    if (!std::ifstream(folder + "/" + cell.name + ".json")) missing.push_back(cell.name);
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
    const std::string file = folder + "/" + cell.name + ".json";
    const Table found = table_from_json(read_json(file), file);
    if (found.experiment != table.experiment || found.rows.size() != 1 || found.rows[0].cell != cell.name)
      throw InputError(file + ": expected a table with one row, of cell " + cell.name + " of " +
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
    text += format("%s %.2f\n", cell.name.c_str(), cell.cost);
  write_file(output, text);
}

void write_cell(const Cell& cell, const std::string& output, Table table) {
  const std::string folder = without_extension(output);
  table.rows = {run_cell(cell, folder)};
  write_json(table, output);
  remove_checkpoint(folder);
}

void answer(const Experiment& experiment, const Request& request, Table table) {
  const std::vector<Cell> cells = checked_cells(experiment, request.options);
  const std::string& output = request.output;
  prepare_output(output);
  if (request.list) return write_list(cells, output);
  if (experiment.parameters) table.parameters = experiment.parameters(request.options);
  if (!request.cell.empty()) return write_cell(find_cell(cells, request), output, std::move(table));
  prepare_table(output);
  if (request.collect_from.empty())
    table.rows = run_all(cells, output, experiment.stem);
  else
    collect(cells, request.collect_from, table);
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
    add_method_options(line, request.options);
    experiment.add_options(line);
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
