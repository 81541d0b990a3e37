// SPDX-License-Identifier: GPL-3.0-or-later
// A program that was built for another CPU says so, instead of dying of an illegal instruction. It has to do
// so before anything that may contain one: in the first constructor of the program. This file is compiled for
// any x86-64 and calls nothing but the C library.
#if defined(__x86_64__) && defined(ESFEM_CPU_FEATURES)
#include <errno.h>
#include <string.h>
#include <unistd.h>

namespace {

char message[1000];

void append(const char* text) {
  strncat(message, text, sizeof message - strlen(message) - 1);
}

__attribute__((constructor(101))) void require_cpu() {
  __builtin_cpu_init();
  bool missing = false;
  append(program_invocation_short_name);
  append(": this CPU lacks");
#define ESFEM_REQUIRE(feature)            \
  if (!__builtin_cpu_supports(feature)) { \
    append(missing ? ", " : " ");         \
    append(feature);                      \
    missing = true;                       \
  }
  ESFEM_CPU_FEATURES
  if (!missing) return;
  append(
      ", which the program was built to use: build it on this machine, or for any x86-64 with cmake "
      "-DESFEM_NATIVE=OFF\n");
  if (write(STDERR_FILENO, message, strlen(message)) < 0) _exit(2);
  _exit(1);
}

}  // namespace
#endif
