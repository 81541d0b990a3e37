// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "experiments/evolve/config.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {

/// Moves a mesh without exact surface and formulas to where its coordinates keep their digits, and finds the
/// origins of the configuration.
void move_near_origin(EvolveConfig& config);

/// Defaults with units hold for a surface with length 1. For one with length L (characteristic_length) they
/// are multiplied by powers of L, times by those of its time scale: L², L⁴ for flows of fourth order, L³ for
/// the separation of phases. The first of adaptive steps is also at most a tenth of the run. reader: the
/// whole configuration. Throws InputError where the adaptive grid is not one.
void scale_defaults(const JsonReader& reader, EvolveConfig& config);

}  // namespace esfem
