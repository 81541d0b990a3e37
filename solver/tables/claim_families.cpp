// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/claim_families.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "solver/error.hpp"
#include "solver/tables/json_reader.hpp"
#include "solver/tables/table.hpp"

namespace esfem {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_members = 1000;

/// The names of "for" with their values, of one member.
using Values = std::map<std::string, Json>;

std::set<std::string> names_of(const Values& values) {
  std::set<std::string> names;
  for (const auto& [name, value] : values) names.insert(name);
  return names;
}

std::string too_many(const std::string& where) {
  return format("%s: expected at most %zu members", where.c_str(), most_members);
}

/// Each member of `found` with each value of a name.
std::vector<Values> combined(const std::vector<Values>& found, const std::string& name, const Json& choices,
                             const std::string& where) {
  std::vector<Values> result;
  for (const Values& values : found) {
    for (const Json& value : choices) {
      require_labels({{name, value}}, where);
      if (result.size() == most_members) throw InputError(too_many(where));
      result.push_back(values);
      result.back()[name] = value;
    }
  }
  return result;
}

std::vector<Values> combinations(const Json& block, const std::string& where) {
  if (!block.is_object() || block.empty())
    throw InputError(where + ": expected names with their values, found " + block.dump());
  std::vector<Values> found(1);
  for (const auto& item : block.items())
    found = combined(found, item.key(), item.value().is_array() ? item.value() : Json::array({item.value()}),
                     where);
  return found;
}

std::vector<Values> members_of(const Json& given, const std::string& where) {
  std::vector<Values> members;
  for (const Json& block : given.is_array() ? given : Json::array({given})) {
    for (Values& values : combinations(block, where)) {
      if (!members.empty() && names_of(values) != names_of(members[0]))
        throw InputError(where + ": found the names " + listed(names_of(values)) + " beside " +
                         listed(names_of(members[0])) + "; expected the same everywhere");
      if (members.size() == most_members) throw InputError(too_many(where));
      members.push_back(std::move(values));
    }
  }
  if (members.empty()) throw InputError(where + ": there is no member");
  return members;
}

/// One that an int can hold with a little more.
bool is_small_integer(const Json& value) {
  return value.is_number_integer() && std::abs(value.get<double>()) < 1e6;
}

/// The value of what stands in braces: a name, or a name with an integer, "degree + 1".
Json value_of(const std::string& expression, const Values& values, const std::string& where) {
  const std::size_t blank = expression.find(' ');
  const auto found = values.find(expression.substr(0, blank));
  if (found == values.end())
    throw InputError(where + ": {" + expression + "}: expected a name of 'for': " + listed(names_of(values)));
  if (blank == std::string::npos) return found->second;
  const std::string sign = expression.substr(blank, 3),
                    digits = expression.substr(std::min(blank + 3, expression.size()));
  const bool is_offset =
      (sign == " + " || sign == " - ") && digits.size() == 1 && '0' <= digits[0] && digits[0] <= '9';
  if (!is_offset || !is_small_integer(found->second))
    throw InputError(where + ": {" + expression +
                     "}: expected a name of an integer with + or - and one digit, such as {degree + 1}");
  const int offset = digits[0] - '0';
  return found->second.get<int>() + (sign == " + " ? offset : -offset);
}

/// The text with what `replacement(expression)` gives in place of each {expression}.
template <class Replacement>
std::string replaced(const std::string& text, const std::string& where, Replacement&& replacement) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t open = text.find('{', begin), close = text.find('}', open);
    result += text.substr(begin, open - begin);
    if (open == std::string::npos) break;
    if (close == std::string::npos) throw InputError(where + ": '" + text + "': a brace is not closed");
    result += replacement(text.substr(open + 1, close - open - 1));
    begin = close + 1;
  }
  return result;
}

/// The JSON with the values of one member.
Json substituted(const Json& json, const Values& values, const std::string& where) {
  if (json.is_structured()) {
    Json result = json;
    for (Json& item : result) item = substituted(item, values, where);
    return result;
  }
  if (!json.is_string()) return json;
  const std::string text = json;
  if (text.size() > 2 && text[0] == '{' && text.find('}') == text.size() - 1)
    return value_of(text.substr(1, text.size() - 2), values, where);
  return replaced(text, where, [&](const std::string& expression) {
    return value_text(value_of(expression, values, where));
  });
}

/// All values of an expression: "1..4" for integers without a gap, "x, nu" otherwise.
std::string values_text(const std::string& expression, const std::vector<Values>& members,
                        const std::string& where) {
  std::vector<Json> found;
  for (const Values& values : members) {
    const Json value = value_of(expression, values, where);
    if (std::find(found.begin(), found.end(), value) == found.end()) found.push_back(value);
  }
  const bool integers = std::all_of(found.begin(), found.end(), is_small_integer);
  if (integers) std::sort(found.begin(), found.end());
  const bool gapless = integers && found.back().get<int>() - found[0].get<int>() + 1 == int(found.size());
  if (gapless && found.size() > 2) return found[0].dump() + ".." + found.back().dump();
  std::string text;
  for (const Json& value : found) text += (text.empty() ? "" : ", ") + value_text(value);
  return text;
}

/// Whether a member has all values of "when"; a list there is any of its values.
bool has_values(const Values& values, const Json& when) {
  for (const auto& item : when.items()) {
    const auto found = values.find(item.key());
    if (found == values.end()) return false;
    const Json wanted = item.value().is_array() ? item.value() : Json{item.value()};
    if (std::find(wanted.begin(), wanted.end(), found->second) == wanted.end()) return false;
  }
  return true;
}

/// Throws InputError when no member has the values of an exception, or it changes nothing.
void check_exception(const Json& exception, const std::vector<Values>& members, const std::string& where) {
  const JsonReader reader(exception, where);
  const Json& when = reader.object("when");
  if (when.empty() || std::none_of(members.begin(), members.end(),
                                   [&](const Values& values) { return has_values(values, when); }))
    throw InputError(where + ": no member has " + when.dump());
  if (exception.size() == 1) throw InputError(where + ": expected other keys beside 'when'");
  for (const char* key : {"id", "for", "except"})
    if (reader.has(key)) throw InputError(where + ": '" + key + "' is the same for all members");
}

}  // namespace

ClaimFamily expand_family(const Json& entry, const std::string& where) {
  const JsonReader reader(entry, where);
  const std::vector<Values> members = members_of(entry.at("for"), where + ", for");
  const Json exceptions = reader.has("except") ? reader.array("except") : Json::array();
  for (const Json& exception : exceptions) check_exception(exception, members, where + ", except");

  ClaimFamily family;
  const auto all_values = [&](const std::string& expression) {
    return values_text(expression, members, where);
  };
  family.id = reader.text("id");
  family.statement = replaced(reader.text("statement"), where, all_values);
  for (const Values& values : members) {
    Json claim = entry;
    for (Json exception : exceptions) {
      if (!has_values(values, exception["when"])) continue;
      exception.erase("when");
      claim.merge_patch(exception);
    }
    claim.erase("for");
    claim.erase("except");
    family.members.push_back(substituted(claim, values, where));
  }
  return family;
}

}  // namespace esfem
