// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of this folder share, in terms of GiNaC.
#pragma once

#include <ginac/ginac.h>

#include <string>
#include <utility>
#include <vector>

#include "solver/formulas/formula.hpp"

namespace esfem {

/// What GiNaC has read, over its symbols for the variables and for every number outside exponents: numbers
/// stay as they are written, and are computed with in double precision.
struct FormulaTree {
  FormulaNames names;
  GiNaC::ex expression;
  std::vector<GiNaC::ex> variables;
  std::vector<std::pair<GiNaC::ex, double>> numbers;
};

/// A function of one argument or of two, or diff.
struct FormulaFunction {
  std::string name, of_ginac;  ///< in formulas, and for GiNaC, whose abs, sign and step are complex
  double (*of_one)(double);
  double (*of_two)(double, double);
  enum { neither, odd, even } parity = neither;
};

/// nullptr: there is no such function.
const FormulaFunction* formula_function(const std::string& name);
/// That of GiNaC. Throws InputError for one that formulas do not have.
const FormulaFunction& formula_function(const GiNaC::function& function);

std::vector<std::string> formula_function_names();

/// The functions of formulas for GiNaC's parser.
const GiNaC::prototype_table& formula_prototypes();

}  // namespace esfem
