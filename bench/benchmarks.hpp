// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// bench_factor.cpp: one factorisation and its solves beside those of other libraries.
void register_factor_benchmarks();

}  // namespace esfem
