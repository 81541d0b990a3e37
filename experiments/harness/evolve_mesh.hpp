// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/analysis/json_reader.hpp"
#include "solver/mesh/read.hpp"

namespace esfem {

/// The initial mesh of degree k that "mesh" of a configuration describes, on the surface where one is given;
/// what was changed in a file, and its nodal values at the nodes of this mesh. Throws InputError, which names
/// the key or the file.
ReadMesh evolve_mesh(const JsonReader& description, int degree, const std::optional<Surface>& surface);

}  // namespace esfem
