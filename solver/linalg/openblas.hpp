// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// The value of OPENBLAS_CORETYPE that suits this CPU, or null when OpenBLAS must choose itself. OpenBLAS
/// picks its kernels by the CPU's model number when it is loaded, so that Debian 12's (0.3.21) takes every
/// CPU newer than itself for a Pentium 4 and factorises 1.3 times slower. Set in the environment before the
/// program starts, it also makes results independent of the CPU's model.
inline const char* openblas_core_type() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

}  // namespace esfem
