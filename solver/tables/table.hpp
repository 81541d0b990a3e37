// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/read_json.hpp"
#include "solver/write_file.hpp"

namespace esfem {

/// errors["x"]["nodal_L2"]: quantity -> norm -> value. Norms: nodal_L2, nodal_H1, nodal_H1_semi, lifted_L2,
/// lifted_H1, lifted_H1_semi; H1 is the full norm.
using Errors = std::map<std::string, std::map<std::string, double>>;

/// One run of an experiment.
struct Row {
  std::string cell;           ///< its name, unique in the table
  int level = 0;              ///< of the mesh, coarse to fine
  double h = 0;               ///< measured largest edge length of the initial triangulation
  int nodes = 0;              ///< of the mesh
  double tau = 0;             ///< step size
  int steps = 0;              ///< how many were taken
  std::string status = "ok";  ///< "ok", "singular at t = ..: why" (all before it is good), or "failed: why"
  double seconds = 0;         ///< wall-clock time of the run
  double peak_memory_mb = 0;  ///< of the process
  Errors errors;              ///< maxima over time
  std::map<std::string, double> values;  ///< other numbers that claims are about (pinch_time, ..)
  std::map<std::string, std::vector<double>> series;  ///< "t" and what was recorded at these times

  /// What distinguishes the run from others except mesh and step size, as strings and numbers: {"flow":
  /// "dziuk", "bdf": 4}.
  nlohmann::json labels = nlohmann::json::object();
  nlohmann::json more = nlohmann::json::object();  ///< further keys of the row (snapshots, ...)
};

/// Whether the run of this row failed: then it may have nothing but its status.
bool failed(const Row& row);

/// A label's value as readable text: numbers as in JSON, strings without quotation marks.
std::string value_text(const nlohmann::json& value);

/// Labels as readable text: "bdf=4, flow=dziuk"; "" without any.
std::string label_text(const nlohmann::json& labels);

/// The variant that a row belongs to, the text of its labels.
std::string variant(const Row& row);

/// Throws InputError, headed by `where`, unless `labels` is an object of strings and finite numbers.
void require_labels(const nlohmann::json& labels, const std::string& where);

/// Maximum over the steps n >= first of the error norm of quantity, from the row's series "quantity_norm".
/// Throws InputError when the row has no such series or no such step.
double maximum_from(const Row& row, const std::string& quantity, const std::string& norm, int first);

/// From the smallest to the largest value.
using Interval = std::array<double, 2>;

/// A fitted order (fit_orders.hpp).
struct Fit {
  std::string quantity;                              ///< key of Row::errors
  std::string norm;                                  ///< key of Row::errors[quantity]
  std::string variable;                              ///< "h" | "tau"
  double order = 0;                                  ///< in the variable
  std::optional<Interval> ci95;                      ///< none where `remark` says why
  std::vector<double> slopes;                        ///< between neighbours, coarse to fine
  std::string remark;                                ///< why there is no interval, or what the order means
  int rows_used = 0;                                 ///< of the table
  nlohmann::json labels = nlohmann::json::object();  ///< of the rows; none when the table has but one variant
};

/// Schema "esfem-table/1" of results/PRESET/STEM.json. A cell file is a table with one row.
struct Table {
  std::string experiment;                                ///< the STEM of its files
  std::string paper;                                     ///< its key, "kll19"; "esfem": this project
  nlohmann::json parameters = nlohmann::json::object();  ///< of the experiment, "preset" among them
  nlohmann::json provenance = nlohmann::json::object();  ///< how it was made: program, machine, time
  std::vector<Row> rows;                                 ///< one a run
  std::vector<Fit> fits;                                 ///< of fit_table
};

/// Non-finite errors and series values become null, and a row "ok" with such an error becomes a failed one: a
/// check must not pass by leaving it out. InputError when another number is not finite, a key in `more` is
/// one of the row's, or labels are none.
nlohmann::json to_json(const Table& table);
/// Throws InputError naming `source`, the row and the key when something is missing, of the wrong type or
/// another schema. null in errors and series is read as NaN (errors: in failed rows only).
Table table_from_json(const nlohmann::json& json, const std::string& source);

/// The table as CSV (one line a row, one column an error), and as LaTeX (booktabs) with EOC columns as the
/// papers print them: one block per mesh with EOC in tau between neighbouring step sizes, and one per step
/// size with EOC in the measured h.
/// @{
std::string to_csv(const Table& table);
std::string to_latex(const Table& table);
/// @}

}  // namespace esfem
