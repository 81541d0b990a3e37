// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "solver/error.hpp"

namespace esfem {
namespace {

/// That of the narrowest usual terminal, without the last column.
constexpr int line_width = 79;

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 10) return format("%.2g s", seconds);
  if (seconds < 100) return format("%.0f s", seconds);
  return seconds < 6000 ? format("%.0f min", seconds / 60) : format("%.1f h", seconds / 3600);
}

void clear_progress_line() {
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r%*s\r", line_width, "");
}

Progress::Progress(int cells, double total_cost)
    : shown_(isatty(STDERR_FILENO)), cells_(cells), total_cost_(total_cost) {}

double Progress::elapsed_seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double Progress::seconds_left() const {
  const double pace = done_cost_ > 0 ? done_seconds_ / done_cost_ : 1;
  return pace * (total_cost_ - done_cost_);
}

void Progress::cell_starts(const std::string& name) {
  ++started_;
  if (!shown_) return;
  std::fprintf(stderr, "cell %d/%d %s: %s elapsed, about %s left\n", started_, cells_, name.c_str(),
               duration_text(elapsed_seconds()).c_str(), duration_text(seconds_left()).c_str());
}

void Progress::cell_ends(double cost) {
  done_cost_ += cost;
  done_seconds_ = elapsed_seconds();
}

RunProgress::RunProgress(double start, double end, double tau, int starting_steps, int substeps)
    : shown_(isatty(STDERR_FILENO)),
      start_(start),
      end_(end),
      tau_(tau),
      starting_steps_(starting_steps),
      substeps_(substeps) {}

RunProgress::~RunProgress() {
  clear_progress_line();
}

double RunProgress::work(double t) const {
  if (tau_ == 0) return t - start_;
  const double steps = (t - start_) / tau_;
  return steps + (substeps_ - 1) * std::min<double>(steps, starting_steps_);
}

double RunProgress::fraction(double t) const {
  return end_ > start_ ? work(t) / work(end_) : 1;
}

void RunProgress::show(const std::string& what, double t) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  const double done = fraction(t);
  if (first_fraction_ < 0) {
    first_fraction_ = done;
    first_ = now;
  }
  if (now - newest_ < std::chrono::milliseconds(100)) return;
  newest_ = now;
  std::string text = format("%s, t = %g of %g (%.0f%%)", what.c_str(), t, end_, 100 * done);
  if (done > first_fraction_) {
    const double pace = std::chrono::duration<double>(now - first_).count() / (done - first_fraction_);
    text += ", about " + duration_text(pace * (1 - done)) + " left";
  }
  clear_progress_line();
  std::fprintf(stderr, "%.*s", line_width, text.c_str());
}

}  // namespace esfem
