// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/claims.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "solver/error.hpp"
#include "solver/tables/claim_families.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {
namespace {

using Json = nlohmann::json;

/// "tau", "tau_min", "tau_max" (or those of h) of the reader as bounds.
void read_bounds(const JsonReader& reader, const std::string& name, double& least, double& most) {
  if (reader.has(name)) {
    if (reader.has(name + "_min") || reader.has(name + "_max"))
      throw InputError(reader.where() + ": '" + name + "' excludes '" + name + "_min' and '" + name +
                       "_max'");
    least = most = reader.number(name);
  } else {
    least = reader.number_or(name + "_min", least);
    most = reader.number_or(name + "_max", most);
  }
  if (!(least <= most))
    throw InputError(format("%s: no %s is in [%g, %g]", reader.where().c_str(), name.c_str(), least, most));
}

void read_rows(const Json& json, const std::string& where, Claim& claim) {
  const JsonReader reader(json, where + ", rows");
  reader.accept_only({"tau", "tau_min", "tau_max", "h", "h_min", "h_max", "from_step"});
  read_bounds(reader, "tau", claim.rows.tau_min, claim.rows.tau_max);
  read_bounds(reader, "h", claim.rows.h_min, claim.rows.h_max);
  if (reader.has("from_step")) claim.from_step = reader.integer("from_step");
  if (claim.from_step < 0) throw InputError(reader.where() + ": 'from_step' is negative");
}

/// The list `key` of presets, which is not empty.
std::set<std::string> read_presets(const JsonReader& reader, const std::string& key) {
  std::set<std::string> presets;
  for (const Json& preset : reader.array(key)) {
    if (preset != "check" && preset != "paper")
      throw InputError(reader.where() + ": '" + key + "': preset " + preset.dump() +
                       ": expected \"check\" or \"paper\"");
    presets.insert(preset.get<std::string>());
  }
  if (presets.empty()) throw InputError(reader.where() + ": '" + key + "' is empty: it would say nothing");
  return presets;
}

void read_figures(const JsonReader& reader, Claim& claim) {
  for (const Json& figure : reader.array("figures")) {
    if (!figure.is_string()) reader.wrong_type("figures", "numbers as strings, such as \"13.1\"", figure);
    claim.figures.push_back(figure);
  }
}

void read_order(const JsonReader& reader, Claim& claim) {
  claim.kind = Claim::order;
  claim.variable = reader.text("variable");
  if (claim.variable != "h" && claim.variable != "tau")
    throw InputError(reader.where() + ": variable '" + claim.variable + "': expected h or tau");
  claim.expected = reader.number("expected");
  claim.tolerance = reader.number("tolerance");
  if (claim.tolerance < 0) throw InputError(reader.where() + ": 'tolerance' is negative");
  claim.at_most = reader.number_or("at_most", claim.at_most);
  if (reader.has("observed")) claim.observed = reader.number("observed");
  if (reader.has("cannot_be_told")) claim.cannot_be_told = read_presets(reader, "cannot_be_told");
}

void read_bounds_of(Claim::Kind kind, const JsonReader& reader, Claim& claim) {
  claim.kind = kind;
  const bool has_bounds = reader.has("at_most") || reader.has("at_least");
  if (has_bounds == reader.has("observed"))
    throw InputError(reader.where() +
                     ": a claim of this kind needs 'at_most' or 'at_least', or else 'observed'");
  if (reader.has("observed")) {
    const double number = reader.number("observed"), margin = Claim::observed_margin * std::abs(number);
    claim.at_least = number - margin;
    claim.at_most = number + margin;
    return;
  }
  claim.at_most = reader.number_or("at_most", claim.at_most);
  claim.at_least = reader.number_or("at_least", claim.at_least);
}

void read_finding(const JsonReader& reader, Claim& claim) {
  static const std::set<std::string> known = {"reproduced", "reproduced, but", "not reproduced", "corrected"};
  claim.remark = reader.has("remark") ? reader.text("remark") : "";
  if (!reader.has("finding")) return;
  claim.finding = reader.text("finding");
  if (known.count(claim.finding) == 0)
    throw InputError(reader.where() + ": finding '" + claim.finding +
                     "': expected reproduced; reproduced, but; not reproduced; or corrected");
  if (claim.remark.empty() && claim.finding != "reproduced")
    throw InputError(reader.where() + ": finding '" + claim.finding + "' needs a 'remark' that says why");
}

constexpr int longest_quote = 15;

int word_count(const std::string& text) {
  std::istringstream words(text);
  return static_cast<int>(
      std::distance(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()));
}

void read_source(const JsonReader& reader, Claim& claim) {
  static const std::set<std::string> known = {"statement", "theory", "independent", "finding", "regression"};
  reader.accept_only({"paper", "place", "basis", "quote"});
  claim.paper = reader.text("paper");
  claim.place = reader.text("place");
  claim.basis = reader.text("basis");
  if (known.count(claim.basis) == 0)
    throw InputError(reader.where() + ": basis '" + claim.basis +
                     "': expected statement, theory, independent, finding or regression");
  if (reader.has("quote") != (claim.basis == "statement"))
    throw InputError(reader.where() +
                     ": expected 'quote', the paper's own words, of a statement and of nothing else");
  if (claim.basis != "statement") return;
  claim.quote = reader.text("quote");
  if (const int words = word_count(claim.quote); words == 0 || words > longest_quote)
    throw InputError(reader.where() +
                     format(", quote: found %d words, expected 1 to %d", words, longest_quote));
}

Claim claim_from_json(const Json& json, const std::string& place) {
  const std::string id = JsonReader(json, place).text("id");
  const JsonReader reader(json, place + " '" + id + "'");
  Claim claim;
  claim.id = id;
  claim.statement = reader.text("statement");
  read_source(JsonReader(reader.object("source"), reader.where() + ", source"), claim);
  claim.quantity = reader.text("quantity");
  if (reader.has("where")) {
    claim.where = reader.object("where");
    require_labels(claim.where, reader.where() + ", where");
  }
  if (reader.has("rows")) read_rows(reader.object("rows"), reader.where(), claim);
  if (reader.has("presets")) claim.presets = read_presets(reader, "presets");
  if (reader.has("figures")) read_figures(reader, claim);

  read_finding(reader, claim);

  std::set<std::string> known = {"id",   "statement", "source",  "kind",    "quantity", "where",
                                 "rows", "presets",   "figures", "at_most", "finding",  "remark"};
  const std::string kind = reader.text("kind");
  if (kind == "order") {
    known.insert({"variable", "expected", "tolerance", "observed", "cannot_be_told"});
    read_order(reader, claim);
  } else if (kind == "size" || kind == "value") {
    known.insert({"at_least", "observed"});
    read_bounds_of(kind == "size" ? Claim::size : Claim::value, reader, claim);
  } else {
    throw InputError(reader.where() + ": kind '" + kind + "': expected order, size or value");
  }
  if (claim.kind != Claim::value) {
    known.insert("norm");
    claim.norm = reader.text("norm");
  }
  reader.accept_only(known);
  return claim;
}

/// The rows and numbers that a claim is about.
struct Selection {
  std::vector<double> h, tau, number;
};

bool has_label(const Row& row, const std::string& name, const Json& value) {
  const auto label = row.labels.find(name);
  return label != row.labels.end() && *label == value;
}

/// Throws InputError, which names the key, when no row has a label or a value that the claim asks for.
void require_known_labels(const Claim& claim, const Table& table) {
  for (const auto& wanted : claim.where.items()) {
    std::set<std::string> labels, values;
    bool found = false;
    for (const Row& row : table.rows) {
      found = found || has_label(row, wanted.key(), wanted.value());
      for (const auto& label : row.labels.items()) {
        labels.insert(label.key());
        if (label.key() == wanted.key()) values.insert(label.value().dump());
      }
    }
    if (found) continue;
    const std::string key =
        "where: no row has " + std::string(values.empty() ? "the label " : "") + wanted.key();
    if (values.empty()) throw InputError(key + "; labels of the rows are " + listed(labels));
    throw InputError(key + " = " + wanted.value().dump() + "; found are " + listed(values));
  }
}

bool is_selected(const Row& row, const Claim& claim) {
  for (const auto& label : claim.where.items())
    if (!has_label(row, label.key(), label.value())) return false;
  // A run that failed before h was measured may be one of any h.
  RowRange range = claim.rows;
  if (row.status != "ok" && row.h == 0) range.h_min = 0;
  return in_range(row, range);
}

double selected_number(const Row& row, const Claim& claim) {
  if (claim.kind == Claim::value) {
    const auto value = row.values.find(claim.quantity);
    if (value == row.values.end())
      throw InputError("cell " + row.cell + " has no value " + claim.quantity + " (" + row.status + ")");
    return value->second;
  }
  if (claim.from_step > 0) return maximum_from(row, claim.quantity, claim.norm, claim.from_step);
  const auto norms = row.errors.find(claim.quantity);
  if (norms == row.errors.end() || norms->second.count(claim.norm) == 0)
    throw InputError("cell " + row.cell + " has no error " + claim.quantity + " " + claim.norm);
  return norms->second.at(claim.norm);
}

/// A run that ended at a singularity counts with its measurements until then; it has no errors over the whole
/// time.
bool is_complete(const Row& row, const Claim& claim) {
  return claim.kind == Claim::value ? !failed(row) : row.status == "ok";
}

/// Throws InputError when the rows in range are none, of several variants, or do not all have the number.
Selection select(const Claim& claim, const Table& table) {
  require_known_labels(claim, table);
  Selection selection;
  std::set<std::string> variants;
  for (const Row& row : table.rows) {
    if (!is_selected(row, claim)) continue;
    if (!is_complete(row, claim)) throw InputError("cell " + row.cell + " " + row.status);
    const double number = selected_number(row, claim);
    if (!std::isfinite(number)) throw InputError("the error of cell " + row.cell + " is not finite");
    selection.h.push_back(row.h);
    selection.tau.push_back(row.tau);
    selection.number.push_back(number);
    variants.insert(variant(row));
  }
  if (variants.empty()) throw InputError("no row of the table is in the range of the claim");
  if (variants.size() > 1)
    throw InputError("rows of the variants '" + *variants.begin() + "' and '" + *variants.rbegin() +
                     "' are in range; labels in 'where' select one");
  return selection;
}

/// "" for a table without preset.
std::string preset_of(const Table& table) {
  const auto preset = table.parameters.find("preset");
  return preset != table.parameters.end() && preset->is_string() ? preset->get<std::string>() : "";
}

Verdict check_order(const Claim& claim, const Selection& rows) {
  if (*std::max_element(rows.number.begin(), rows.number.end()) < round_off)
    throw InputError(format("all errors are below %g, at round-off", round_off));
  const OrderFit fit = fit_orders(rows.h, rows.tau, rows.number);
  const std::optional<ObservedOrder>& order = claim.variable == "tau" ? fit.tau : fit.h;
  if (!order) throw NumericsError("the errors do not show how they depend on " + claim.variable);

  Verdict verdict;
  verdict.measured = true;
  verdict.rows_used = fit.rows_used;
  verdict.value = order->order;
  verdict.remark = order->remark;
  verdict.interval = order->limit ? order->limit : order->ci95;
  const double least = claim.expected - claim.tolerance, most = claim.at_most;
  if (!verdict.interval) {
    verdict.outcome = Verdict::cannot_be_told;
    verdict.reason = "Cannot be told, the order has no interval: " + order->remark;
    return verdict;
  }
  const auto [low, high] = *verdict.interval;
  if (claim.observed && !(std::abs(verdict.value - *claim.observed) <= Claim::observed_tolerance)) {
    verdict.reason = format("Convergence order %.2f is not the %g that is known here, within %g",
                            verdict.value, *claim.observed, Claim::observed_tolerance);
  } else if (least <= low && high <= most) {
    verdict.outcome = Verdict::holds;
  } else if (high < least) {
    verdict.reason =
        format("Convergence order not achieved: %.2f, expected at least %g", verdict.value, least);
  } else if (low > most) {
    verdict.reason = format("Convergence order too high: %.2f, expected at most %g", verdict.value, most);
  } else {
    verdict.outcome = Verdict::cannot_be_told;
    verdict.reason = format("Cannot be told: the bound %g is between %.2f and %.2f",
                            low < least ? least : most, low, high);
  }
  return verdict;
}

Verdict check_bounds(const Claim& claim, const Selection& rows) {
  const auto [least, most] = std::minmax_element(rows.number.begin(), rows.number.end());
  Verdict verdict;
  verdict.measured = true;
  verdict.rows_used = static_cast<int>(rows.number.size());
  verdict.value = *most <= claim.at_most && !(*least >= claim.at_least) ? *least : *most;
  const std::string number =
      claim.kind == Claim::size ? format("Error %.3e", verdict.value) : format("Value %.6g", verdict.value);
  if (!(*most <= claim.at_most))
    verdict.reason = number + format(" is too large, expected at most %g", claim.at_most);
  else if (!(*least >= claim.at_least))
    verdict.reason = number + format(" is too small, expected at least %g", claim.at_least);
  verdict.outcome = verdict.reason.empty() ? Verdict::holds : Verdict::fails;
  return verdict;
}

}  // namespace

Reference reference_from_json(const Json& json, const std::string& source) {
  const JsonReader reader(json, source);
  reader.accept_only({"experiment", "paper", "runs", "defaults", "claims"});
  Reference reference;
  reference.experiment = reader.text("experiment");
  reference.paper = reader.text("paper");
  if (reader.has("runs")) {
    const JsonReader runs(reader.object("runs"), source + ", runs");
    runs.accept_only({"check", "paper"});
    for (const auto& entry : reader.object("runs").items())
      reference.runs[entry.key()] = runs.integer(entry.key());
  }
  const Json defaults = reader.has("defaults") ? reader.object("defaults") : Json::object();
  std::set<std::string> ids;
  std::size_t entries = 0;
  for (const Json& item : reader.array("claims")) {
    const std::string where = format("%s, claim %zu", source.c_str(), ++entries);
    Json entry = defaults;
    entry.merge_patch(item);
    ClaimFamily family;
    if (entry.is_object() && entry.contains("for"))
      family = expand_family(entry, where);
    else
      family.members = {entry};
    for (const Json& member : family.members) {
      reference.claims.push_back(claim_from_json(member, where));
      reference.claims.back().family = family.id;
      if (!ids.insert(reference.claims.back().id).second)
        throw InputError(source + ": claim '" + reference.claims.back().id + "' occurs twice");
    }
    if (!family.id.empty() && !reference.families.emplace(family.id, family.statement).second)
      throw InputError(source + ": family '" + family.id + "' occurs twice");
  }
  if (reference.claims.empty()) throw InputError(source + ": there is no claim");
  return reference;
}

Verdict check_claim(const Claim& claim, const Table& table) {
  Verdict verdict;
  try {
    const Selection rows = select(claim, table);
    verdict = claim.kind == Claim::order ? check_order(claim, rows) : check_bounds(claim, rows);
  } catch (const InputError& error) {
    verdict.reason = std::string("Cannot be checked: ") + error.what();
  } catch (const NumericsError& error) {
    verdict.outcome = Verdict::cannot_be_told;
    verdict.reason = std::string("Cannot be told: ") + error.what();
  }
  return verdict;
}

bool is_as_expected(const Claim& claim, const Verdict& verdict, const Table& table) {
  const bool is_open = claim.cannot_be_told.count(preset_of(table)) > 0;
  return verdict.outcome == (is_open ? Verdict::cannot_be_told : Verdict::holds);
}

int expected_runs(const Reference& reference, const Table& table) {
  const auto runs = reference.runs.find(preset_of(table));
  return runs == reference.runs.end() ? static_cast<int>(table.rows.size()) : runs->second;
}

bool applies(const Claim& claim, const Table& table) {
  const std::string preset = preset_of(table);
  return claim.presets.empty() || preset.empty() || claim.presets.count(preset) > 0;
}

}  // namespace esfem
