// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/cells.hpp"

namespace esfem {

/// The paragraph of --help on the options below, for "PROGRAM CONFIG.json OPTIONS".
std::string kept_cells_help(const std::string& program, const std::string& options);

/// --list, --cell, --collect and --output FOLDER.
void add_kept_cell_options(CommandLine& line, CellRequest& request);

/// Where the files of a cell are, and of all.
std::string file_of_cell(const std::string& folder, const std::string& name);
std::string folder_of_cell(const std::string& folder, const std::string& name);

/// Answers the request for cells that keep their rows, folder/cells/NAME.json (a table with one row, and the
/// parameters of `table`), beside their other files in folder/cells/NAME/. So a cell that is finished is not
/// run again; a row with other parameters is an InputError, which says what differs. The table of all is
/// folder/table.json, .csv and .tex, when `complete` has added to it what only all rows together tell.
/// folder: request.output. cost: estimated seconds of a cell; called only when they are wanted.
void answer_kept(std::vector<Cell> cells, const CellRequest& request, Table table,
                 const std::function<double(const Cell&)>& cost,
                 const std::function<void(Table& table)>& complete);

}  // namespace esfem
