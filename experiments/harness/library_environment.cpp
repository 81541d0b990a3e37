// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/library_environment.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string>

#include "experiments/harness/provenance.hpp"
#include "solver/linalg/openblas.hpp"

namespace esfem {

namespace {

bool is_set_to(const char* variable, const std::string& value) {
  const char* found = std::getenv(variable);
  return found && found == value;
}

}  // namespace

int threads_asked(int argc, char** argv) {
  const std::string option = "--threads";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind(option + "=", 0) == 0)
      return std::max(1, std::atoi(argument.c_str() + option.size() + 1));
    if (argument == option && i + 1 < argc) return std::max(1, std::atoi(argv[i + 1]));
  }
  return 1;
}

void set_library_environment(int argc, char** argv) {
  const std::string wanted = std::to_string(threads_asked(argc, argv));
  const char* const variables[] = {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS"};
  bool all_set = std::getenv("OPENBLAS_CORETYPE") || !openblas_core_type();
  for (const char* variable : variables) all_set = all_set && is_set_to(variable, wanted);
  // The guard holds the process id, which survives the restart and is not mistaken for a parent's.
  const std::string process = std::to_string(getpid());
  if (all_set || is_set_to("ESFEM_THREADS", process)) return;

  for (const char* variable : variables) setenv(variable, wanted.c_str(), 1);
  if (const char* core = openblas_core_type()) setenv("OPENBLAS_CORETYPE", core, 0);
  setenv("ESFEM_THREADS", process.c_str(), 1);
  execv(executable_path().c_str(), argv);
  // Not restarted (no /proc): the limits hold at least for what reads them later.
}

}  // namespace esfem
