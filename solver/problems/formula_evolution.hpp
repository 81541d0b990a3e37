// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "solver/formulas/formula.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

/// The surface {d = 0} at a time, for a formula d(x, y, z, t) with d < 0 inside: its closest points, normals
/// and Weingarten maps near it. Its topology and its smallest radius of curvature are not looked for. size:
/// of the surface, to which tolerances are relative.
std::function<Surface(double t)> formula_level_set(const Formula& d, double size);

/// ExactEvolution::fields of quantities that are formulas in x, y, z, t, one for each component; the position
/// for a quantity x, whatever its formulas. Gradients are the tangential parts of those in space.
std::function<void(double t, const SurfacePoints& at, FieldsAtPoints& out)> formula_fields(
    const std::vector<std::pair<ExactEvolution::Quantity, std::vector<Formula>>>& quantities);

}  // namespace esfem
