// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "solver/formulas/formula.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// The surface that {"name": "ellipsoid", "axes": [1, 1, 0.6]} describes, or {"level_set": "..", "box": ..}
/// (formula_surface), which may use these names beside its own parameters; its own go first. Parameters that
/// are not given have the defaults of `named_surfaces_help`. Throws InputError for an unknown name or key
/// (listing the known ones) and for parameters that are no positive numbers or make no smooth surface.
Surface named_surface(const nlohmann::json& description, const FormulaNames& names = {});

/// {"sphere": {"radius": 1}, ..}: the parameters of each with their defaults.
nlohmann::json named_surface_defaults();

/// One line per surface: name, parameters, defaults.
std::string named_surfaces_help();

}  // namespace esfem
