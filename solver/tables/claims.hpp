// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "solver/tables/fit_orders.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// What a paper (or this project) says about one number of an experiment.
///
/// order: the order in `variable`, fitted to the rows in range, is at least expected - tolerance (one-sided:
/// a method may do better), and at most `at_most` when that is given; its whole 95% interval is. size: the
/// error of every row in range is at most `at_most` (and at least `at_least`). value: the same for a number
/// in Row::values.
struct Claim {
  /// What the claim is about.
  enum Kind { order, size, value } kind = order;  ///< says which members below apply
  std::string id;                                 ///< unique in its file
  std::string statement;                          ///< what is claimed, in a sentence
  std::string family;                             ///< the id of the family that it is a member of; "": none
  std::string paper;                              ///< source, e.g. "kll19"
  std::string place;                              ///< in the paper: "§13.1, Fig. 13.1"

  /// What it rests on: "statement" (a sentence or figure of the paper), "theory" (a theorem or an identity),
  /// "independent" (another implementation), "finding" (this project's own), "regression" (the program's own
  /// number, which is to stay what it is).
  std::string basis;
  std::string quote;     ///< statement: the paper's own words
  std::string quantity;  ///< key of Row::errors; value: of Row::values
  std::string norm;      ///< key of Row::errors[quantity]; value: empty
  std::string variable;  ///< order: "h" | "tau"
  double expected = 0;   ///< order
  double tolerance = 0;  ///< order

  /// order: what it is in this setting, where a method does better than `expected`: the fitted order is to be
  /// within observed_tolerance of it, so that a lost order is seen.
  std::optional<double> observed;
  /// See `observed`.
  static constexpr double observed_tolerance = 0.5;
  /// size and value: how far the number may be from "observed", relative to it.
  static constexpr double observed_margin = 0.05;
  /// order: the presets at which the runs are known not to tell. It is an error when they can.
  std::set<std::string> cannot_be_told;
  double at_least = -std::numeric_limits<double>::infinity();  ///< size and value
  double at_most = std::numeric_limits<double>::infinity();    ///< of all kinds
  RowRange rows;                                               ///< the rows in range
  int from_step = 0;  ///< the maximum over time is over the steps n >= this

  /// The rows that have these labels; some labels may be omitted if the selected rows are of one variant.
  nlohmann::json where = nlohmann::json::object();
  std::set<std::string> presets;  ///< where it is checked; empty: everywhere
  std::vector<std::string>
      figures;  ///< of the paper, as it numbers them: beside these the report has the claim

  /// The verdict on the paper's statement, if the bounds are this project's finding: "reproduced",
  /// "reproduced, but", "not reproduced" or "corrected", with the reason; empty: it holds as stated when the
  /// claim is met. A remark may stand alone.
  /// @{
  std::string finding, remark;
  /// @}
};

/// Contents of reference/STEM.json: {"experiment", "paper", "claims": [{"id", "statement", "source":
/// {"paper", "place", "basis", "quote" (of a statement)}, "kind": "order" | "size" | "value", "quantity",
/// "norm" (not of a value), "where": {"flow": "dziuk", "bdf": 4}, "rows": {"tau", "tau_min", "tau_max", "h",
/// "h_min", "h_max", "from_step"}, "presets": [..], "figures": ["13.1"], ...}]}; order: "variable",
/// "expected", "tolerance", and "at_most", "observed", "cannot_be_told" (a list of presets) if wanted; size
/// and value: "at_most" and/or "at_least", or "observed", which are bounds 5% below and above it. "where"
/// selects rows by their labels, rows.tau and rows.h one value. A claim may have "finding" and "remark". An
/// entry with "for" is a family (claim_families.hpp). "defaults" beside "claims" has keys for all of them;
/// those of a claim come first. "runs": {"check": 37, "paper": 176} says how many rows the tables have, so
/// that a missing one is seen where an order holds without it.
struct Reference {
  std::string experiment;                       ///< the STEM of its files
  std::string paper;                            ///< its key, "kll19"; "esfem": this project
  std::vector<Claim> claims;                    ///< the members of a family one after the other
  std::map<std::string, std::string> families;  ///< id -> what its members say together
  std::map<std::string, int> runs;              ///< preset -> how many rows its table has
};

/// Throws InputError naming `source`, the claim and the key; unknown keys are errors, and so is a file
/// without claims.
Reference reference_from_json(const nlohmann::json& json, const std::string& source);

/// What a table says of a claim.
struct Verdict {
  /// An order holds when its whole interval is within the bounds, and fails when none of it is; else it
  /// cannot be told, and not either when there is no interval.
  enum Outcome { holds, cannot_be_told, fails } outcome = fails;  ///< fails unless a check says otherwise
  std::string reason;                                             ///< why it does not hold: one sentence
  bool measured = false;                                          ///< whether the following are set
  double value = 0;  ///< the order, or the error that is furthest from being met

  /// Of an order: its 95% interval, or the limit of slopes that rise or fall; none where `remark` says
  /// why.
  std::optional<Interval> interval;
  std::string remark;  ///< what is to be said of an order (fit_orders.hpp)
  int rows_used = 0;   ///< of the table, when measured

  /// Whether it holds.
  bool met() const { return outcome == holds; }
};

/// A claim for which nothing can be measured (a label or value in "where" that no row has, no rows in range,
/// a failed one or several variants among them, no such quantity, round-off) fails; one whose rows determine
/// no order cannot be told.
Verdict check_claim(const Claim& claim, const Table& table);

/// Whether the verdict is what the reference says: the claim holds, or cannot be told where it says so.
bool is_as_expected(const Claim& claim, const Verdict& verdict, const Table& table);

/// How many rows the table of this preset has to have; its own number where the reference does not say.
int expected_runs(const Reference& reference, const Table& table);

/// Whether the claim is checked at the table's preset, its parameters["preset"]; for a table without one, all
/// claims are checked.
bool applies(const Claim& claim, const Table& table);

}  // namespace esfem
