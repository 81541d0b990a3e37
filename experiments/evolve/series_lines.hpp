// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <string>

#include "solver/analysis/diagnostics.hpp"

namespace esfem {

/// Whether a series of this name is written as CSV: it ends in .csv.
bool is_csv(const std::string& file);

/// The header "t,area,..", t first, and a line per step, from the first-th on, with 17 digits. first > 0: no
/// header.
std::string csv_lines(const Series& series, std::size_t first = 0);

/// A series as CSV while the run goes on: a line per step, which other programs see at once.
class SeriesLines {
 public:
  explicit SeriesLines(std::string file) : file_(std::move(file)) {}

  /// Writes the steps that are not in the file yet. The first time it replaces the file. Throws InputError
  /// when it cannot be written.
  void append(const Series& series);

 private:
  std::string file_;
  std::ofstream stream_;
  std::size_t written_ = 0;
};

}  // namespace esfem
