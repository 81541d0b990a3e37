// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// From now on the first SIGINT or SIGTERM is only noted, which standard error says; the next one ends the
/// process at once. Signals that are ignored stay so.
void note_stop_signals();

/// The signal that has been noted; 0: none.
int stop_signal();

}  // namespace esfem
