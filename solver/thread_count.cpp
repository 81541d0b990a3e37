// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/thread_count.hpp"

#include <atomic>

#include "solver/error.hpp"

namespace esfem {
namespace {

std::atomic<int> threads_of_a_factor{1};

}  // namespace

int thread_count() {
  return threads_of_a_factor;
}

void set_thread_count(int count) {
  if (count < 1) throw InputError(format("number of threads: found %d, expected at least 1", count));
  threads_of_a_factor = count;
}

}  // namespace esfem
