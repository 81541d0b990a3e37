// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "solver/mesh/read.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {

struct EvolveMesh {
  ReadMesh start;  ///< of degree k, on the surface where there is one; nodal values at its nodes
  std::vector<std::string> remarks;  ///< changes, choices and their consequences
};

/// All keys of "mesh".
std::set<std::string> mesh_keys();

/// Throws InputError for the keys of "mesh" that evolve_mesh does not take; has_surface: beside "surface".
void check_mesh_keys(const JsonReader& description, bool has_surface);

/// The initial mesh that "mesh" of a configuration describes: generated, or read, remeshed, curved and
/// refined. Where
/// no degree is given it is 2; for a file without a surface that of its elements, 1 when they are flat and
/// are not to be curved. Throws InputError, which names the key or the file.
EvolveMesh evolve_mesh(const JsonReader& description, std::optional<int> degree,
                       const std::optional<Surface>& surface);

}  // namespace esfem
