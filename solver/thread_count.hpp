// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// Threads that a factorisation may use: 1 unless a program has set it. Results do not depend on it.
int thread_count();

/// For factors that are made from now on; called once, when a program starts. Throws InputError unless count
/// >= 1.
void set_thread_count(int count);

}  // namespace esfem
