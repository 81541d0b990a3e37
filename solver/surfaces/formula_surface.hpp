// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "solver/surfaces/surface.hpp"

namespace esfem {

/// A box with sides along the axes.
struct Box {
  Vec3 low;   ///< corner with the smallest coordinates
  Vec3 high;  ///< corner with the largest
};

/// The surface {d = 0} in a box, for a formula d(x, y, z) with d < 0 inside, of constants and definitions.
/// Derivatives up to the fourth are
/// symbolic. Bounding ball, Euler characteristic and the smallest radius of curvature are found on a grid: on
/// one so fine that a finer one has the same topology, and for the radius by a search on the surface from the
/// grid's best points. Throws InputError, headed by `where`, for a formula that cannot be read or has no
/// finite value in the box, when d has no zero in the box or the surface leaves it, when it has edges or
/// crosses itself, or is too fine for the grid.
Surface formula_surface(const std::string& level_set, const Box& box,
                        const std::map<std::string, double>& constants = {},
                        const std::string& where = "level set",
                        const std::map<std::string, std::string>& definitions = {});

}  // namespace esfem
