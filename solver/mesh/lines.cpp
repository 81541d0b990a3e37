// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

bool Lines::next() {
  words_.clear();
  while (words_.empty() && !rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    split(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
  }
  return !words_.empty();
}

void Lines::expect(const std::string& what) {
  if (!next()) fail("the file ends here, " + what + " expected");
  if (word(0)[0] == '$') fail("'" + word(0) + "' found, " + what + " expected");
}

long Lines::integer(int i, const char* what) const {
  return convert<long>(i, what);
}

long Lines::count(int i, const char* what) const {
  const long n = integer(i, what);
  if (n < 0) fail(format("%ld found as %s, a number >= 0 expected", n, what));
  return n;
}

double Lines::coordinate(int i) const {
  const double x = convert<double>(i, "coordinate");
  if (!std::isfinite(x)) fail("coordinate '" + word(i) + "', a finite number expected");
  return x;
}

void Lines::fail(const std::string& message) const {
  throw InputError(format("%s: line %d: %s", file_.c_str(), number_, message.c_str()));
}

void Lines::split(std::string_view line) {
  const char* blanks = " \t\r\f\v";
  for (std::size_t start; (start = line.find_first_not_of(blanks)) != line.npos;) {
    line.remove_prefix(start);
    const std::size_t end = std::min(line.find_first_of(blanks), line.size());
    words_.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

template <class Value>
Value Lines::convert(int i, const char* what) const {
  if (i >= size()) fail(format("%d words found, a %s as number %d expected", size(), what, i + 1));
  std::string_view w = words_[i];
  if (w.size() > 1 && w[0] == '+') w.remove_prefix(1);
  Value value{};
  const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
  if (error != std::errc() || end != w.data() + w.size())
    fail("'" + word(i) + "' found, a number (" + what + ") expected");
  return value;
}

}  // namespace esfem
