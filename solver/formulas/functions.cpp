// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "solver/error.hpp"
#include "solver/formulas/ginac.hpp"

namespace esfem {
namespace {

// Real functions with kinks and jumps, for GiNaC.
DECLARE_FUNCTION_1P(formula_abs)
DECLARE_FUNCTION_1P(formula_sign)
DECLARE_FUNCTION_1P(formula_step)
DECLARE_FUNCTION_2P(formula_min)
DECLARE_FUNCTION_2P(formula_max)

using GiNaC::ex;

ex zero_slope(const ex&, unsigned) {
  return 0;
}
ex slope_of_abs(const ex& a, unsigned) {
  return formula_sign(a);
}
ex slope_of_min(const ex& a, const ex& b, unsigned argument) {
  return argument == 0 ? formula_step(b - a) : 1 - formula_step(b - a);
}
ex slope_of_max(const ex& a, const ex& b, unsigned argument) {
  return argument == 0 ? formula_step(a - b) : 1 - formula_step(a - b);
}

REGISTER_FUNCTION(formula_abs, derivative_func(slope_of_abs))
REGISTER_FUNCTION(formula_sign, derivative_func(zero_slope))
REGISTER_FUNCTION(formula_step, derivative_func(zero_slope))
REGISTER_FUNCTION(formula_min, derivative_func(slope_of_min))
REGISTER_FUNCTION(formula_max, derivative_func(slope_of_max))

/// diff(f, x). Numbers are symbols, too.
ex differentiated(const GiNaC::exvector& arguments) {
  const ex& x = arguments[1];
  if (!GiNaC::is_a<GiNaC::symbol>(x) || GiNaC::ex_to<GiNaC::symbol>(x).get_name().substr(0, 2) == "c_")
    throw std::invalid_argument("no variable");
  return arguments[0].diff(GiNaC::ex_to<GiNaC::symbol>(x));
}

// Their values; that at NaN is NaN.
double sign(double a) {
  return a > 0 ? 1 : a < 0 ? -1 : a;
}
double step(double a) {
  return a >= 0 ? 1 : a < 0 ? 0 : a;
}
double smaller(double a, double b) {
  return a < b || a != a ? a : b;
}
double greater(double a, double b) {
  return a > b || a != a ? a : b;
}

const std::vector<FormulaFunction>& functions() {
  static const std::vector<FormulaFunction> list = {
      {"sqrt", "sqrt", std::sqrt, nullptr},
      {"exp", "exp", std::exp, nullptr},
      {"log", "log", std::log, nullptr},
      {"sin", "sin", std::sin, nullptr, FormulaFunction::odd},
      {"cos", "cos", std::cos, nullptr, FormulaFunction::even},
      {"tan", "tan", std::tan, nullptr, FormulaFunction::odd},
      {"asin", "asin", std::asin, nullptr, FormulaFunction::odd},
      {"acos", "acos", std::acos, nullptr},
      {"atan", "atan", std::atan, nullptr, FormulaFunction::odd},
      {"atan2", "atan2", nullptr, std::atan2},
      {"sinh", "sinh", std::sinh, nullptr, FormulaFunction::odd},
      {"cosh", "cosh", std::cosh, nullptr, FormulaFunction::even},
      {"tanh", "tanh", std::tanh, nullptr, FormulaFunction::odd},
      {"asinh", "asinh", std::asinh, nullptr, FormulaFunction::odd},
      {"acosh", "acosh", std::acosh, nullptr},
      {"atanh", "atanh", std::atanh, nullptr, FormulaFunction::odd},
      {"abs", "formula_abs", std::abs, nullptr, FormulaFunction::even},
      {"sign", "formula_sign", sign, nullptr, FormulaFunction::odd},
      {"step", "formula_step", step, nullptr},
      {"min", "formula_min", nullptr, smaller},
      {"max", "formula_max", nullptr, greater},
      {"diff", "formula_diff", nullptr, nullptr}};
  return list;
}

}  // namespace

std::string formula_functions() {
  std::string list;
  for (const FormulaFunction& function : functions()) list += (list.empty() ? "" : ", ") + function.name;
  return list;
}

std::vector<std::string> formula_function_names() {
  std::vector<std::string> names;
  for (const FormulaFunction& function : functions()) names.push_back(function.name);
  return names;
}

const FormulaFunction* formula_function(const std::string& name) {
  for (const FormulaFunction& function : functions())
    if (function.name == name) return &function;
  return nullptr;
}

const FormulaFunction& formula_function(const GiNaC::function& called) {
  for (const FormulaFunction& function : functions())
    if (function.of_ginac == called.get_name()) return function;
  throw InputError("the function " + called.get_name() + " cannot be evaluated");
}

const GiNaC::prototype_table& formula_prototypes() {
  static const GiNaC::prototype_table table = [] {
    GiNaC::prototype_table chosen;
    for (const auto& [prototype, reader] : GiNaC::get_default_reader())
      for (const FormulaFunction& function : functions())
        if (prototype.first == function.of_ginac && prototype.second == (function.of_one ? 1u : 2u))
          chosen.insert({prototype, reader});
    chosen[{"formula_diff", 2}] = differentiated;
    return chosen;
  }();
  return table;
}

}  // namespace esfem
