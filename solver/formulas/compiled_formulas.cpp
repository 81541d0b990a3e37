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

/// An expression: sign times the number in a slot. Neither the slot's number nor the key, a hash, depends on
/// where GiNaC has put signs, or on the order in which it keeps terms: both are others in each process.
struct Value {
  int slot;
  int sign;
  std::uint64_t key;
};

/// Translates expressions of GiNaC to operations on slots. Until all constants are known, their slots have
/// the numbers -1, -2, .., and those of variables and results of operations 0, 1, ..
class Compiler {
 public:
  explicit Compiler(int variables) : variables_(variables) {}

  int compile(const FormulaTree& tree) {
    tree_ = &tree;
    known_.clear();
    return with_sign(value_of(tree.expression));
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

  int slot_of(double value) {
    const auto [entry, is_new] = slot_of_constant_.emplace(bits(value), -1 - int(constants_.size()));
    if (is_new) constants_.push_back(value);
    return entry->second;
  }
  Value constant(double value) {
    const double size = std::abs(value);
    return {slot_of(size), value < 0 ? -1 : 1, mix(1, bits(size))};
  }

  Value symbol(const GiNaC::ex& e) {
    for (std::size_t i = 0; i < tree_->variables.size(); ++i)
      if (tree_->variables[i].is_equal(e)) return {int(i), 1, mix(2, i)};
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
      return slot_of(result);
    }
    const auto [entry, is_new] =
        slot_of_operation_.emplace(std::tuple(operation.code, operation.a, operation.b, operation.called),
                                   variables_ + int(operations_.size()));
    if (is_new) operations_.push_back(operation);
    return entry->second;
  }
  int emit(Operation::Code code, int a, int b) { return emit({code, a, b, nullptr}); }
  int with_sign(const Value& value) {
    return value.sign > 0 ? value.slot : emit(Operation::negate, value.slot, value.slot);
  }

  struct Term {
    Value value;
    double factor;
  };

  /// The first term, in the order of the keys, has the sign of the sum.
  Value sum(const GiNaC::ex& e) {
    std::vector<Term> terms;
    for (const GiNaC::ex& term : e) terms.push_back(term_of(term));
    std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
      return std::pair(a.value.key, a.factor) < std::pair(b.value.key, b.factor);
    });
    const int sign = terms[0].value.sign;
    std::uint64_t key = 3;
    std::optional<int> result;
    for (const Term& term : terms) {
      const bool is_added = term.value.sign == sign;
      key = mix(mix(key, term.value.key), bits(is_added ? term.factor : -term.factor));
      int slot = term.value.slot;
      if (term.factor != 1) slot = emit(Operation::multiply, slot_of(term.factor), slot);
      result = result ? emit(is_added ? Operation::add : Operation::subtract, *result, slot) : slot;
    }
    return {*result, sign, key};
  }

  /// A term, and the positive number by which GiNaC multiplies it.
  Term term_of(const GiNaC::ex& e) {
    if (!GiNaC::is_a<GiNaC::mul>(e)) return {value_of(e), 1};
    double factor = 1;
    GiNaC::ex rest = e;
    for (const GiNaC::ex& operand : e)
      if (GiNaC::is_a<GiNaC::numeric>(operand)) {
        factor = real(operand);
        rest = e / operand;
      }
    Value value = value_of(rest);
    if (factor < 0) value.sign = -value.sign;
    return {value, std::abs(factor)};
  }

  Value product(const GiNaC::ex& e) {
    std::vector<Value> above, below;
    double number = 1;
    const auto add_factor = [&](const GiNaC::ex& factor) {
      if (GiNaC::is_a<GiNaC::numeric>(factor)) {
        number *= real(factor);
      } else if (!GiNaC::is_a<GiNaC::power>(factor)) {
        above.push_back(value_of(factor));
      } else if (const GiNaC::ex& exponent = factor.op(1); GiNaC::is_a<GiNaC::numeric>(exponent)) {
        const double r = real(exponent);
        (r < 0 ? below : above).push_back(numeric_power(factor.op(0), std::abs(r)));
      } else {
        const Value a = value_of(factor.op(0)), b = value_of(exponent);
        above.push_back({power(with_sign(a), with_sign(b)), 1,
                         mix(mix(mix(4, a.key), b.key), std::uint64_t(2 * a.sign + b.sign))});
      }
    };
    if (GiNaC::is_a<GiNaC::mul>(e))
      for (const GiNaC::ex& factor : e) add_factor(factor);
    else
      add_factor(e);
    int sign = number < 0 ? -1 : 1;
    const double size = std::abs(number);
    std::uint64_t key = mix(5, bits(size));
    const auto multiply = [&](std::vector<Value>& factors, std::optional<int> result) {
      std::sort(factors.begin(), factors.end(), [](const Value& a, const Value& b) { return a.key < b.key; });
      for (const Value& factor : factors) {
        key = mix(key, factor.key);
        sign *= factor.sign;
        result = result ? emit(Operation::multiply, *result, factor.slot) : factor.slot;
      }
      return result;
    };
    std::optional<int> numerator;
    if (size != 1 || above.empty()) numerator = slot_of(size);
    numerator = multiply(above, numerator);
    key = mix(key, 6);
    const std::optional<int> denominator = multiply(below, {});
    return {denominator ? emit(Operation::divide, *numerator, *denominator) : *numerator, sign, key};
  }

  /// base^r, r > 0: products and a square root where r is a small multiple of 1/2.
  Value numeric_power(const GiNaC::ex& base, double r) {
    const Value b = value_of(base);
    const double whole = std::floor(r);
    const bool is_integer = r == whole;
    const std::uint64_t key = mix(mix(mix(7, b.key), bits(r)), is_integer || b.sign > 0 ? 1 : 0);
    const int sign = is_integer && std::fmod(r, 2) == 1 ? b.sign : 1, a = is_integer ? b.slot : with_sign(b);
    if ((!is_integer && r != whole + 0.5) || whole > 64) return {power(a, slot_of(r)), sign, key};
    std::optional<int> result;
    int square = a;
    for (int n = int(whole); n > 0; n /= 2) {
      if (n % 2 == 1) result = result ? emit(Operation::multiply, *result, square) : square;
      if (n > 1) square = emit(Operation::multiply, square, square);
    }
    if (!is_integer) {
      const int root = emit(Operation::square_root, a, a);
      result = result ? emit(Operation::multiply, *result, root) : root;
    }
    return {*result, sign, key};
  }

  int power(int base, int exponent) {
    static const FormulaFunction function = {"pow", "", nullptr, std::pow};
    return emit({Operation::function, base, exponent, &function});
  }

  Value call_of(const GiNaC::function& call) {
    const FormulaFunction& function = formula_function(call);
    const Value a = value_of(call.op(0)), b = call.nops() > 1 ? value_of(call.op(1)) : a;
    std::uint64_t key = std::accumulate(function.name.begin(), function.name.end(), std::uint64_t(8), mix);
    key = mix(mix(key, a.key), b.key);
    if (function.parity != FormulaFunction::neither)
      return {emit({Operation::function, a.slot, a.slot, &function}),
              function.parity == FormulaFunction::odd ? a.sign : 1, key};
    return {emit({Operation::function, with_sign(a), with_sign(b), &function}), 1,
            mix(key, std::uint64_t(2 * a.sign + b.sign))};
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
