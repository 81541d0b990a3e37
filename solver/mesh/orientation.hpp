// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "solver/mesh/mesh_file.hpp"

namespace esfem {

/// Gives a surface without boundary, of one or several components, its outward orientation; `twin` is
/// `side_twins` of its elements. Within a component the elements follow the orientation of most of them. Then
/// a component that lies in no other is turned outward, and those inside it are turned with it: a cavity
/// keeps its orientation relative to the body around it, as the file has it. Returns the remark on what was
/// turned, "" when nothing was. Throws InputError for a surface that is not orientable and for a component
/// without volume (|V| <= 1e-10 A^1.5).
std::string orient(Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin);

}  // namespace esfem
