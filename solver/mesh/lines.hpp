// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace esfem {

/// The lines of a text file that are not blank, split into words, with their numbers. Words are used up to
/// their end: `7.7` is no integer, `0.03D+01` no coordinate.
class Lines {
 public:
  /// `file` names the file in errors; `text` must outlive the object.
  Lines(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {}

  /// Goes to the next line; false at the end of the file.
  bool next();

  /// Goes to the next line, which must exist and not start with $; `what` is what stands there.
  void expect(const std::string& what);

  /// The number of the current line, from 1.
  int number() const { return number_; }
  /// The number of its words.
  int size() const { return int(words_.size()); }
  std::string word(int i) const { return std::string(words_[i]); }

  /// Word i as a number; `what` it is, for errors. Throws InputError with file and line.
  long integer(int i, const char* what) const;
  /// The same, at least 0.
  long count(int i, const char* what) const;
  /// The same, a finite number.
  double coordinate(int i) const;

  /// Throws InputError: file, line, message.
  [[noreturn]] void fail(const std::string& message) const;

  /// What comes after the current line: a binary part starts there.
  std::string_view rest() const { return rest_; }

 private:
  void split(std::string_view line);
  template <class Value>
  Value convert(int i, const char* what) const;

  std::string file_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  int number_ = 0;
};

}  // namespace esfem
