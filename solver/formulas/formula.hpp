// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "solver/pack.hpp"
#include "solver/types.hpp"

namespace esfem {

struct FormulaFunction;
struct FormulaTree;

/// "sin, cos, ..": the functions that a formula may use, for help texts and messages.
std::string formula_functions();

/// The names that formulas use: variables, in the order in which their values will be given, constants, and
/// parts of formulas that are formulas themselves.
struct FormulaNames {
  std::vector<std::string> variables;                   ///< in the order of their values
  std::map<std::string, double> constants = {};         ///< finite; pi is always known
  std::map<std::string, std::string> definitions = {};  ///< name -> text of a formula
};

/// A real function of variables, read from text such as "a - u + u^2*v". Operators + - * / ^, where a^b^c
/// needs parentheses; functions of formula_functions, diff(f, x) for a derivative; numbers, pi. GiNaC reads
/// and differentiates it.
class Formula {
 public:
  /// Throws InputError, headed by `where`, that names the column (from 1) of what cannot be read, and the
  /// known names; for text of more than longest_text characters, for names that are none or are taken, and
  /// for definitions in terms of themselves.
  Formula(const std::string& text, const FormulaNames& names, const std::string& where);

  /// With respect to a variable. abs, min, max, step and sign have the derivatives that they have off their
  /// kinks.
  Formula derivative(const std::string& variable) const;

  /// Whether a variable occurs in it, or in one of its definitions.
  bool depends_on(const std::string& variable) const;

  /// As it was read; that of a derivative is "d(TEXT)/dVARIABLE".
  const std::string& text() const { return text_; }
  /// For messages: what the formula is, and its text.
  std::string description() const { return where_ + ": \"" + text_ + "\""; }
  /// The names that it was read with, also those that do not occur in it.
  const FormulaNames& names() const;

  /// In characters, for the formula and for each definition.
  static constexpr int longest_text = 2000;

 private:
  friend class CompiledFormulas;

  std::string text_, where_;
  std::shared_ptr<const FormulaTree> tree_;
};

/// What is done with the numbers in slots a and b.
struct FormulaOperation {
  /// The operations of arithmetic, and calls of functions.
  enum Code { add, subtract, multiply, divide, negate, square_root, function } code;  ///< which one
  int a;                          ///< slot of the operand or of the first one
  int b;                          ///< slot of the second operand; of no meaning where there is one
  const FormulaFunction* called;  ///< by `function`
};

/// Formulas of the same names, prepared for evaluation: one list of operations without repetitions, each of
/// which is carried out for all elements of a Pack. The order of operations, and thus every bit, is the same
/// in each process. The work space is a member: one object is used by one thread at a time.
class CompiledFormulas {
 public:
  /// No formulas.
  CompiledFormulas() = default;
  /// Throws InputError when the formulas have different names.
  explicit CompiledFormulas(const std::vector<Formula>& formulas);

  /// The number of formulas, and of results.
  int count() const { return static_cast<int>(results_.size()); }

  /// The values of all formulas; in: one value for each variable, out: one for each formula. Throws
  /// NumericsError, which names the formula and the values of the variables, where one is not finite.
  void evaluate(const double* in, double* out) const;
  /// The same for each lane.
  void evaluate(const Pack* in, Pack* out) const;
  /// The same row by row: points has a column for each variable.
  Field operator()(const Field& points) const;

 private:
  template <class T>
  void run(const T* in, T* out, std::vector<T>& slots) const;
  template <class T>
  [[noreturn]] void report(int formula, const T* in, const T& value) const;

  std::vector<std::string> descriptions_, variables_;
  std::vector<double> constants_;  ///< slots: constants, variables, results of the operations
  std::vector<FormulaOperation> operations_;
  std::vector<int> results_;             ///< slots of the formulas' values
  mutable std::vector<double> doubles_;  ///< slots
  mutable std::vector<Pack> packs_;
};

}  // namespace esfem
