// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/cells.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/peak_memory.hpp"
#include "experiments/harness/progress.hpp"
#include "experiments/harness/provenance.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

using nlohmann::json;

void require_all_files(const std::vector<Cell>& cells, const std::string& folder) {
  std::vector<std::string> missing;
  for (const Cell& cell : cells)
    if (!std::ifstream(folder + "/" + cell.planned.cell + ".json")) missing.push_back(cell.planned.cell);
  if (!missing.empty())
    throw InputError(folder + "/" + missing.front() + ".json is missing: cell " + missing.front() +
                     " has not been run (nor have " + std::to_string(missing.size() - 1) + " others of " +
                     std::to_string(cells.size()) + "); expected a file for every cell");
}

/// Where the parameters of a file differ from those expected.
std::string difference(const json& found, const json& expected) {
  const json one = found.flatten(), other = expected.flatten();
  json both = one;
  both.update(other);
  for (const auto& item : both.items()) {
    const auto text = [&](const json& values) {
      return values.contains(item.key()) ? values.at(item.key()).dump() : std::string("none");
    };
    if (text(one) != text(other))
      return "found " + item.key().substr(1) + " = " + text(one) + ", expected " + text(other);
  }
  return "found parameters " + found.dump() + ", expected " + expected.dump();
}

}  // namespace

void add_cell_options(CommandLine& line, CellRequest& request) {
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
}

const Cell& find_cell(const std::vector<Cell>& cells, const std::string& name, const std::string& of) {
  for (const Cell& cell : cells)
    if (cell.planned.cell == name) return cell;
  throw InputError("--cell: found '" + name + "', expected one of the " + std::to_string(cells.size()) +
                   " cells" + of + " that --list prints, such as " + cells.front().planned.cell);
}

void write_list(const std::vector<Cell>& cells, const std::string& output) {
  std::vector<const Cell*> ordered;
  for (const Cell& cell : cells) ordered.push_back(&cell);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Cell* a, const Cell* b) { return a->cost > b->cost; });
  std::string text;
  for (const Cell* cell : ordered) text += format("%s %.2f\n", cell->planned.cell.c_str(), cell->cost);
  write_file(output, text);
}

Row run_cell(const Cell& cell, const std::string& folder) {
  const Progress clock(1, cell.cost);
  reset_peak_memory();
  Row row = cell.planned;
  try {
    cell.run(row, folder);
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
  std::cerr << program_invocation_short_name << ": cell " << row.cell << ": " << row.status
            << (cell.known_end.empty() ? "" : "; as expected: " + cell.known_end) << std::endl;
  return row;
}

std::vector<Row> run_cells(const std::vector<Cell>& cells,
                           const std::function<std::string(const Cell&)>& folder_of,
                           const std::function<void(const Row&)>& after) {
  double total_cost = 0;
  for (const Cell& cell : cells) total_cost += cell.cost;
  Progress progress(cells.size(), total_cost);
  std::vector<Row> rows;
  for (const Cell& cell : cells) {
    progress.cell_starts(cell.planned.cell);
    rows.push_back(run_cell(cell, folder_of(cell)));
    if (after) after(rows.back());
    progress.cell_ends(cell.cost);
  }
  return rows;
}

Table read_cell(const Cell& cell, const std::string& file, const Table& table) {
  Table found = table_from_json(read_json(file), file);
  if (found.experiment != table.experiment || found.rows.size() != 1 ||
      found.rows[0].cell != cell.planned.cell)
    throw InputError(file + ": expected a table with one row, of cell " + cell.planned.cell + " of " +
                     table.experiment);
  if (found.parameters != table.parameters)
    throw InputError(file + ": its parameters differ: " + difference(found.parameters, table.parameters));
  return found;
}

void collect(const std::vector<Cell>& cells, const std::string& folder, Table& table) {
  require_all_files(cells, folder);
  std::vector<json> origins;
  for (const Cell& cell : cells) {
    Table found = read_cell(cell, folder + "/" + cell.planned.cell + ".json", table);
    table.rows.push_back(std::move(found.rows[0]));
    origins.push_back(std::move(found.provenance));
  }
  table.provenance = collected_provenance(origins, table.provenance);
}

std::string without_extension(const std::string& output) {
  const std::string extension = ".json";
  const bool has_it = output.size() > extension.size() &&
                      output.compare(output.size() - extension.size(), extension.size(), extension) == 0;
  return has_it ? output.substr(0, output.size() - extension.size()) : "";
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

void remove_checkpoint(const std::string& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::remove(checkpoint_file(folder), ignored);
}

}  // namespace esfem
