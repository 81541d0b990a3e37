// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// While it lives, BLAS, CHOLMOD and MUMPS use no more threads than the user allows by OMP_NUM_THREADS (1
/// without it). CHOLMOD asks OpenMP for four by an explicit clause, which OMP_NUM_THREADS does not lower; so
/// with one thread allowed, OpenMP regions are made serial.
class ThreadLimit {
 public:
  ThreadLimit();
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  int levels_ = -1;
};

}  // namespace esfem
