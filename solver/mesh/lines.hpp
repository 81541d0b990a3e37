// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace esfem {

/// The lines of a text file that are not blank, split into words, with their numbers. Words are used up to
/// their end: `7.7` is no integer, `0.03D+01` no coordinate. Lines end as the first one does: with LF, CR LF
/// or CR. A byte order mark (UTF-8) is skipped.
///
/// Two ways to read: line by line (`next`, then words by their index), or word by word (`take`, which goes to
/// the next line when the words of the current one are used up).
class Lines {
 public:
  /// `file` names the file in errors; `text` must outlive the object. What follows the character `comment`
  /// on a line is skipped.
  Lines(std::string file, std::string_view text, char comment = '\0');

  /// Goes to the next line; false at the end of the file.
  bool next();

  /// Goes to the next line, which must exist and not start with $; `what` is what stands there.
  void expect(const std::string& what);

  /// The index of the next word that is not taken yet, on the current line or, when none is left there, on
  /// the next one; `what` it is, for errors. Throws InputError at the end of the file.
  int take(const char* what);
  /// The number of words on the current line that are not taken.
  int left() const { return size() - taken_; }
  /// Takes the words that are left on the current line.
  void take_line() { taken_ = size(); }

  /// The number of the current line, from 1.
  int number() const { return number_; }
  /// The number of its words.
  int size() const { return int(words_.size()); }
  /// Word i (from 0), which must be there.
  std::string word(int i) const { return std::string(words_[i]); }
  /// Whether word i is there and is this one; letters are compared without case.
  bool is(int i, std::string_view lower_case) const;
  /// Makes two words of word i, the first with the given number of characters.
  void split_word(int i, std::size_t characters);
  /// When the last word is a backslash, or ends with one, the words of the next line take its place.
  void continue_line();

  /// Word i as a number; `what` it is, for errors. Throws InputError with file and line.
  long integer(int i, const char* what) const;
  /// The same, at least 0.
  long count(int i, const char* what) const;
  /// The same, any number; may be infinite or NaN.
  double real(int i, const char* what) const;
  /// The same, a finite number.
  double coordinate(int i) const;

  /// Throws InputError: file, line, message.
  [[noreturn]] void fail(const std::string& message) const;

  /// What comes after the current line: a binary part starts there.
  std::string_view rest() const { return rest_; }
  /// Continues after that many bytes of it; lines in them are counted.
  void skip(std::size_t bytes);

 private:
  /// Appends the words of the next line; false at the end of the file.
  bool read_line();
  template <class Value>
  Value convert(int i, const char* what) const;

  std::string file_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  char comment_, line_end_;
  int number_ = 0, taken_ = 0;
};

}  // namespace esfem
