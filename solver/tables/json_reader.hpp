// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "solver/error.hpp"

namespace esfem {

/// "a, b, c".
std::string listed(const std::set<std::string>& names);
/// The same for a message on an unknown name, with the one that was probably meant (did_you_mean).
std::string listed_for(const std::string& unknown, const std::set<std::string>& known);

/// What `make` makes; the message of an InputError is headed by `where`, for parts that do not know their
/// file.
template <class Make>
auto headed(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

/// Reads a JSON object key by key; every error is an InputError headed by `where` that names the key, what
/// was expected and what was found. The JSON must outlive the reader.
class JsonReader {
 public:
  /// Throws unless `object` is a JSON object.
  JsonReader(const nlohmann::json& object, std::string where);

  /// Whether the key is there, whatever its value.
  bool has(const std::string& key) const { return json_.contains(key); }
  /// The value of a key of this type. Throws when it is missing or of another type.
  /// @{
  std::string text(const std::string& key) const;
  double number(const std::string& key) const;
  /// @}

  /// The same, or `otherwise` where the key is missing.
  /// @{
  double number_or(const std::string& key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
  }
  bool truth_or(const std::string& key, bool otherwise) const;
  /// @}

  /// true, false or a string.
  nlohmann::json truth_or_text(const std::string& key) const;
  /// Whether the key is there and has an object.
  bool is_object(const std::string& key) const { return has(key) && json_[key].is_object(); }
  /// One that an int can hold.
  int integer(const std::string& key) const;
  /// An integer between low and high; `otherwise` where the key is not there.
  int integer_within(const std::string& key, int otherwise, int low, int high) const;
  /// The value of a key, an object, an array or anything. Throws when it is missing or of another type.
  /// @{
  const nlohmann::json& object(const std::string& key, const char* expected = "an object") const;
  const nlohmann::json& array(const std::string& key) const;
  const nlohmann::json& value(const std::string& key) const { return at(key); }
  /// @}

  /// Throws when there is a key that is not in `known`, and lists these.
  void accept_only(const std::set<std::string>& known) const;
  /// The one key of an object that must have exactly one of `known`.
  std::string only_key(const std::set<std::string>& known) const;
  /// Throws: the key, what was `expected` ("a number"), and the type that was found.
  [[noreturn]] void wrong_type(const std::string& key, const char* expected,
                               const nlohmann::json& found) const;
  /// The object as text, for messages.
  std::string found() const { return json_.dump(); }
  /// What heads its errors.
  const std::string& where() const { return where_; }

 private:
  const nlohmann::json& at(const std::string& key) const;

  const nlohmann::json& json_;
  std::string where_;
};

}  // namespace esfem
