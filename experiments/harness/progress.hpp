// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

namespace esfem {

/// "0.12 s", "12 s", "35 min", "2.5 h".
std::string duration_text(double seconds);

/// Clears the line of a RunProgress on standard error, when that is a terminal: before a message.
void clear_progress_line();

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

/// One line on standard error, when that is a terminal, that says how far a run has come, and is cleared at
/// its end.
class RunProgress {
 public:
  /// From time `start` to `end`. Equal steps tau: the first `starting_steps` of them take `substeps` steps
  /// each.
  RunProgress(double start, double end, double tau = 0, int starting_steps = 0, int substeps = 1);
  ~RunProgress();
  RunProgress(const RunProgress&) = delete;
  RunProgress& operator=(const RunProgress&) = delete;

  /// what: "step 12". At most ten times a second.
  void show(const std::string& what, double t);

  /// The part of the work that is done at time t.
  double fraction(double t) const;

 private:
  double work(double t) const;

  using Clock = std::chrono::steady_clock;
  bool shown_;
  double start_, end_, tau_;
  int starting_steps_, substeps_;
  double first_fraction_ = -1;  ///< at the first call
  Clock::time_point first_ = Clock::now(), newest_ = {};
};

}  // namespace esfem
