// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Prints "program: text" on standard error; nothing for an empty text.
void warn(const std::string& text);

/// read_mesh; changes by the reader are printed as a warning.
Mesh mesh_from_file(const std::string& file);

}  // namespace esfem
