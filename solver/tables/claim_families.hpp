// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace esfem {

/// Claims that differ in a few values only.
struct ClaimFamily {
  std::string id;                       ///< as it is written, with names in braces
  std::string statement;                ///< with all values in place of one: "order 1..5 in tau"
  std::vector<nlohmann::json> members;  ///< each a claim by itself
};

/// Writes out an entry of reference/STEM.json that has
///   "for": {"degree": [1, 2, 3], "bdf": 4}, names with their values: a member for each combination; or a
///   list of
///     such objects with the same names, whose combinations are put together;
///   "except": [{"when": {"degree": 1}, "tolerance": 0.5, ..}], other keys of the members that have these
///   values;
///     null removes one.
/// In all other strings {degree} stands for the value, {degree + 1} for one more; a string that is nothing
/// else becomes the value itself: "expected": "{degree + 1}", "where": {"bdf": "{bdf}"}.
///
/// Throws InputError headed by `where` for a name that "for" does not have, an exception that no member has,
/// and more than 1,000 members.
ClaimFamily expand_family(const nlohmann::json& entry, const std::string& where);

}  // namespace esfem
