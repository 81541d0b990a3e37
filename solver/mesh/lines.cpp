// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/lines.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

Lines::Lines(std::string file, std::string_view text, char comment)
    : file_(std::move(file)), rest_(text), comment_(comment) {
  if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
  const std::size_t end = rest_.find_first_of("\r\n");
  line_end_ = end != rest_.npos && rest_[end] == '\r' && rest_.substr(end + 1, 1) != "\n" ? '\r' : '\n';
}

bool Lines::next() {
  words_.clear();
  taken_ = 0;
  while (words_.empty())
    if (!read_line()) return false;
  return true;
}

void Lines::expect(const std::string& what) {
  if (!next()) fail("the file ends here, " + what + " expected");
  if (word(0)[0] == '$') fail("'" + word(0) + "' found, " + what + " expected");
}

int Lines::take(const char* what) {
  if (left() == 0 && !next()) fail(std::string("the file ends here, ") + what + " expected");
  return taken_++;
}

bool Lines::is(int i, std::string_view lower_case) const {
  if (i >= size()) return false;
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::equal(words_[i].begin(), words_[i].end(), lower_case.begin(), lower_case.end(), same);
}

void Lines::split_word(int i, std::size_t characters) {
  const std::string_view word = words_[i];
  words_[i] = word.substr(0, characters);
  words_.insert(words_.begin() + i + 1, word.substr(characters));
}

void Lines::continue_line() {
  while (!words_.empty() && words_.back().back() == '\\') {
    words_.back().remove_suffix(1);
    if (words_.back().empty()) words_.pop_back();
    if (!read_line()) return;
  }
}

long Lines::integer(int i, const char* what) const {
  return convert<long>(i, what);
}

long Lines::count(int i, const char* what) const {
  const long n = integer(i, what);
  if (n < 0) fail(format("%ld found as %s, a number >= 0 expected", n, what));
  return n;
}

double Lines::real(int i, const char* what) const {
  return convert<double>(i, what);
}

double Lines::coordinate(int i) const {
  const double x = convert<double>(i, "coordinate");
  if (!std::isfinite(x)) fail("coordinate '" + word(i) + "', a finite number expected");
  return x;
}

void Lines::skip(std::size_t bytes) {
  const std::string_view skipped = rest_.substr(0, bytes);
  number_ += int(std::count(skipped.begin(), skipped.end(), '\n'));
  rest_.remove_prefix(skipped.size());
}

void Lines::fail(const std::string& message) const {
  throw InputError(format("%s: line %d: %s", file_.c_str(), std::max(number_, 1), message.c_str()));
}

bool Lines::read_line() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find(line_end_), rest_.size());
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++number_;
  if (comment_ != '\0') line = line.substr(0, line.find(comment_));
  const char* blanks = " \t\r\n\f\v";
  for (std::size_t start; (start = line.find_first_not_of(blanks)) != line.npos;) {
    line.remove_prefix(start);
    const std::size_t length = std::min(line.find_first_of(blanks), line.size());
    words_.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
  return true;
}

template <class Value>
Value Lines::convert(int i, const char* what) const {
  if (i >= size()) fail(format("%d words found, a %s as number %d expected", size(), what, i + 1));
  std::string_view w = words_[i];
  if (w.size() > 1 && w[0] == '+' && w[1] != '-') w.remove_prefix(1);
  Value value{};
  const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
  if (error != std::errc() || end != w.data() + w.size())
    fail("'" + word(i) + "' found, a number (" + what + ") expected");
  return value;
}

}  // namespace esfem
