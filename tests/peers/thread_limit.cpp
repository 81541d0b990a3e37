// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/peers/thread_limit.hpp"

#include <algorithm>
#include <cstdlib>

// Present when the BLAS is OpenBLAS and when a library was built with OpenMP; null otherwise.
extern "C" {
void openblas_set_num_threads(int) __attribute__((weak));
int omp_get_max_active_levels() __attribute__((weak));
void omp_set_max_active_levels(int) __attribute__((weak));
}

namespace esfem {
namespace {

/// How many threads the user allows by OMP_NUM_THREADS; 1 without it.
int allowed_threads() {
  const char* value = std::getenv("OMP_NUM_THREADS");
  return value ? std::max(1, std::atoi(value)) : 1;
}

}  // namespace

ThreadLimit::ThreadLimit() {
  const int threads = allowed_threads();
  if (openblas_set_num_threads) openblas_set_num_threads(threads);
  if (threads > 1 || !omp_set_max_active_levels || !omp_get_max_active_levels) return;
  levels_ = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
}

ThreadLimit::~ThreadLimit() {
  if (levels_ >= 0) omp_set_max_active_levels(levels_);
}

}  // namespace esfem
