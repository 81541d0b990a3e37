// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

namespace esfem {

/// Writes via a temporary name in the same folder and a rename, when the data are on the disk, so that no
/// reader ever sees half a file and a failure leaves an older file unchanged; a link to a file stays one. "-"
/// is standard output; devices and pipes are written directly. InputError when it cannot be written.
void write_file(const std::string& file, const std::string& text);

/// Makes sure, before anything is computed for it, that write_file will be able to write here: creates
/// missing folders, and removes half-written files of write_file in processes that have ended. An existing
/// file is left unchanged. InputError, which says why, for a folder, a file that is write-protected, or a
/// place where none can be made.
void prepare_output(const std::string& file);

/// Removes from a folder ("": the working folder) the half-written versions of those files (names without
/// folder) that write_file of ended processes has left.
void remove_abandoned(const std::string& folder, const std::function<bool(const std::string& file)>& is_ours);

}  // namespace esfem
