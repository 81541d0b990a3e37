// SPDX-License-Identifier: GPL-3.0-or-later
// Independent runs that make the rows of one table: their list, one of them, and the table of all.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/command_line.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// One independent run.
struct Cell {
  Row planned;      ///< what is known beforehand (cell, level, tau, steps, labels)
  double cost = 0;  ///< estimated seconds on one core
  /// Completes the planned row; other files of the run go into `folder` (Experiment::run).
  std::function<void(Row& row, const std::string& folder)> run;
  std::string known_end = "";  ///< why it is known to end before its last step; "": it is not
};

/// What the command line asks to do with the cells.
struct CellRequest {
  bool list = false;
  std::string cell, collect_from, output = "-";
};

/// --list, --cell and --collect, of which one may be given.
void add_cell_options(CommandLine& line, CellRequest& request);

/// The cell with this name. Throws InputError, which says how many `cells` there are, of what, and which is
/// one of them.
const Cell& find_cell(const std::vector<Cell>& cells, const std::string& name, const std::string& of = "");

/// Writes name and cost of each cell, most expensive first, one a line.
void write_list(const std::vector<Cell>& cells, const std::string& output);

/// The row of a run; of one that fails (NumericsError), what is known beforehand, and of its mesh, with
/// status "failed: why", which is said on standard error, too.
Row run_cell(const Cell& cell, const std::string& folder);

/// The rows of these cells; folder_of(cell) is that of its other files, after(row) sees each as soon as it is
/// there. Progress with ETA on standard error.
std::vector<Row> run_cells(const std::vector<Cell>& cells,
                           const std::function<std::string(const Cell&)>& folder_of,
                           const std::function<void(const Row&)>& after = {});

/// The one row of a cell's file. Throws InputError when it is of another cell, experiment or other parameters
/// than those of `table`.
Table read_cell(const Cell& cell, const std::string& file, const Table& table);

/// Reads the rows of all cells, folder/NAME.json, into `table`, which says what experiment and parameters
/// they must have. Throws InputError for a missing file, too.
void collect(const std::vector<Cell>& cells, const std::string& folder, Table& table);

/// The name of an output FILE.json without its extension; "" for others.
std::string without_extension(const std::string& output);

/// Writes FILE.json, for a table of all cells FILE.csv and FILE.tex before it; `prepare_table` makes sure of
/// the places of these two.
void write_json(const Table& table, const std::string& output);
void write_table(const Table& table, const std::string& output);
void prepare_table(const std::string& output);

/// The row is written: the checkpoint in the cell's folder is no longer needed.
void remove_checkpoint(const std::string& folder);

}  // namespace esfem
