// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "solver/config.hpp"

#ifdef __AVX512F__
#include <immintrin.h>
#endif
#if (ESFEM_PACK_SIZE == 8 && !defined(__AVX512F__)) || (ESFEM_PACK_SIZE == 4 && !defined(__AVX__))
// GCC warns of each function that returns a Pack, also of those that are always inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace esfem {

/// The widest vectors of the machine that the library was configured for: GCC splits wider ones in memory,
/// which is ten times slower. It does not depend on the flags of the including program, because it must agree
/// with the library.
constexpr int pack_size = ESFEM_PACK_SIZE;
static_assert(
    EIGEN_MAX_ALIGN_BYTES == pack_size * sizeof(double),
    "Eigen must align memory as the library does: link the CMake target esfem::esfem, which defines "
    "EIGEN_MAX_ALIGN_BYTES");

/// One double per element of a batch (8 with AVX-512, 4 with AVX2, 2 with SSE2): arithmetic on a Pack is
/// arithmetic on the elements of a batch at once, one instruction each. Scalars mix freely (2 * p, p + 1.0).
///
/// Compiled without the library's -m flags it is several instructions, and a function returns it in memory
/// instead of in a register. So no call from one object file to another passes a Pack by value; allowed are
/// references, structs of several Packs, and functions that are always inlined.
using Pack = double __attribute__((vector_size(pack_size * sizeof(double))));

/// Truth values of comparisons of Packs, -1 or 0.
using Lanes = long __attribute__((vector_size(pack_size * sizeof(long))));

/// All lanes equal.
[[gnu::always_inline]] inline Pack pack(double value) {
  return Pack{} + value;
}

// Functions of doubles stay visible beside those of Packs.
using std::cos;
using std::exp;
using std::sin;
using std::sqrt;

/// Lane by lane; NaN where p is negative.
[[gnu::always_inline]] inline Pack sqrt(const Pack& p) {
  Pack result;
  for (int lane = 0; lane < pack_size; ++lane) result[lane] = std::sqrt(p[lane]);
  return result;
}

/// 1/sqrt(p) for p > 0, to the last bit or two; with AVX-512 by Newton steps, since the divider is the
/// bottleneck of a quadrature point.
[[gnu::always_inline]] inline Pack inverse_sqrt(const Pack& p) {
#if ESFEM_PACK_SIZE == 8 && defined(__AVX512F__)
  Pack y = _mm512_maskz_rsqrt14_pd(0xff, p);
  for (int step = 0; step < 2; ++step) y += 0.5 * y * (1.0 - p * y * y);
  return y;
#else
  return 1.0 / sqrt(p);
#endif
}

/// function(double) -> double lane by lane, for formulas that have no vector form (pow, tanh, ...).
template <class Function>
[[gnu::always_inline]] inline Pack apply(const Function& function, const Pack& p) {
  Pack result;
  for (int lane = 0; lane < pack_size; ++lane) result[lane] = function(p[lane]);
  return result;
}

/// Lane by lane, by the functions of doubles.
/// @{
[[gnu::always_inline]] inline Pack exp(const Pack& p) {
  return apply([](double value) { return std::exp(value); }, p);
}
[[gnu::always_inline]] inline Pack sin(const Pack& p) {
  return apply([](double value) { return std::sin(value); }, p);
}
[[gnu::always_inline]] inline Pack cos(const Pack& p) {
  return apply([](double value) { return std::cos(value); }, p);
}
/// @}

/// Whether the lanes are all true.
inline bool all(const Lanes& lanes) {
  bool result = true;
  for (int lane = 0; lane < pack_size; ++lane) result &= lanes[lane] != 0;
  return result;
}

/// Sum over the lanes, in their order.
inline double sum_of_lanes(const Pack& p) {
  double sum = 0;
  for (int lane = 0; lane < pack_size; ++lane) sum += p[lane];
  return sum;
}

/// Euclidean product of vectors in space.
[[gnu::always_inline]] inline Pack dot(const Pack (&a)[3], const Pack (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// out = a x b; out must be neither of them.
inline void cross(const Pack (&a)[3], const Pack (&b)[3], Pack (&out)[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

}  // namespace esfem
