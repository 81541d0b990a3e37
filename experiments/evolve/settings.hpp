// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace esfem {

/// A key of "variant" or "parameters" of a configuration.
struct Key {
  enum Kind {
    number,
    positive,
    not_negative,
    truth,
    seed,
    word,
    truth_or_word,
    words_of,  ///< a list of some of the words
    number_or_formula
  } kind;
  std::string name;
  nlohmann::json otherwise;  ///< its default; null: none
  std::string help;
  int length_power = 0;                 ///< the default is in units of L to this power
  std::vector<std::string> words = {};  ///< what a word may be, or one of a list
};
/// A word; the first one is the default.
inline Key word(const std::string& name, const std::vector<std::string>& words, const std::string& help) {
  return {Key::word, name, words.front(), help, 0, words};
}

/// The values of some keys, defaults filled in.
class Settings {
 public:
  Settings() = default;
  /// Throws InputError, headed by `where`, for unknown keys (listing the known ones), which are numbers where
  /// takes_any_number is true, and for values of the wrong type or range.
  Settings(const nlohmann::json& given, const std::vector<Key>& keys, const std::string& where,
           bool takes_any_number = false);

  bool has(const std::string& key) const { return values_.contains(key); }
  /// Whether it has a value that is no default.
  bool is_given(const std::string& key) const;
  double number(const std::string& key) const { return values_.at(key).get<double>(); }
  int integer(const std::string& key) const { return values_.at(key).get<int>(); }
  bool truth(const std::string& key) const { return values_.at(key).get<bool>(); }
  bool is(const std::string& key, const char* word) const { return values_.at(key) == word; }
  /// Whether a list has the word.
  bool has_word(const std::string& key, const char* word) const;
  /// A formula.
  std::string text(const std::string& key) const { return values_.at(key).get<std::string>(); }
  /// All that are numbers.
  std::map<std::string, double> numbers() const;
  double number_or(const std::string& key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
  }

  /// Multiplies the defaults by the powers of L that are their units.
  void scale_defaults(double L);

 private:
  nlohmann::json values_ = nlohmann::json::object();
  std::vector<Key> defaults_;  ///< the keys whose default was taken
};

/// The names of the keys.
std::set<std::string> names_of(const std::vector<Key>& keys);

/// Throws InputError, headed by `where`, for one of these keys that is given, since it has no effect, `why`.
void refuse_given(const Settings& settings, const std::vector<std::string>& keys, const std::string& where,
                  const std::string& why);

}  // namespace esfem
