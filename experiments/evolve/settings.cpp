// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/settings.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "solver/error.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {
namespace {

using nlohmann::json;

json number_in(const JsonReader& reader, const Key& key) {
  const double value = reader.number(key.name);
  const bool is_good = key.kind == Key::positive ? value > 0 : key.kind != Key::not_negative || value >= 0;
  if (is_good) return value;
  throw InputError(format("%s: found %s = %g; expected %s", reader.where().c_str(), key.name.c_str(), value,
                          key.kind == Key::positive ? "a positive number" : "a number >= 0"));
}

json known_word(const JsonReader& reader, const Key& key) {
  if (const json& given = reader.value(key.name); !given.is_string())
    reader.wrong_type(key.name, ("one of " + listed({key.words.begin(), key.words.end()})).c_str(), given);
  const std::string value = reader.text(key.name);
  if (std::find(key.words.begin(), key.words.end(), value) != key.words.end()) return value;
  std::set<std::string> known(key.words.begin(), key.words.end());
  if (key.kind == Key::truth_or_word) known.insert({"true", "false"});
  throw InputError(reader.where() + ": found " + key.name + " = \"" + value + "\"; expected one of " +
                   listed_for(value, known));
}

json known_words(const JsonReader& reader, const Key& key) {
  const json& words = reader.array(key.name);
  for (const json& word : words)
    if (std::find(key.words.begin(), key.words.end(), word) == key.words.end())
      throw InputError(reader.where() + ": " + key.name + ": found " + word.dump() + "; expected one of " +
                       listed({key.words.begin(), key.words.end()}));
  return words;
}

json number_or_text(const JsonReader& reader, const Key& key) {
  const json& value = reader.value(key.name);
  if (value.is_string()) return value;
  return reader.number(key.name);
}

json value_of(const JsonReader& reader, const Key& key) {
  switch (key.kind) {
  case Key::truth:
    return reader.truth_or(key.name, false);
  case Key::seed:
    return reader.integer_within(key.name, 0, 0, 1000000);
  case Key::word:
    return known_word(reader, key);
  case Key::truth_or_word:
    if (const json value = reader.truth_or_text(key.name); value.is_boolean()) return value;
    return known_word(reader, key);
  case Key::words_of:
    return known_words(reader, key);
  case Key::number_or_formula:
    return number_or_text(reader, key);
  default:
    return number_in(reader, key);
  }
}

}  // namespace

std::set<std::string> names_of(const std::vector<Key>& keys) {
  std::set<std::string> names;
  for (const Key& key : keys) names.insert(key.name);
  return names;
}

Settings::Settings(const json& given, const std::vector<Key>& keys, const std::string& where,
                   bool takes_any_number) {
  const JsonReader reader(given, where);
  const std::set<std::string> known = names_of(keys);
  if (!takes_any_number) reader.accept_only(known);
  for (const auto& item : given.items())
    if (known.count(item.key()) == 0) values_[item.key()] = reader.number(item.key());
  for (const Key& key : keys) {
    if (reader.has(key.name)) {
      values_[key.name] = value_of(reader, key);
    } else if (!key.otherwise.is_null()) {
      values_[key.name] = key.otherwise;
      defaults_.push_back(key);
    }
  }
}

bool Settings::is_given(const std::string& key) const {
  return has(key) && std::none_of(defaults_.begin(), defaults_.end(),
                                  [&](const Key& other) { return other.name == key; });
}

void refuse_given(const Settings& settings, const std::vector<std::string>& keys, const std::string& where,
                  const std::string& why) {
  for (const std::string& key : keys)
    if (settings.is_given(key))
      throw InputError(where + ": found " + key + ", which has no effect " + why + "; expected no key " +
                       key);
}

bool Settings::has_word(const std::string& key, const char* word) const {
  const json& words = values_.at(key);
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::map<std::string, double> Settings::numbers() const {
  std::map<std::string, double> numbers;
  for (const auto& item : values_.items())
    if (item.value().is_number()) numbers[item.key()] = item.value();
  return numbers;
}

void Settings::scale_defaults(double L) {
  for (const Key& key : defaults_)
    if (key.length_power != 0) values_[key.name] = number(key.name) * std::pow(L, key.length_power);
}

}  // namespace esfem
