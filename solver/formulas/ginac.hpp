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
  FormulaNames names;                                 ///< that the formula was read with
  GiNaC::ex expression;                               ///< with the definitions put in
  std::vector<GiNaC::ex> variables;                   ///< symbols, in the order of names.variables
  std::vector<std::pair<GiNaC::ex, double>> numbers;  ///< symbols and what they stand for
};

/// A function of one argument or of two, or diff.
struct FormulaFunction {
  std::string name;                              ///< in formulas
  std::string of_ginac;                          ///< for GiNaC, whose abs, sign and step are complex
  double (*of_one)(double);                      ///< its value; nullptr unless it has one argument
  double (*of_two)(double, double);              ///< its value; nullptr unless it has two
  enum { neither, odd, even } parity = neither;  ///< f(-a) = -f(a) or f(a): signs are taken out of it
};

/// nullptr: there is no such function.
const FormulaFunction* formula_function(const std::string& name);
/// That of GiNaC. Throws InputError for one that formulas do not have.
const FormulaFunction& formula_function(const GiNaC::function& function);

/// Of all functions that formulas have, diff included.
std::vector<std::string> formula_function_names();

/// The functions of formulas for GiNaC's parser.
const GiNaC::prototype_table& formula_prototypes();

}  // namespace esfem
