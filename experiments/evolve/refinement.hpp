// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace esfem {

/// The configuration with its mesh refined `level` times and its steps halved `step` times.
///
/// Each level halves the edge length: of a generated mesh edge_length and grading, subdivisions + 1, of a
/// mesh file the edge length of "remesh", or "refine" + 1. tau is halved and steps are doubled, and so is
/// "every", which thus selects the same times. Throws InputError, headed by `source`, where this cannot be
/// done: a mesh file without "remesh" and "refine", "initial" with a file, adaptive steps.
nlohmann::json refined_configuration(nlohmann::json configuration, int level, int step,
                                     const std::string& source);

}  // namespace esfem
