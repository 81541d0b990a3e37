// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace esfem {

/// bench_factor.cpp: one factorisation and its solves beside those of other libraries.
void register_factor_benchmarks();

/// peer_step.cpp: a step of kll19 (5.1), its data, its solution and the least ms that it took, for another
/// program to do the same.
void write_peer_step(const std::string& file);

}  // namespace esfem
