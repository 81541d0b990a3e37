// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/sweep.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "experiments/evolve/cell_run.hpp"
#include "experiments/evolve/config.hpp"
#include "experiments/harness/kept_cells.hpp"
#include "solver/error.hpp"
#include "solver/tables/fit_orders.hpp"

namespace esfem {
namespace {

using nlohmann::json;

/// Parts between commas outside of brackets and quotation marks. Throws InputError when one is not closed.
std::vector<std::string> parts_of(const std::string& list, const std::string& where) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const char c = list[i];
    if (c == '"' && (i == 0 || list[i - 1] != '\\')) is_quoted = !is_quoted;
    if (!is_quoted) depth += (std::string("([{").find(c) < 3) - (std::string(")]}").find(c) < 3);
    if (c == ',' && depth == 0 && !is_quoted)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (depth != 0 || is_quoted) throw InputError(where + ": a bracket or quotation mark is not closed");
  return parts;
}

json value_of(const std::string& text, const std::string& where) {
  const json value = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!value.is_discarded()) return value;
  if (text.empty() || std::string("[{\"").find(text[0]) < 3)
    throw InputError(where + ": found '" + text + "', expected a JSON value or a word");
  return text;
}

std::string last_part(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

/// What may stand in the name of a file.
std::string plain(const std::string& text) {
  std::string name;
  for (unsigned char c : text)
    if (std::isalnum(c) || std::string("._-").find(char(c)) < 3)
      name += char(c);
    else if (c == ',' && !name.empty())
      name += '-';
  return name;
}

/// Names for the values of a key in those of cells: the values where these are short and different, else
/// their places.
std::vector<std::string> names_of(const VariedKey& varied, const std::string& key) {
  const std::size_t longest = 24;
  std::vector<std::string> names;
  std::set<std::string> different;
  bool are_good = true;
  for (const json& value : varied.values) {
    names.push_back(plain(value_text(value)));
    are_good = are_good && !names.back().empty() && names.back().size() <= longest &&
               different.insert(names.back()).second;
  }
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = key + (are_good ? names[i] : format("-%zu", i));
  return names;
}

/// A label: a number, or text.
json label_of(const json& value) {
  return value.is_number() || value.is_string() ? value : json(value.dump());
}

/// The configuration without the varied keys: what all cells have in common.
json common_part(json configuration, const std::vector<VariedKey>& keys) {
  for (const VariedKey& varied : keys) configuration = with_value(configuration, varied.key, nullptr);
  configuration.erase("$schema");
  return configuration;
}

}  // namespace

VariedKey varied_key(const std::string& text) {
  const std::size_t sign = text.find('=');
  const std::string where = "--set " + text;
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
    throw InputError(where + ": expected KEY=VALUE or KEY=VALUE,VALUE, such as parameters.gamma=10,20");
  VariedKey varied{text.substr(0, sign), {}};
  for (const std::string& part : parts_of(text.substr(sign + 1), where)) {
    varied.values.push_back(value_of(part, where));
    if (std::count(varied.values.begin(), varied.values.end(), varied.values.back()) > 1)
      throw InputError(where + ": found " + part + " twice; expected different values");
  }
  return varied;
}

json with_value(json configuration, const std::string& key, const json& value) {
  json* place = &configuration;
  std::size_t start = 0;
  while (true) {
    const std::size_t end = std::min(key.find('.', start), key.size());
    const std::string part = key.substr(start, end - start);
    const std::string where = "--set " + key;
    if (place->is_array()) {
      const bool is_number =
          !part.empty() && part.size() < 6 &&
          std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
      if (!is_number || std::stoul(part) >= place->size())
        throw InputError(where + ": found '" + part +
                         format("'; expected a place of the array, 0 to %d", int(place->size()) - 1));
      place = &(*place)[std::stoul(part)];
    } else if (place->is_object() || place->is_null()) {
      place = &(*place)[part];
    } else {
      throw InputError(where + ": " + key.substr(0, start - 1) + " is " + place->dump() +
                       "; expected an object or an array");
    }
    if (end == key.size()) break;
    start = end + 1;
  }
  *place = value;
  return configuration;
}

std::vector<SweptConfiguration> swept(const json& configuration, const std::vector<VariedKey>& keys) {
  std::vector<SweptConfiguration> all = {{"", configuration, json::object()}};
  for (const VariedKey& varied : keys) {
    const auto has_this_end = [&](const VariedKey& other) {
      return last_part(other.key) == last_part(varied.key);
    };
    if (std::count_if(keys.begin(), keys.end(), [&](const VariedKey& o) { return o.key == varied.key; }) > 1)
      throw InputError("--set: found " + varied.key + " twice, expected it once with all its values");
    const bool is_short = std::count_if(keys.begin(), keys.end(), has_this_end) == 1;
    const std::vector<std::string> names = names_of(varied, is_short ? last_part(varied.key) : varied.key);
    std::vector<SweptConfiguration> more;
    for (const SweptConfiguration& one : all)
      for (std::size_t i = 0; i < varied.values.size(); ++i) {
        SweptConfiguration next = one;
        next.cell += (next.cell.empty() ? "" : "_") + names[i];
        next.configuration = with_value(next.configuration, varied.key, varied.values[i]);
        if (varied.key != "tau" && varied.key != "steps")
          next.labels[varied.key] = label_of(varied.values[i]);
        more.push_back(std::move(next));
      }
    all = std::move(more);
  }
  if (keys.empty()) all.front().cell = "run";
  return all;
}

void sweep(const json& configuration, const std::string& source, const std::vector<std::string>& sets,
           const CellRequest& request, const json& origin) {
  std::vector<VariedKey> keys;
  for (const std::string& set : sets) keys.push_back(varied_key(set));
  std::map<std::string, json> configurations;
  std::vector<Cell> cells;
  for (const SweptConfiguration& one : swept(configuration, keys)) {
    checked_keys(one.configuration, source);
    Cell cell;
    cell.planned = planned_row(one.configuration, one.cell);
    cell.planned.labels = one.labels;
    cell.run = [=](Row& row, const std::string& folder) {
      run_as_cell(one.configuration, source, origin, /*wants_nodal=*/false, folder, row);
    };
    configurations[one.cell] = one.configuration;
    cells.push_back(std::move(cell));
  }
  Table table;
  table.experiment = "evolve";
  table.parameters = {{"configuration", common_part(configuration, keys)}};
  table.provenance = origin;
  NodeCounts nodes;
  const auto cost = [&](const Cell& cell) {
    const json& of_cell = configurations.at(cell.planned.cell);
    return estimated_seconds(of_cell, nodes.of(of_cell, source));
  };
  answer_kept(std::move(cells), request, std::move(table), cost,
              [](Table& all) { all.fits = fit_table(all, {}); });
}

std::string sweep_help() {
  return "evolve CONFIG.json --set parameters.gamma=10,20,30 --set tau=0.01,0.005 --output FOLDER "
         "runs all\n"
         "combinations of these values. A dotted path names a key of the configuration "
         "(kinetics.diffusion.1: the second\n"
         "entry of an array). Values are JSON, or words (--set flow=dziuk,bgn). A row has the values (as "
         "labels; tau and\n"
         "steps are columns of their own), the last value of each series (\"h_end\" for h), min_F and max_F "
         "of each field F at\n"
         "the end (of vectors max_F, of their lengths), and with \"exact\", or where the flow has an exact "
         "solution, the\n"
         "maxima over time of the errors. plots/sweep.py draws the table.\n" +
         kept_cells_help("evolve", "--set .. --set ..");
}

}  // namespace esfem
