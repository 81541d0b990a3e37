// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace esfem {

/// Writes via a temporary name in the same folder and a rename, so that no reader ever sees half a file.
/// "-" is standard output; devices and pipes are written directly. InputError when it cannot be written.
void write_file(const std::string& file, const std::string& text);

}  // namespace esfem
