// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

namespace esfem {

/// Writes via a temporary name in the same folder and a rename, when the data are on the disk, so that no
/// reader ever sees half a file and a failure leaves an older file as it is; a link to a file stays one. "-"
/// is standard output; devices and pipes are written directly. InputError when it cannot be written.
void write_file(const std::string& file, const std::string& text);

/// Makes sure, before anything is computed for it, that write_file will be able to write here: makes the
/// folders that are missing, and removes what write_file of a process that is gone has left half written. A
/// file that is there stays as it is. InputError, which says why, for a folder, a file that is
/// write-protected, or a place where none can be made.
void prepare_output(const std::string& file);

/// Removes from a folder ("": the working folder) what write_file of processes that run no more has left half
/// written of those files (names without folder).
void remove_abandoned(const std::string& folder, const std::function<bool(const std::string& file)>& is_ours);

}  // namespace esfem
