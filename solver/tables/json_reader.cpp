// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/json_reader.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "solver/did_you_mean.hpp"

namespace esfem {

using Json = nlohmann::json;

std::string listed(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string listed_for(const std::string& unknown, const std::set<std::string>& known) {
  return listed(known) + did_you_mean(unknown, {known.begin(), known.end()});
}

JsonReader::JsonReader(const Json& object, std::string where) : json_(object), where_(std::move(where)) {
  if (!json_.is_object()) throw InputError(where_ + ": expected a JSON object, found " + json_.type_name());
}

const Json& JsonReader::at(const std::string& key) const {
  if (!has(key)) throw InputError(where_ + ": key '" + key + "' is missing");
  return json_[key];
}

void JsonReader::wrong_type(const std::string& key, const char* expected, const Json& found) const {
  throw InputError(where_ + ": key '" + key + "': expected " + expected + ", found " + found.type_name());
}

std::string JsonReader::text(const std::string& key) const {
  const Json& value = at(key);
  if (!value.is_string()) wrong_type(key, "a string", value);
  return value;
}

Json JsonReader::truth_or_text(const std::string& key) const {
  const Json& value = at(key);
  if (!value.is_boolean() && !value.is_string()) wrong_type(key, "true, false or a string", value);
  return value;
}

double JsonReader::number(const std::string& key) const {
  const Json& value = at(key);
  if (!value.is_number()) wrong_type(key, "a number", value);
  return value;
}

bool JsonReader::truth_or(const std::string& key, bool otherwise) const {
  if (!has(key)) return otherwise;
  const Json& value = at(key);
  if (!value.is_boolean()) wrong_type(key, "true or false", value);
  return value;
}

int JsonReader::integer(const std::string& key) const {
  const Json& value = at(key);
  if (!value.is_number_integer()) wrong_type(key, "an integer", value);
  const double exact = value, bound = std::numeric_limits<int>::max();
  if (std::abs(exact) > bound)
    throw InputError(format("%s: key '%s': found %.17g, expected an integer of size %.10g at most",
                            where_.c_str(), key.c_str(), exact, bound));
  return value;
}

int JsonReader::integer_within(const std::string& key, int otherwise, int low, int high) const {
  const int value = has(key) ? integer(key) : otherwise;
  if (value < low || value > high)
    throw InputError(
        format("%s: found %s = %d; expected %d to %d", where_.c_str(), key.c_str(), value, low, high));
  return value;
}

const Json& JsonReader::object(const std::string& key, const char* expected) const {
  const Json& value = at(key);
  if (!value.is_object()) wrong_type(key, expected, value);
  return value;
}

const Json& JsonReader::array(const std::string& key) const {
  const Json& value = at(key);
  if (!value.is_array()) wrong_type(key, "an array", value);
  return value;
}

void JsonReader::accept_only(const std::set<std::string>& known) const {
  for (const auto& item : json_.items())
    if (known.count(item.key()) == 0)
      throw InputError(where_ + ": unknown key '" + item.key() + "'; known are " +
                       listed_for(item.key(), known));
}

std::string JsonReader::only_key(const std::set<std::string>& known) const {
  accept_only(known);
  if (json_.size() == 1) return json_.begin().key();
  throw InputError(where_ + ": found " + json_.dump() + "; expected exactly one of the keys " +
                   listed(known));
}

}  // namespace esfem
