// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// The N of `--threads N` or `--threads=N` on the command line, 1 without it (or when it is not a number: the
/// command line's own check then reports it).
int threads_asked(int argc, char** argv);

/// Makes sure that the process and every library in it use at most the number of threads asked for on the
/// command line, and that OpenBLAS takes kernels that suit the CPU (solver/linalg/openblas.hpp; a value of
/// OPENBLAS_CORETYPE that is there already is kept). OpenBLAS reads its variables when it is loaded, and so
/// does CHOLMOD's OpenMP, long before main, so the only safe way is to set OMP_NUM_THREADS, OMP_THREAD_LIMIT,
/// OPENBLAS_NUM_THREADS and OPENBLAS_CORETYPE and to start the program again in the same process, once.
/// Returns at once when they were set so already. The first call in main.
void set_library_environment(int argc, char** argv);

}  // namespace esfem
