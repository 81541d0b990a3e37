// SPDX-License-Identifier: GPL-3.0-or-later
// Options that several experiments add to those of every experiment (experiment.hpp).
#pragma once

#include <string>

#include "experiments/harness/command_line.hpp"
#include "solver/fe/quadrature.hpp"

namespace esfem {

/// Adds --quadrature.
void add_quadrature_option(CommandLine& line, std::string& rule);

/// The rule of --quadrature; when it is not given (""), that of elements of the degree.
Quadrature quadrature_or_default(const std::string& rule, int degree);

}  // namespace esfem
