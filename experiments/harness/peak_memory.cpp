// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/peak_memory.hpp"

#include <sys/resource.h>

#include <fstream>
#include <string>

namespace esfem {

void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  // Only where there is no VmHWM: this value counts the program that started this one, too.
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

}  // namespace esfem
