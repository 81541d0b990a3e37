// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/table.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "solver/error.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {
namespace {

using Json = nlohmann::json;

const char* const schema = "esfem-table/1";
const std::set<std::string> table_keys = {"schema",     "experiment", "paper", "parameters",
                                          "provenance", "rows",       "fits"};
const std::set<std::string> row_keys = {"cell",   "level",  "h",       "nodes",          "tau",
                                        "steps",  "status", "seconds", "peak_memory_mb", "errors",
                                        "values", "series", "labels"};
const std::set<std::string> fit_keys = {"quantity", "norm",      "variable", "order", "ci95",
                                        "slopes",   "rows_used", "labels",   "remark"};

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json finite_number(double value, const std::string& where) {
  if (!std::isfinite(value)) throw InputError(where + " is not finite and cannot be written");
  return value;
}

/// "x.nodal_L2" for the first error that is not finite, "" when all are.
std::string non_finite_error(const Errors& errors) {
  for (const auto& [quantity, norms] : errors)
    for (const auto& [norm, value] : norms)
      if (!std::isfinite(value)) return quantity + "." + norm;
  return "";
}

Json to_json(const Row& row) {
  const std::string where = "row '" + row.cell + "': ";
  Json json = row.more.is_null() ? Json::object() : row.more;
  if (!json.is_object()) throw InputError(where + "its further keys are no JSON object");
  for (const std::string& key : row_keys)
    if (json.contains(key))
      throw InputError(where + "further key '" + key + "' is a key of every row already");
  std::string status = row.status;
  const std::string bad = non_finite_error(row.errors);
  if (status == "ok" && !bad.empty()) status = "failed: error " + bad + " is not finite";

  require_labels(row.labels, where + "labels");
  json["labels"] = row.labels;
  json["cell"] = row.cell;
  json["level"] = row.level;
  json["h"] = finite_number(row.h, where + "h");
  json["nodes"] = row.nodes;
  json["tau"] = finite_number(row.tau, where + "tau");
  json["steps"] = row.steps;
  json["status"] = status;
  json["seconds"] = finite_number(row.seconds, where + "seconds");
  json["peak_memory_mb"] = finite_number(row.peak_memory_mb, where + "peak_memory_mb");
  json["errors"] = Json::object();
  for (const auto& [quantity, norms] : row.errors)
    for (const auto& [norm, value] : norms) json["errors"][quantity][norm] = number_or_null(value);
  if (!row.values.empty()) json["values"] = Json::object();
  for (const auto& [name, value] : row.values)
    json["values"][name] = finite_number(value, where + "value " + name);
  json["series"] = Json::object();
  for (const auto& [name, values] : row.series) {
    Json& list = json["series"][name] = Json::array();
    for (double value : values) list.push_back(number_or_null(value));
  }
  return json;
}

Json to_json(const Fit& fit) {
  const std::string where = "fit of " + fit.quantity + ", " + fit.norm + ": ";
  Json json = {{"quantity", fit.quantity},  {"norm", fit.norm},
               {"variable", fit.variable},  {"order", finite_number(fit.order, where + "order")},
               {"ci95", nullptr},           {"slopes", Json::array()},
               {"rows_used", fit.rows_used}};
  if (fit.ci95)
    json["ci95"] = {finite_number((*fit.ci95)[0], where + "ci95"),
                    finite_number((*fit.ci95)[1], where + "ci95")};
  for (double slope : fit.slopes) json["slopes"].push_back(finite_number(slope, where + "slopes"));
  if (!fit.remark.empty()) json["remark"] = fit.remark;
  require_labels(fit.labels, where + "labels");
  if (!fit.labels.empty()) json["labels"] = fit.labels;
  return json;
}

/// A number, or NaN for null.
double number_or_nan(const JsonReader& reader, const std::string& key, const Json& value) {
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value.is_number()) reader.wrong_type(key, "a number or null", value);
  return value;
}

Json labels_from_json(const JsonReader& reader) {
  const Json& labels = reader.object("labels");
  require_labels(labels, reader.where() + ", labels");
  return labels;
}

Errors errors_from_json(const JsonReader& row) {
  Errors errors;
  for (const auto& quantity : row.object("errors").items()) {
    const std::string key = "errors." + quantity.key();
    if (!quantity.value().is_object()) row.wrong_type(key, "an object", quantity.value());
    for (const auto& norm : quantity.value().items())
      errors[quantity.key()][norm.key()] = number_or_nan(row, key + "." + norm.key(), norm.value());
  }
  return errors;
}

std::map<std::string, std::vector<double>> series_from_json(const JsonReader& row) {
  std::map<std::string, std::vector<double>> series;
  for (const auto& item : row.object("series").items()) {
    const std::string key = "series." + item.key();
    if (!item.value().is_array()) row.wrong_type(key, "an array", item.value());
    std::vector<double>& values = series[item.key()];
    for (const Json& value : item.value()) values.push_back(number_or_nan(row, key, value));
  }
  return series;
}

Row row_from_json(const Json& json, const std::string& where) {
  const JsonReader reader(json, where);
  Row row;
  row.cell = reader.text("cell");
  row.level = reader.integer("level");
  row.h = reader.number("h");
  row.nodes = reader.integer("nodes");
  row.tau = reader.number("tau");
  row.steps = reader.integer("steps");
  row.status = reader.text("status");
  row.seconds = reader.number("seconds");
  row.peak_memory_mb = reader.number("peak_memory_mb");
  row.labels = labels_from_json(reader);
  row.errors = errors_from_json(reader);
  if (reader.has("values"))
    for (const auto& item : reader.object("values").items()) {
      if (!item.value().is_number()) reader.wrong_type("values." + item.key(), "a number", item.value());
      row.values[item.key()] = item.value();
    }
  row.series = series_from_json(reader);
  for (const auto& item : json.items())
    if (row_keys.count(item.key()) == 0) row.more[item.key()] = item.value();

  if (row.status != "ok" && row.status.compare(0, 9, "singular ") != 0 && !failed(row))
    throw InputError(where + ": status '" + row.status +
                     "': expected ok, singular at t = ..: why, or failed: why");
  if (row.status == "ok" && !non_finite_error(row.errors).empty())
    throw InputError(where + ": status is ok, but error " + non_finite_error(row.errors) + " is null");
  return row;
}

std::optional<Interval> interval_from_json(const Json& json, const std::string& where) {
  if (json.is_null()) return std::nullopt;
  if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number())
    throw InputError(where + ": key 'ci95': expected two numbers or null, found " + json.dump());
  return Interval{json[0], json[1]};
}

Fit fit_from_json(const Json& json, const std::string& where) {
  const JsonReader reader(json, where);
  reader.accept_only(fit_keys);
  Fit fit;
  fit.quantity = reader.text("quantity");
  fit.norm = reader.text("norm");
  fit.variable = reader.text("variable");
  fit.order = reader.number("order");
  fit.ci95 = interval_from_json(json.value("ci95", Json()), where);
  for (const Json& slope : json.value("slopes", Json::array())) {
    if (!slope.is_number()) reader.wrong_type("slopes", "numbers", slope);
    fit.slopes.push_back(slope);
  }
  if (reader.has("remark")) fit.remark = reader.text("remark");
  fit.rows_used = reader.integer("rows_used");
  if (reader.has("labels")) fit.labels = labels_from_json(reader);
  return fit;
}

}  // namespace

bool failed(const Row& row) {
  return row.status.compare(0, 8, "failed: ") == 0;
}

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string label_text(const Json& labels) {
  std::string text;
  for (const auto& item : labels.items())
    text += (text.empty() ? "" : ", ") + item.key() + "=" + value_text(item.value());
  return text;
}

std::string variant(const Row& row) {
  return label_text(row.labels);
}

void require_labels(const Json& labels, const std::string& where) {
  if (!labels.is_object())
    throw InputError(where + ": expected an object of strings and numbers, found " + labels.type_name());
  for (const auto& item : labels.items()) {
    const Json& value = item.value();
    if (!value.is_string() && !(value.is_number() && std::isfinite(value.get<double>())))
      throw InputError(where + ": label '" + item.key() + "': expected a string or a finite number, found " +
                       value.dump());
  }
}

double maximum_from(const Row& row, const std::string& quantity, const std::string& norm, int first) {
  const auto series = row.series.find(quantity + "_" + norm);
  if (series == row.series.end() || static_cast<int>(series->second.size()) <= first)
    throw InputError(format("cell %s has no series %s_%s beyond step %d", row.cell.c_str(), quantity.c_str(),
                            norm.c_str(), first));
  return *std::max_element(series->second.begin() + first, series->second.end());
}

Json to_json(const Table& table) {
  Json json = {{"schema", schema},
               {"experiment", table.experiment},
               {"paper", table.paper},
               {"parameters", table.parameters},
               {"provenance", table.provenance},
               {"rows", Json::array()},
               {"fits", Json::array()}};
  for (const Row& row : table.rows) json["rows"].push_back(to_json(row));
  for (const Fit& fit : table.fits) json["fits"].push_back(to_json(fit));
  return json;
}

Table table_from_json(const Json& json, const std::string& source) {
  const JsonReader reader(json, source);
  if (reader.text("schema") != schema)
    throw InputError(source + ": schema '" + reader.text("schema") + "': expected '" + schema + "'");
  reader.accept_only(table_keys);
  Table table;
  table.experiment = reader.text("experiment");
  table.paper = reader.text("paper");
  table.parameters = reader.object("parameters");
  table.provenance = reader.object("provenance");
  std::set<std::string> cells;
  for (const Json& item : reader.array("rows")) {
    table.rows.push_back(row_from_json(item, format("%s, row %zu", source.c_str(), table.rows.size() + 1)));
    if (!cells.insert(table.rows.back().cell).second)
      throw InputError(source + ": cell '" + table.rows.back().cell + "' occurs twice");
  }
  for (const Json& item : reader.array("fits"))
    table.fits.push_back(fit_from_json(item, format("%s, fit %zu", source.c_str(), table.fits.size() + 1)));
  return table;
}

}  // namespace esfem
