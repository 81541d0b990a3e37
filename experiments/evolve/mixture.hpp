// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "experiments/evolve/config.hpp"
#include "solver/problems/formula_data.hpp"

namespace esfem {

/// The mixture of problem "mixture": its potential and its source. Throws InputError for bad formulas.
FormulaMixture mixture_of(const EvolveConfig& config);

}  // namespace esfem
