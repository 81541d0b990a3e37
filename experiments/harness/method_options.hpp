// SPDX-License-Identifier: GPL-3.0-or-later
// Options that several experiments add to those of every experiment (experiment.hpp).
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "solver/fe/quadrature.hpp"

namespace esfem {

/// The group of --help that says how a run is discretised.
extern const char* const method_group;

/// Adds an option that takes a list of some of the known names, such as --flow a,b.
void add_names_option(CLI::App& app, const std::string& option, const std::vector<std::string>& known,
                      const std::string& help, std::vector<std::string>& names);

/// The check of an option that takes a positive number (CLI11's own prints 300 digits).
CLI::Validator positive_number();

/// Adds --quadrature.
void add_quadrature_option(CLI::App& app, std::string& rule);

/// The rule of --quadrature; when it is not given (""), that of elements of the degree.
Quadrature quadrature_or_default(const std::string& rule, int degree);

}  // namespace esfem
