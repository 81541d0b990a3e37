// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/kept_cells.hpp"

#include <filesystem>

#include "experiments/harness/provenance.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

bool is_finished(const Cell& cell, const std::string& folder) {
  return std::filesystem::exists(file_of_cell(folder, cell.planned.cell));
}

/// Throws InputError unless the row of a finished cell is one of this table.
void require_same(const Cell& cell, const CellRequest& request, const Table& table) {
  try {
    read_cell(cell, file_of_cell(request.output, cell.planned.cell), table);
  } catch (const InputError& error) {
    throw InputError(std::string(error.what()) + ": the configuration has changed; another --output keeps " +
                     request.output + " as it is, without the folder " + request.output +
                     "/cells all are run again");
  }
}

void write_row(const Row& row, const std::string& folder, Table table) {
  table.rows = {row};
  write_json(table, file_of_cell(folder, row.cell));
  remove_checkpoint(folder_of_cell(folder, row.cell));
}

void run_one(const Cell& cell, const CellRequest& request, const Table& table) {
  if (is_finished(cell, request.output)) {
    require_same(cell, request, table);
    return warn(file_of_cell(request.output, cell.planned.cell) + " is kept");
  }
  prepare_output(file_of_cell(request.output, cell.planned.cell));
  write_row(run_cell(cell, folder_of_cell(request.output, cell.planned.cell)), request.output, table);
}

/// Runs the cells that are not finished.
void run_missing(const std::vector<Cell>& cells, const CellRequest& request, const Table& table,
                 const std::function<double(const Cell&)>& cost) {
  std::vector<Cell> missing;
  for (const Cell& cell : cells) {
    if (is_finished(cell, request.output))
      require_same(cell, request, table);
    else
      missing.push_back(cell);
  }
  if (missing.empty()) return warn(format("all %zu cells are finished and kept", cells.size()));
  if (missing.size() < cells.size())
    warn(format("%zu of %zu cells are finished and kept", cells.size() - missing.size(), cells.size()));
  for (Cell& cell : missing) cell.cost = cost(cell);
  prepare_output(file_of_cell(request.output, missing.front().planned.cell));
  run_cells(
      missing, [&](const Cell& cell) { return folder_of_cell(request.output, cell.planned.cell); },
      [&](const Row& row) { write_row(row, request.output, table); });
}

}  // namespace

std::string kept_cells_help(const std::string& program, const std::string& options) {
  const std::string command = program + " CONFIG.json " + options + " --output FOLDER";
  return "Each run is a cell. FOLDER/cells/NAME.json is its row, FOLDER/cells/NAME/ has the files that "
         "\"output\" asks for,\n"
         "under their names without folders, and FOLDER/table.json, .csv and .tex are the table of all. A "
         "cell that is\n"
         "finished is kept when the command is repeated, also with more values; one that was stopped "
         "resumes. When the\n"
         "configuration has changed, that is an error. A row's status is \"ok\", \"singular at t = ..\", or "
         "\"failed: why\".\n"
         "Cells as processes of their own, eight at once (on a cluster srun -n1 before the second " +
         program + "):\n  " + command + " --list | cut -d' ' -f1 |\n    xargs -P8 -I{} " + command +
         " --cell {}\n  " + command + "     # the table\n";
}

void add_kept_cell_options(CommandLine& line, CellRequest& request) {
  request.output.clear();
  add_cell_options(line, request);
  line.text("--output", request.output, "the folder of the cells and of the table", "FOLDER");
}

std::string file_of_cell(const std::string& folder, const std::string& name) {
  return folder_of_cell(folder, name) + ".json";
}

std::string folder_of_cell(const std::string& folder, const std::string& name) {
  return folder + "/cells/" + name;
}

void answer_kept(std::vector<Cell> cells, const CellRequest& request, Table table,
                 const std::function<double(const Cell&)>& cost,
                 const std::function<void(Table& table)>& complete) {
  if (!request.list && request.output.empty()) throw InputError("--output is required: expected a FOLDER");
  if (!request.cell.empty()) return run_one(find_cell(cells, request.cell), request, table);
  if (request.list) {
    for (Cell& cell : cells) cell.cost = cost(cell);
    return write_list(cells, "-");
  }
  const std::string file = request.output + "/table.json";
  prepare_output(file);
  prepare_table(file);
  if (request.collect_from.empty()) run_missing(cells, request, table, cost);
  collect(cells, request.collect_from.empty() ? request.output + "/cells" : request.collect_from, table);
  complete(table);
  write_table(table, file);
  warn("written: " + request.output + "/table.json, .csv, .tex");
}

}  // namespace esfem
