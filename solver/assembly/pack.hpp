// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// Eight doubles, one per element of a batch: arithmetic on a Pack is arithmetic on eight elements at once,
/// which the compiler turns into one AVX-512, two AVX2 or four SSE2 instructions.
using Pack = double __attribute__((vector_size(64)));
constexpr int pack_size = 8;

}  // namespace esfem
