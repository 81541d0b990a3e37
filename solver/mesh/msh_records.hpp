// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "solver/mesh/bytes.hpp"
#include "solver/mesh/lines.hpp"

namespace esfem {

/// The records of an MSH file: a line each where the file is ASCII, bytes one after the other where it is
/// binary. The heads of sections are lines in both.
class MshRecords {
 public:
  /// `file` names the file in errors; `content` must outlive the object.
  MshRecords(const std::string& file, std::string_view content)
      : lines(file, content), file_(file), content_(content) {}

  Lines lines;  ///< what is text in binary files, too

  /// From now on records are binary; swapped: in the other byte order.
  void set_binary(bool swapped) {
    binary_ = true;
    swapped_ = swapped;
  }
  /// Whether records are binary.
  bool is_binary() const { return binary_; }

  /// The records start behind the current line.
  void open() {
    if (binary_) bytes_.emplace(file_, content_, content_.size() - lines.rest().size(), swapped_);
  }

  /// The lines continue after the last record.
  void close() {
    if (bytes_) lines.skip(bytes_->position() - (content_.size() - lines.rest().size()));
    bytes_.reset();
  }

  /// Goes to the next record, which must exist; `what` it is, for errors.
  void next(const std::string& what) {
    word_ = 0;
    if (!bytes_) lines.expect(what);
  }

  /// Throws InputError unless the record has been read to its end.
  void end() const {
    if (!bytes_ && word_ != lines.size())
      lines.fail(format("%d words found, %d expected", lines.size(), word_));
  }

  /// The next number of the record, an int, a size_t or a double in a binary file; `what` it is, for errors.
  /// @{
  long integer(const char* what) {
    return bytes_ ? bytes_->take<std::int32_t>(what) : lines.integer(word_++, what);
  }
  long size(const char* what) {
    return bytes_ ? bytes_->take<std::int64_t>(what) : lines.integer(word_++, what);
  }
  double real(const char* what) { return bytes_ ? bytes_->take<double>(what) : lines.real(word_++, what); }
  /// @}

  /// The same, at least 0.
  /// @{
  long integer_count(const char* what) { return not_negative(integer(what), what); }
  long size_count(const char* what) { return not_negative(size(what), what); }
  /// @}

  /// The same, finite.
  double coordinate() {
    if (!bytes_) return lines.coordinate(word_++);
    const double x = bytes_->take<double>("coordinate");
    if (!std::isfinite(x)) fail(format("coordinate %g, a finite number expected", x));
    return x;
  }

  /// The line of the record; 0 in a binary file.
  int line() const { return bytes_ ? 0 : lines.number(); }

  /// Throws InputError: file, line or byte, message.
  [[noreturn]] void fail(const std::string& message) const {
    if (bytes_) bytes_->fail(message);
    lines.fail(message);
  }

 private:
  long not_negative(long n, const char* what) const {
    if (n < 0) fail(format("%ld found as %s, a number >= 0 expected", n, what));
    return n;
  }

  std::string file_;
  std::string_view content_;
  std::optional<Bytes> bytes_;  ///< while binary records are read
  bool binary_ = false, swapped_ = false;
  int word_ = 0;
};

}  // namespace esfem
