// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// The N of `--threads N` or `--threads=N` on the command line, 1 without it (or when it is not a number: the
/// command line's own check then reports it).
int threads_asked(int argc, char** argv);

/// Makes sure that no library in the process works with more threads than the command line asks for. OpenBLAS
/// starts its threads when it is loaded and CHOLMOD's OpenMP reads its limit then, long before main, so the
/// only safe way is to set OMP_NUM_THREADS, OMP_THREAD_LIMIT and OPENBLAS_NUM_THREADS and to start the
/// program again in the same process, once. Returns at once when they were set so already. The first call in
/// main.
void limit_threads(int argc, char** argv);

}  // namespace esfem
