// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// Forgets the peak so far, where the system permits it (Linux does): the next peak is that of what follows.
void reset_peak_memory();

/// Largest resident memory of the process in MB (1024^2 bytes) since the last reset.
double peak_memory_mb();

}  // namespace esfem
