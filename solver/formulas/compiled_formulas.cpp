// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <tuple>

#include "solver/error.hpp"
#include "solver/formulas/ginac.hpp"

namespace esfem {
namespace {

using Operation = FormulaOperation;

double call(const FormulaFunction& function, double a, double b) {
  return function.of_one ? function.of_one(a) : function.of_two(a, b);
}
Pack call(const FormulaFunction& function, const Pack& a, const Pack& b) {
  Pack result;
  for (int lane = 0; lane < pack_size; ++lane) result[lane] = call(function, a[lane], b[lane]);
  return result;
}

template <class T>
[[gnu::always_inline]] inline void carry_out(const Operation& operation, const T& a, const T& b, T& out) {
  switch (operation.code) {
  case Operation::add:
    out = a + b;
    break;
  case Operation::subtract:
    out = a - b;
    break;
  case Operation::multiply:
    out = a * b;
    break;
  case Operation::divide:
    out = a / b;
    break;
  case Operation::negate:
    out = -a;
    break;
  case Operation::square_root:
    out = sqrt(a);
    break;
  case Operation::function:
    out = call(*operation.called, a, b);
    break;
  }
}

/// Hashes of an expression that are the same in every process, unlike the order in which GiNaC keeps terms.
/// `even` does not change with the sign of the expression, which GiNaC may draw out of powers.
struct Key {
  std::uint64_t even, signed_too;
  bool operator<(const Key& other) const {
    return std::tie(even, signed_too) < std::tie(other.even, other.signed_too);
  }
};

std::uint64_t mix(std::uint64_t seed, std::uint64_t value) {
  seed ^= value + 0x9e3779b97f4a7c15 + (seed << 6) + (seed >> 2);
  seed ^= seed >> 33;
  seed *= 0xff51afd7ed558ccd;
  return seed ^ (seed >> 33);
}

std::uint64_t bits(double value) {
  std::uint64_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

Key key_of(double value) {
  return {mix(1, bits(std::abs(value))), mix(1, bits(value))};
}

struct Value {
  int slot;
  Key key;
};

/// Translates expressions of GiNaC to operations on slots. Until all constants are known, their slots have
/// the numbers -1, -2, .., and those of variables and results of operations 0, 1, ..
class Compiler {
 public:
  explicit Compiler(int variables) : variables_(variables) {}

  int compile(const FormulaTree& tree) {
    tree_ = &tree;
    known_.clear();
    return value_of(tree.expression).slot;
  }

  const std::vector<double>& constants() const { return constants_; }
  const std::vector<Operation>& operations() const { return operations_; }

 private:
  Value value_of(const GiNaC::ex& e) {
    if (const auto found = known_.find(e); found != known_.end()) return found->second;
    const Value value = compute(e);
    known_.emplace(e, value);
    return value;
  }

  Value compute(const GiNaC::ex& e) {
    if (GiNaC::is_a<GiNaC::numeric>(e)) return constant(real(e));
    if (GiNaC::is_a<GiNaC::symbol>(e)) return symbol(e);
    if (GiNaC::is_a<GiNaC::constant>(e)) return constant(real(e.evalf()));
    if (GiNaC::is_a<GiNaC::add>(e)) return sum(e);
    if (GiNaC::is_a<GiNaC::mul>(e) || GiNaC::is_a<GiNaC::power>(e)) return product(e);
    if (GiNaC::is_a<GiNaC::function>(e)) return call_of(GiNaC::ex_to<GiNaC::function>(e));
    std::ostringstream text;
    text << e;
    throw InputError(text.str() + " cannot be evaluated");
  }

  static double real(const GiNaC::ex& e) {
    const auto& number = GiNaC::ex_to<GiNaC::numeric>(e);
    const double value = number.is_real() ? number.to_double() : NAN;
    if (std::isfinite(value)) return value;
    throw InputError(number.is_real() ? "a number is too large"
                                      : "the value is complex; expected a real one");
  }

  Value constant(double value) {
    const auto [entry, is_new] = slot_of_constant_.emplace(bits(value), -1 - int(constants_.size()));
    if (is_new) constants_.push_back(value);
    return {entry->second, key_of(value)};
  }

  Value symbol(const GiNaC::ex& e) {
    for (std::size_t i = 0; i < tree_->variables.size(); ++i)
      if (tree_->variables[i].is_equal(e)) return {int(i), {mix(2, i), mix(2, i)}};
    for (const auto& [number, value] : tree_->numbers)
      if (number.is_equal(e)) return constant(value);
    throw InputError("unknown symbol");
  }

  std::optional<double> constant_in(int slot) const {
    if (slot >= 0) return {};
    return constants_[-1 - slot];
  }

  /// The slot of an operation's result, which is computed once, or now where the operands are constants.
  int emit(Operation operation) {
    const auto a = constant_in(operation.a), b = constant_in(operation.b);
    if (a && b) {
      double result = 0;
      carry_out<double>(operation, *a, *b, result);
      if (!std::isfinite(result)) throw InputError("a part without variables is not finite");
      return constant(result).slot;
    }
    const auto [entry, is_new] =
        slot_of_operation_.emplace(std::tuple(operation.code, operation.a, operation.b, operation.called),
                                   variables_ + int(operations_.size()));
    if (is_new) operations_.push_back(operation);
    return entry->second;
  }
  int emit(Operation::Code code, int a, int b) { return emit({code, a, b, nullptr}); }
  int negated(int a) { return emit(Operation::negate, a, a); }

  struct Term {
    Value value;
    double factor;
  };

  static void order(std::vector<Term>& terms) {
    std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
      const std::uint64_t f = bits(std::abs(a.factor)), g = bits(std::abs(b.factor));
      return std::tie(a.value.key, f) < std::tie(b.value.key, g);
    });
  }

  /// Terms in the order of their keys. The sign of the key's even part is that of the first term.
  Value sum(const GiNaC::ex& e) {
    std::vector<Term> terms;
    for (const GiNaC::ex& term : e) terms.push_back(term_of(term));
    order(terms);
    Key key = {3, 3};
    int result = 0;
    bool is_first = true;
    for (const Term& term : terms) {
      const bool is_negative = term.factor < 0;
      key.even =
          mix(mix(key.even, term.value.key.even),
              bits(is_negative == (terms[0].factor < 0) ? std::abs(term.factor) : -std::abs(term.factor)));
      key.signed_too = mix(mix(key.signed_too, term.value.key.signed_too), bits(term.factor));
      int slot = term.value.slot;
      if (std::abs(term.factor) != 1)
        slot = emit(Operation::multiply, constant(std::abs(term.factor)).slot, slot);
      if (is_first)
        result = is_negative ? negated(slot) : slot;
      else
        result = emit(is_negative ? Operation::subtract : Operation::add, result, slot);
      is_first = false;
    }
    return {result, key};
  }

  /// A term and the number by which GiNaC multiplies it.
  Term term_of(const GiNaC::ex& e) {
    if (GiNaC::is_a<GiNaC::numeric>(e)) {
      const double value = real(e);
      return {constant(std::abs(value)), value < 0 ? -1.0 : 1.0};
    }
    if (!GiNaC::is_a<GiNaC::mul>(e)) return {value_of(e), 1};
    double factor = 1;
    GiNaC::ex rest = e;
    for (const GiNaC::ex& operand : e)
      if (GiNaC::is_a<GiNaC::numeric>(operand)) {
        factor = real(operand);
        rest = e / operand;
      }
    return {value_of(rest), factor};
  }

  Value product(const GiNaC::ex& e) {
    std::vector<Term> above, below;  // `factor` tells powers of one base apart
    double number = 1;
    const auto add_factor = [&](const GiNaC::ex& factor) {
      if (GiNaC::is_a<GiNaC::numeric>(factor)) {
        number *= real(factor);
      } else if (GiNaC::is_a<GiNaC::power>(factor)) {
        const GiNaC::ex &base = factor.op(0), &exponent = factor.op(1);
        if (GiNaC::is_a<GiNaC::numeric>(exponent)) {
          const double r = real(exponent);
          (r < 0 ? below : above).push_back({numeric_power(base, std::abs(r)), 1});
        } else {
          const Value b = value_of(base), c = value_of(exponent);
          const std::uint64_t key = mix(mix(4, b.key.signed_too), c.key.signed_too);
          above.push_back({{power(b.slot, c.slot), {key, key}}, 1});
        }
      } else {
        above.push_back({value_of(factor), 1});
      }
    };
    if (GiNaC::is_a<GiNaC::mul>(e))
      for (const GiNaC::ex& factor : e) add_factor(factor);
    else
      add_factor(e);
    order(above);
    order(below);
    Key key = {mix(5, bits(std::abs(number))), mix(5, bits(number))};
    const auto multiply = [&](std::vector<Term>& factors, std::optional<int> first) {
      for (const Term& factor : factors) {
        key = {mix(key.even, factor.value.key.even), mix(key.signed_too, factor.value.key.signed_too)};
        first = first ? emit(Operation::multiply, *first, factor.value.slot) : factor.value.slot;
      }
      return first;
    };
    const double size = std::abs(number);
    std::optional<int> numerator;
    if (size != 1 || above.empty()) numerator = constant(size).slot;
    numerator = multiply(above, numerator);
    key = {mix(key.even, 6), mix(key.signed_too, 6)};
    const std::optional<int> denominator = multiply(below, {});
    int result = denominator ? emit(Operation::divide, *numerator, *denominator) : *numerator;
    if (number < 0) result = negated(result);
    return {result, key};
  }

  /// base^r, r > 0: products and a square root where r is a small multiple of 1/2.
  Value numeric_power(const GiNaC::ex& base, double r) {
    const Value b = value_of(base);
    const bool is_even = r == std::floor(r) && std::fmod(r, 2) == 0;
    const Key key = {mix(mix(7, b.key.even), bits(r)),
                     mix(mix(7, is_even ? b.key.even : b.key.signed_too), bits(r))};
    const double whole = std::floor(r);
    if ((r != whole && r != whole + 0.5) || whole > 64) return {power(b.slot, constant(r).slot), key};
    std::optional<int> result;
    int square = b.slot;
    for (int n = int(whole); n > 0; n /= 2) {
      if (n % 2 == 1) result = result ? emit(Operation::multiply, *result, square) : square;
      if (n > 1) square = emit(Operation::multiply, square, square);
    }
    if (r != whole) {
      const int root = emit(Operation::square_root, b.slot, b.slot);
      result = result ? emit(Operation::multiply, *result, root) : root;
    }
    return {*result, key};
  }

  int power(int base, int exponent) {
    static const FormulaFunction function = {"pow", "", nullptr, std::pow};
    return emit({Operation::function, base, exponent, &function});
  }

  Value call_of(const GiNaC::function& call) {
    const FormulaFunction& function = formula_function(call);
    const Value a = value_of(call.op(0)), b = call.nops() > 1 ? value_of(call.op(1)) : a;
    const std::uint64_t name =
        std::accumulate(function.name.begin(), function.name.end(), std::uint64_t(8), mix);
    return {emit({Operation::function, a.slot, b.slot, &function}),
            {mix(mix(name, a.key.even), b.key.even), mix(mix(name, a.key.signed_too), b.key.signed_too)}};
  }

  int variables_;
  const FormulaTree* tree_ = nullptr;
  std::map<GiNaC::ex, Value, GiNaC::ex_is_less> known_;
  std::vector<double> constants_;
  std::map<std::uint64_t, int> slot_of_constant_;
  std::vector<Operation> operations_;
  std::map<std::tuple<Operation::Code, int, int, const FormulaFunction*>, int> slot_of_operation_;
};

bool are_finite(double value) {
  return std::isfinite(value);
}
bool are_finite(const Pack& value) {
  return all(value - value == 0.0);
}

double lane_of(double value, int) {
  return value;
}
double lane_of(const Pack& value, int lane) {
  return value[lane];
}

}  // namespace

CompiledFormulas::CompiledFormulas(const std::vector<Formula>& formulas) {
  if (formulas.empty()) return;
  variables_ = formulas[0].names().variables;
  Compiler compiler(int(variables_.size()));
  for (const Formula& formula : formulas) {
    if (formula.names().variables != variables_)
      throw InputError("formulas of different variables: \"" + formulas[0].text() + "\" and \"" +
                       formula.text() + "\"");
    descriptions_.push_back(formula.description());
    try {
      results_.push_back(compiler.compile(*formula.tree_));
    } catch (const InputError& error) {
      throw InputError(formula.description() + ": " + error.what());
    }
  }
  constants_ = compiler.constants();
  operations_ = compiler.operations();
  const int constants = int(constants_.size());
  const auto place = [constants](int& slot) { slot = slot < 0 ? -1 - slot : slot + constants; };
  for (Operation& operation : operations_) {
    place(operation.a);
    place(operation.b);
  }
  for (int& slot : results_) place(slot);
}

template <class T>
void CompiledFormulas::run(const T* in, T* out, std::vector<T>& slots) const {
  if (slots.empty()) {
    slots.resize(constants_.size() + variables_.size() + operations_.size());
    for (std::size_t i = 0; i < constants_.size(); ++i) slots[i] = T{} + constants_[i];
  }
  T* next = slots.data() + constants_.size();
  for (std::size_t i = 0; i < variables_.size(); ++i) *next++ = in[i];
  for (const Operation& operation : operations_) {
    carry_out(operation, slots[operation.a], slots[operation.b], *next);
    ++next;
  }
  for (int i = 0; i < count(); ++i) {
    out[i] = slots[results_[i]];
    if (!are_finite(out[i])) report(i, in, out[i]);
  }
}

template <class T>
void CompiledFormulas::report(int formula, const T* in, const T& value) const {
  int lane = 0;
  while (std::isfinite(lane_of(value, lane))) ++lane;
  std::string at;
  for (std::size_t i = 0; i < variables_.size(); ++i)
    at += (i == 0 ? "" : ", ") + variables_[i] + format(" = %.17g", lane_of(in[i], lane));
  const double number = lane_of(value, lane);
  throw NumericsError(descriptions_[formula] + (std::isnan(number) ? " is nan" : " is infinite") + " at " +
                      at);
}

void CompiledFormulas::evaluate(const double* in, double* out) const {
  run(in, out, doubles_);
}

void CompiledFormulas::evaluate(const Pack* in, Pack* out) const {
  run(in, out, packs_);
}

Field CompiledFormulas::operator()(const Field& points) const {
  if (points.cols() != Eigen::Index(variables_.size()))
    throw InputError(
        format("formulas of %zu variables at points with %td values", variables_.size(), points.cols()));
  Field values(points.rows(), count());
  std::vector<Pack> in(variables_.size()), out(count());
  for (Eigen::Index first = 0; first < points.rows(); first += pack_size) {
    // The last pack is filled up with the last point.
    for (std::size_t i = 0; i < in.size(); ++i)
      for (int lane = 0; lane < pack_size; ++lane)
        in[i][lane] = points(std::min(first + lane, points.rows() - 1), i);
    run(in.data(), out.data(), packs_);
    for (int l = 0; l < count(); ++l)
      for (int lane = 0; lane < pack_size && first + lane < points.rows(); ++lane)
        values(first + lane, l) = out[l][lane];
  }
  return values;
}

}  // namespace esfem
