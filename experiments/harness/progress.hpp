// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

namespace esfem {

/// Prints on standard error, when that is a terminal, which cell runs and the estimated remaining time.
class Progress {
 public:
  /// `total_cost`: estimated seconds of all cells together.
  Progress(int cells, double total_cost);
  void cell_starts(const std::string& name);
  void cell_ends(double cost);
  double elapsed_seconds() const;

 private:
  /// Estimated seconds left: by the pace so far, or by the estimates alone before the first cell has ended.
  double seconds_left() const;

  bool shown_;
  int cells_, started_ = 0;
  double total_cost_, done_cost_ = 0, done_seconds_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace esfem
