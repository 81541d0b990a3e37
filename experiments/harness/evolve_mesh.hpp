// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <tuple>

#include "solver/analysis/json_reader.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem {

/// The initial mesh of degree k that "mesh" of a configuration describes, on the surface where one is given;
/// and what was changed in a file, "" for nothing. Throws InputError, which names the key or the file.
std::tuple<Mesh, std::string> evolve_mesh(const JsonReader& description, int degree,
                                          const std::optional<Surface>& surface);

}  // namespace esfem
