// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace esfem {

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
  std::fprintf(stderr, "cell %d/%d %s: %.0f s elapsed, about %.0f s left\n", started_, cells_, name.c_str(),
               elapsed_seconds(), seconds_left());
}

void Progress::cell_ends(double cost) {
  done_cost_ += cost;
  done_seconds_ = elapsed_seconds();
}

}  // namespace esfem
