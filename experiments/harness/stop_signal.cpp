// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/stop_signal.hpp"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace esfem {
namespace {

/// A handler can reach nothing else.
volatile sig_atomic_t noted = 0;

extern "C" void note_signal(int number) {
  noted = number;
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  constexpr char text[] = "stopping after the step in progress; a second signal ends the run at once\n";
  const int before = errno;
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) errno = before;  // nobody reads it
}

}  // namespace

void note_stop_signals() {
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction action = {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = note_signal;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
}

int stop_signal() {
  return noted;
}

}  // namespace esfem
