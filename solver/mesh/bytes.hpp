// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "solver/error.hpp"

namespace esfem {

/// Whether this machine stores numbers with the lowest byte first.
inline bool is_little_endian() {
  const std::uint16_t one = 1;
  char first;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

/// The numbers of a binary file, one after the other.
class Bytes {
 public:
  /// `file` names the file in errors; `content` must outlive the object. Reading starts at `position`, which
  /// is in the content or at its end. swapped: the file's byte order is not that of this machine.
  Bytes(std::string file, std::string_view content, std::size_t position, bool swapped = false)
      : file_(std::move(file)), content_(content), position_(position), swapped_(swapped) {}

  /// The next number; `what` it is, for errors. Throws InputError when the file ends before.
  template <class Value>
  Value take(const char* what) {
    if (left() < sizeof(Value)) fail(std::string("the file ends here, ") + what + " expected");
    char bytes[sizeof(Value)];
    std::memcpy(bytes, content_.data() + position_, sizeof(Value));
    if (swapped_) std::reverse(bytes, bytes + sizeof(Value));
    position_ += sizeof(Value);
    Value value;
    std::memcpy(&value, bytes, sizeof(Value));
    return value;
  }

  /// Skips that many bytes, which must exist; `what` they are, for errors.
  void skip(std::size_t bytes, const char* what) {
    if (left() < bytes) fail(std::string("the file ends in ") + what);
    position_ += bytes;
  }

  /// Where the next number begins, in bytes from the beginning of the content.
  std::size_t position() const { return position_; }
  /// The number of bytes from there to the end.
  std::size_t left() const { return content_.size() - position_; }

  /// Throws InputError: file, byte, message.
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(format("%s: byte %zu: %s", file_.c_str(), position_ + 1, message.c_str()));
  }

 private:
  std::string file_;
  std::string_view content_;
  std::size_t position_;
  bool swapped_;
};

}  // namespace esfem
