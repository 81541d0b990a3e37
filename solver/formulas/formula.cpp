// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/formulas/formula.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <locale>
#include <regex>
#include <set>
#include <sstream>

#include "solver/constants.hpp"
#include "solver/did_you_mean.hpp"
#include "solver/error.hpp"
#include "solver/formulas/ginac.hpp"

namespace esfem {

const FormulaNames& Formula::names() const {
  return tree_->names;
}

namespace {

bool starts_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool continues_name(char c) {
  return starts_name(c) || std::isdigit(static_cast<unsigned char>(c));
}
bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c));
}

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

void check_names(const FormulaNames& names, const std::string& where) {
  std::vector<std::string> all = names.variables;
  for (const auto& [name, value] : names.constants) {
    all.push_back(name);
    if (!std::isfinite(value)) throw InputError(where + ": " + name + " is not finite; expected a number");
  }
  for (const auto& [name, text] : names.definitions) all.push_back(name);
  std::set<std::string> seen = {"pi"};
  for (const std::string& name : all) {
    const bool is_name =
        !name.empty() && starts_name(name[0]) && std::all_of(name.begin(), name.end(), continues_name);
    if (!is_name)
      throw InputError(where + ": found the name \"" + name + "\"; expected letters, digits and _");
    if (formula_function(name) || !seen.insert(name).second)
      throw InputError(where + ": the name \"" + name + "\" is taken; expected another one");
  }
}

/// The text in GiNaC's language: without blanks, with a symbol for each variable and each number but those in
/// exponents, which differentiation must see.
class Translation {
 public:
  Translation(const std::string& text, const FormulaNames& names, const std::string& where)
      : text_(text), names_(names), where_(where) {
    while (skip_blanks(), at_ < text_.size()) translate_token();
  }

  const std::string& result() const { return result_; }
  /// Numbers by the names of their symbols.
  const std::map<std::string, double>& numbers() const { return numbers_; }
  /// The definitions that it names, with the column of each.
  const std::map<std::string, std::size_t>& definitions() const { return definitions_; }
  /// Column, from 1, of a character of the result; that behind the text's end for what is behind its own.
  std::size_t column(std::size_t place) const {
    return place < columns_.size() ? columns_[place] : text_.size() + 1;
  }
  /// The token of the text that begins in a column.
  std::string token(std::size_t column) const {
    if (column > text_.size()) return "the end";
    std::size_t end = column;
    if (continues_name(text_[column - 1]))
      while (end < text_.size() && continues_name(text_[end])) ++end;
    return "\"" + text_.substr(column - 1, end - column + 1) + "\"";
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw InputError(where_ + ": \"" + text_ + "\": column " + std::to_string(column) + ": " + what);
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  void translate_token() {
    const char c = text_[at_];
    if (starts_name(c))
      translate_name();
    else if (is_digit(c) || c == '.')
      translate_number();
    else if (std::strchr("+-*/^(),", c))
      translate_sign(c);
    else
      fail(at_ + 1, "found " + token(at_ + 1) + "; expected numbers, names, + - * / ^ ( ) or a comma");
  }

  void translate_sign(char c) {
    if (text_.compare(at_, 2, "**") == 0) fail(at_ + 1, "found \"**\"; powers are written with ^, as in x^2");
    if (c == ')' && !result_.empty() && result_.back() == '(')
      fail(at_ + 1, "nothing stands between ( and )");
    emit(std::string(1, c), at_);
    ++at_;
  }

  void translate_name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && continues_name(text_[at_])) ++at_;
    const std::string name = text_.substr(start, at_ - start);
    skip_blanks();
    const bool is_call = at_ < text_.size() && text_[at_] == '(';
    const FormulaFunction* const function = formula_function(name);
    if (is_call || function) {
      if (!function)
        fail(start + 1, "unknown function \"" + name + "\"; known: " + formula_functions() +
                            did_you_mean(name, formula_function_names()));
      if (!is_call) fail(start + 1, "the function " + name + " needs arguments in parentheses");
      return emit(function->of_ginac, start);
    }
    const auto constant = names_.constants.find(name);
    if (constant != names_.constants.end()) return emit_number(constant->second, start);
    if (name == "pi") return emit_number(pi, start);
    if (names_.definitions.count(name) > 0) {
      definitions_.emplace(name, start + 1);
      return emit("d_" + name, start);
    }
    const auto& variables = names_.variables;
    if (std::find(variables.begin(), variables.end(), name) == variables.end()) {
      std::vector<std::string> known = variables;
      for (const auto& [other, value] : names_.constants) known.push_back(other);
      for (const auto& [other, text] : names_.definitions) known.push_back(other);
      known.push_back("pi");
      fail(start + 1, "unknown name \"" + name + "\"; known: " + joined(known) + did_you_mean(name, known));
    }
    emit("v_" + name, start);
  }

  void translate_number() {
    const std::size_t start = at_;
    const auto digits = [&] {
      const std::size_t first = at_;
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
      return at_ > first;
    };
    bool good = digits();
    if (at_ < text_.size() && text_[at_] == '.') {
      ++at_;
      good = digits() || good;
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      good = digits() && good;
    }
    if (!good || (at_ < text_.size() && (text_[at_] == '.' || starts_name(text_[at_]))))
      fail(start + 1, "\"" + text_.substr(start, std::min(at_ + 1, text_.size()) - start) +
                          "\" is no number; products are written with *");
    double value = 0;
    std::istringstream stream(text_.substr(start, at_ - start));
    stream.imbue(std::locale::classic());
    if (!(stream >> value) || !std::isfinite(value)) fail(start + 1, "the number is too large");
    emit_number(value, start);
  }

  /// A number, as such in an exponent, else as its symbol.
  void emit_number(double value, std::size_t start) {
    if (is_exponent()) {
      const bool is_small_integer = value == std::floor(value) && std::abs(value) <= 1000;
      std::string number = is_small_integer ? format("%.0f", value) : format("%.17g", value);
      if (!is_small_integer && number.find_first_of(".e") == std::string::npos) number += ".0";
      return emit(value < 0 ? "(" + number + ")" : number, start);
    }
    std::string symbol = "c_";
    for (char c : format("%a", value)) symbol += continues_name(c) ? c : c == '-' ? 'm' : '_';
    numbers_[symbol] = value;
    emit(symbol, start);
  }

  /// Whether the number that has been read is that of ^2, ^-2, ^(-2), or one of ^(3/2).
  bool is_exponent() const {
    static const std::regex bare("\\^-?$"), open("\\^\\(-?$"), quotient("\\^\\(-?\\d+/$"),
        close("\\s*(/\\s*\\d+\\s*)?\\)");
    const std::size_t tail = result_.size() - std::min<std::size_t>(result_.size(), 12);
    const auto ends = [&](const std::regex& end) {
      return std::regex_search(result_.begin() + tail, result_.end(), end);
    };
    if (ends(bare)) return true;
    const bool closes =
        std::regex_search(text_.begin() + at_, text_.end(), close, std::regex_constants::match_continuous);
    return closes && (ends(open) || ends(quotient));
  }

  void emit(const std::string& token, std::size_t start) {
    if (!result_.empty() && continues_name(result_.back()) && continues_name(token[0])) result_ += ' ';
    result_ += token;
    columns_.resize(result_.size(), start + 1);
  }

  const std::string& text_;
  const FormulaNames& names_;
  const std::string& where_;
  std::size_t at_ = 0;
  std::string result_;
  std::vector<std::size_t> columns_;
  std::map<std::string, double> numbers_;
  std::map<std::string, std::size_t> definitions_;
};

/// What GiNaC's message says is wrong, in the words of this program.
std::string complaint(const std::string& message, const std::string& token) {
  const auto says = [&](const char* words) { return message.find(words) != std::string::npos; };
  if (const std::size_t at = message.find("no function "); at != std::string::npos) {
    std::string words = message.substr(at, message.find('\n', at) - at);
    if (const std::size_t own = words.find("formula_"); own != std::string::npos) words.erase(own, 8);
    return words;
  }
  if (says("no variable")) return "the second argument of diff is no variable";
  if (says("power should have")) return "a^b^c is ambiguous; expected parentheses, a^(b^c)";
  if (says("expected ')'")) return "found " + token + "; expected )";
  if (says("expected EOF")) return "found " + token + "; expected an operator or the end";
  if (says("unexpected token")) return "found " + token + "; expected a number, a name or (";
  return "cannot be evaluated (" + message.substr(0, message.find('\n')) + ")";
}

/// Reads a formula and the definitions that it uses.
class Reader {
 public:
  explicit Reader(const FormulaNames& names) : names_(names) {
    for (const std::string& name : names.variables) {
      variables_.push_back(GiNaC::realsymbol(name));
      symbols_["v_" + name] = variables_.back();
    }
  }

  GiNaC::ex read(const std::string& text, const std::string& where) {
    if (text.size() > Formula::longest_text)
      throw InputError(where + format(": found a formula of %zu characters; expected at most %d", text.size(),
                                      Formula::longest_text));
    const Translation translation(text, names_, where);
    for (const auto& [name, value] : translation.numbers())
      if (symbols_.count(name) == 0) {
        numbers_.emplace_back(GiNaC::realsymbol(name), value);
        symbols_[name] = numbers_.back().first;
      }
    for (const auto& [name, column] : translation.definitions()) {
      if (symbols_.count("d_" + name) > 0) continue;
      if (!open_.insert(name).second) translation.fail(column, name + " is defined in terms of itself");
      symbols_["d_" + name] = read(names_.definitions.at(name), where + ": definition of " + name);
      open_.erase(name);
    }
    return parsed(translation);
  }

  const std::vector<GiNaC::ex>& variables() const { return variables_; }
  const std::vector<std::pair<GiNaC::ex, double>>& numbers() const { return numbers_; }

 private:
  GiNaC::ex parsed(const Translation& translation) const {
    std::istringstream stream(translation.result() + " ");
    try {
      return GiNaC::parser(symbols_, true, formula_prototypes())(stream);
    } catch (const std::exception& error) {
      // GiNaC names no column. Its parser has read the offending token and the character behind it.
      const std::string message = error.what();
      stream.clear();
      const bool at_end = message.find("got: EOF") != std::string::npos;
      const std::size_t read = static_cast<std::size_t>(stream.tellg());
      const std::size_t column =
          translation.column(at_end ? translation.result().size() : std::max<std::size_t>(read, 2) - 2);
      translation.fail(column, complaint(message, translation.token(column)));
    }
  }

  const FormulaNames& names_;
  GiNaC::symtab symbols_;
  std::vector<GiNaC::ex> variables_;
  std::vector<std::pair<GiNaC::ex, double>> numbers_;
  std::set<std::string> open_;
};

}  // namespace

Formula::Formula(const std::string& text, const FormulaNames& names, const std::string& where)
    : text_(text), where_(where) {
  check_names(names, where);
  Reader reader(names);
  auto tree = std::make_shared<FormulaTree>();
  tree->names = names;
  tree->expression = reader.read(text, where);
  tree->variables = reader.variables();
  tree->numbers = reader.numbers();
  tree_ = std::move(tree);
  CompiledFormulas({*this});  // throws for what cannot be evaluated
}

bool Formula::depends_on(const std::string& variable) const {
  const auto& variables = tree_->names.variables;
  const auto found = std::find(variables.begin(), variables.end(), variable);
  return found != variables.end() && tree_->expression.has(tree_->variables[found - variables.begin()]);
}

Formula Formula::derivative(const std::string& variable) const {
  const auto& variables = tree_->names.variables;
  const auto found = std::find(variables.begin(), variables.end(), variable);
  if (found == variables.end())
    throw InputError(description() + ": no derivative with respect to \"" + variable + "\"");
  auto tree = std::make_shared<FormulaTree>(*tree_);
  const GiNaC::ex& symbol = tree->variables[found - variables.begin()];
  tree->expression = tree->expression.diff(GiNaC::ex_to<GiNaC::symbol>(symbol));
  Formula result = *this;
  result.text_ = "d(" + text_ + ")/d" + variable;
  result.tree_ = std::move(tree);
  return result;
}

}  // namespace esfem
