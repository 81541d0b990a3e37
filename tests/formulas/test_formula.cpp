// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/formulas/formula.hpp"

namespace esfem::test_formula {
namespace {

using testing::AllOf, testing::HasSubstr;

const FormulaNames names = {{"x", "y"}, {{"a", 0.3}, {"n", 3}}};

double value(const Formula& formula, double x, double y) {
  const double in[] = {x, y};
  double out;
  CompiledFormulas({formula}).evaluate(in, &out);
  return out;
}
double value(const std::string& text, double x, double y) {
  return value(Formula(text, names, "test"), x, y);
}

template <class Error, class Function>
std::string message_of(const Function& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}
std::string refusal(const std::string& text) {
  return message_of<InputError>([&] { Formula(text, names, "kinetics: f"); });
}

TEST(Formula, HasTheValuesOfArithmetic) {
  const double x = 0.7, y = -1.3, a = 0.3;
  const std::pair<const char*, double> cases[] = {
      {"x", x},
      {"-x^2", -x * x},
      {"2^-1", 0.5},
      {"x - y - a", x - y - a},
      {"x/y/a", x / y / a},
      {"x - (y - a)", x - (y - a)},
      {"2*x^3*y - 1/3", 2 * x * x * x * y - 1.0 / 3},
      {"x^y", std::pow(x, y)},
      {"(x^2)^y", std::pow(x * x, y)},
      {"x^n", x * x * x},
      {"y^(1/3)*0 + x^2.5", NAN},
      {"x^2.5", std::pow(x, 2.5)},
      {"x^(-3/2)", std::pow(x, -1.5)},
      {"x^(-2)", 1 / (x * x)},
      {"1.5e-1*x + .5 + 2.", 0.15 * x + 2.5},
      {"sqrt(x)*exp(y)*log(x)", std::sqrt(x) * std::exp(y) * std::log(x)},
      {"sin(x)+cos(x)*tan(y)", std::sin(x) + std::cos(x) * std::tan(y)},
      {"asin(x)+acos(x)-atan(y)", std::asin(x) + std::acos(x) - std::atan(y)},
      {"sinh(x)+cosh(x)*tanh(y)", std::sinh(x) + std::cosh(x) * std::tanh(y)},
      {"asinh(x)+acosh(2)*atanh(x)", std::asinh(x) + std::acosh(2.0) * std::atanh(x)},
      {"atan2(y, x)", std::atan2(y, x)},
      {"min(x, y) + 10*max(x, y)", y + 10 * x},
      {"abs(y) + 10*sign(y) + 100*step(y) + 1000*step(x)", -y - 10 + 1000},
      {"step(0) + sign(0)", 1},
      {"cos(pi*x)", std::cos(pi * x)},
      {"x^2+y^2-(2*x*y)", (x - y) * (x - y)},
  };
  for (const auto& [text, expected] : cases) {
    if (std::isnan(expected)) {
      EXPECT_THROW(value(text, x, y), NumericsError) << text;
    } else {
      EXPECT_NEAR(value(text, x, y), expected, 4e-16 * (1 + std::abs(expected))) << text;
    }
  }
}

TEST(Formula, NumbersAreNotRounded) {
  EXPECT_EQ(value("0.1", 0, 0), 0.1);
  EXPECT_EQ(value("199/200 + 0*x", 0, 0), 199.0 / 200.0);
  EXPECT_EQ(value("1e-300*x", 1e10, 0), 1e-300 * 1e10);
  EXPECT_EQ(value("a", 0, 0), 0.3);
  EXPECT_EQ(value("pi", 0, 0), pi);
}

/// Derivatives against differences of the function, and those of higher order against differences of the
/// lower ones.
TEST(Formula, DifferentiatesFourTimes) {
  for (const char* text :
       {"x^2+y^2+2*x^2*(x^2-199/200)-0.04", "exp(-x*y)*sin(3*x)", "sqrt(x^2+y^2+1)/(2+cos(y))", "x^2.5*y^n",
        "tanh(x*y)-log(x+2)", "x^y", "abs(y-x)*x^3", "min(x, y^2)*max(x^2*y, 1-y)", "atan2(y, x)", "a*x"}) {
    std::vector<Formula> formulas = {Formula(text, names, "test")};
    for (int order = 1; order <= 4; ++order) {
      const std::string variable = order % 2 == 1 ? "x" : "y";
      const Formula& before = formulas.back();
      const Formula derivative = before.derivative(variable);
      const double x = 0.7, y = 0.4, h = 1e-5;
      const double difference = variable == "x"
                                    ? (value(before, x + h, y) - value(before, x - h, y)) / (2 * h)
                                    : (value(before, x, y + h) - value(before, x, y - h)) / (2 * h);
      EXPECT_NEAR(value(derivative, x, y), difference, 1e-7 * (1 + std::abs(difference)))
          << text << ", order " << order;
      formulas.push_back(derivative);
    }
  }
}

TEST(Formula, DerivativesOfPowersAreFiniteAtZero) {
  for (const char* text : {"x^2", "x^n", "(x)^(2)", "x*x", "(x+y)^4", "x^3.5", "x^(3/2)", "x^( 7 / 4 )"}) {
    Formula derivative = Formula(text, names, "test").derivative("x");
    EXPECT_EQ(value(derivative, 0, 0), 0) << text;
  }
}

TEST(Formula, PointsAtTheColumnOfAnError) {
  const std::pair<const char*, const char*> cases[] = {
      {"x+*y", "kinetics: f: \"x+*y\": column 3: found \"*\"; expected a number, a name or ("},
      {"x**2", "column 2: found \"**\"; powers are written with ^, as in x^2"},
      {"1 + Sin(x)", "did you mean \"sin\"?"},
      {"x y", "column 3: found \"y\"; expected an operator or the end"},
      {"(x", "column 3: found the end; expected )"},
      {"x)", "column 2: found \")\"; expected an operator"},
      {"x + ", "column 5: found the end; expected a number, a name or ("},
      {"", "column 1: found the end"},
      {"x + foo*y", "column 5: unknown name \"foo\"; known: x, y, a, n, pi"},
      {"sin(x) + sinus(x)", "column 10: unknown function \"sinus\"; known: sqrt, exp, log, sin"},
      {"x*(y)", "no error"},
      {"x(y)", "column 1: unknown function \"x\""},
      {"1 + sin x", "column 5: the function sin needs arguments in parentheses"},
      {"sin()", "column 5: nothing stands between ( and )"},
      {"sin( )", "column 6: nothing stands between ( and )"},
      {"x+sin(x,y)", "no function \"sin\" with 2 arguments"},
      {"min(x)", "no function \"min\" with 1 arguments"},
      {"abs(x, y)", "no function \"abs\" with 2 arguments"},
      {"x, y", "column 2: found \",\"; expected an operator"},
      {"x^2^3", "a^b^c is ambiguous; expected parentheses, a^(b^c)"},
      {"2x", "column 1: \"2x\" is no number; products are written with *"},
      {"y + 1.5.2", "column 5: \"1.5.\" is no number"},
      {"3e", "column 1: \"3e\" is no number"},
      {"1e999", "column 1: the number is too large"},
      {"x = y", "column 3: found \"=\"; expected numbers, names, + - * / ^ ( ) or a comma"},
      {"x;system(y)", "column 2: found \";\""},
      {"{x}", "column 1: found \"{\""},
      {"x!", "column 2: found \"!\""},
      {"I", "column 1: unknown name \"I\""},
      {"Digits", "unknown name \"Digits\""},
      {"log(0)*x", "not finite"},
      {"sqrt(-1)", "not finite"},
      {"9^(9^(9^9))", "not finite"},
      {"x-+", "column 4: found the end"},
  };
  for (const auto& [text, expected] : cases) EXPECT_THAT(refusal(text), HasSubstr(expected)) << text;
  EXPECT_THAT(refusal(std::string(2001, 'x')),
              HasSubstr("found a formula of 2001 characters; expected at most 2000"));
  EXPECT_THAT(refusal(std::string(999, '(') + "x" + std::string(999, ')')), HasSubstr("no error"));
  EXPECT_THAT(refusal(std::string(1999, '-') + "x"), HasSubstr("no error"));
}

TEST(Formula, RefusesNamesThatAreNoneOrTaken) {
  const auto message = [](const FormulaNames& bad) {
    return message_of<InputError>([&] { Formula("1", bad, "parameters"); });
  };
  EXPECT_THAT(message({{"x"}, {{"x", 1}}}), HasSubstr("parameters: the name \"x\" is taken"));
  EXPECT_THAT(message({{"x"}, {{"sin", 1}}}), HasSubstr("the name \"sin\" is taken"));
  EXPECT_THAT(message({{"x"}, {{"pi", 1}}}), HasSubstr("the name \"pi\" is taken"));
  EXPECT_THAT(message({{"x"}, {{"2a", 1}}}),
              HasSubstr("found the name \"2a\"; expected letters, digits and _"));
  EXPECT_THAT(message({{"x"}, {{"a", NAN}}}), HasSubstr("a is not finite"));
  EXPECT_EQ(message({{"x", "I", "Pi"}, {{"Euler", 1}}}), "no error");
}

TEST(Formula, KnowsOnWhatItDepends) {
  FormulaNames with_parts = names;
  with_parts.definitions = {{"p", "y^2"}};
  EXPECT_TRUE(Formula("a*x", names, "f").depends_on("x"));
  EXPECT_FALSE(Formula("a*x", names, "f").depends_on("y"));
  EXPECT_TRUE(Formula("a*p", with_parts, "f").depends_on("y"));
  EXPECT_FALSE(Formula("x-x+a", names, "f").depends_on("x"));
  EXPECT_FALSE(Formula("a*x", names, "f").depends_on("a"));  // a number, no variable
}

TEST(Formula, NamesPartsOfItself) {
  const FormulaNames with = {
      {"x", "y"}, {{"a", 0.3}}, {{"r", "sqrt(s)"}, {"s", "x^2+y^2"}, {"slope", "diff(r, x)"}}};
  EXPECT_NEAR(value(Formula("a*r + slope", with, "f"), 3, 4), 0.3 * 5 + 0.6, 1e-15);
  EXPECT_NEAR(value(Formula("r^2*diff(diff(s, x), x)", with, "f").derivative("y"), 3, 4), 16, 1e-14);
  const auto message = [](const std::map<std::string, std::string>& definitions, const std::string& text) {
    return message_of<InputError>([&] { Formula(text, {{"x"}, {}, definitions}, "f"); });
  };
  EXPECT_THAT(
      message({{"r", "s+1"}, {"s", "2*r"}}, "r"),
      HasSubstr("f: definition of r: definition of s: \"2*r\": column 3: r is defined in terms of itself"));
  EXPECT_THAT(message({{"r", "x+"}}, "1+r"),
              HasSubstr("f: definition of r: \"x+\": column 3: found the end"));
  EXPECT_THAT(message({{"x", "1"}}, "1"), HasSubstr("the name \"x\" is taken"));
  EXPECT_THAT(message({}, "diff(x, 2)"), HasSubstr("the second argument of diff is no variable"));
  EXPECT_THAT(message({}, "diff(x)"), HasSubstr("no function \"diff\" with 1 arguments"));
  EXPECT_EQ(message({{"unused", "1+*"}}, "x"), "no error");
}

TEST(CompiledFormulas, PacksRowsAndNumbersHaveTheSameBits) {
  const std::vector<Formula> formulas = {Formula("a - x + x^2*y", names, "f"),
                                         Formula("a - x^2*y", names, "g"),
                                         Formula("exp(x)/(1 + y^2)", names, "h")};
  const CompiledFormulas compiled(formulas);
  const Field points = Field::Random(37, 2);
  const Field values = compiled(points);
  ASSERT_EQ(values.cols(), 3);
  for (int i = 0; i < points.rows(); ++i) {
    const double x = points(i, 0), y = points(i, 1), in[] = {x, y};
    double out[3];
    compiled.evaluate(in, out);
    for (int l = 0; l < 3; ++l) EXPECT_EQ(values(i, l), out[l]);
    EXPECT_NEAR(out[0], 0.3 - x + x * x * y, 1e-15);
    EXPECT_NEAR(out[1], 0.3 - x * x * y, 1e-15);
  }
  EXPECT_THROW(compiled(Field::Zero(3, 3)), InputError);
  EXPECT_THROW(CompiledFormulas({formulas[0], Formula("x", {{"x"}}, "f")}), InputError);
}

TEST(CompiledFormulas, NamesTheFormulaAndThePointWhereAValueIsNotFinite) {
  const CompiledFormulas compiled(
      {Formula("x", names, "f"), Formula("x*log(y)", names, "kinetics: f of u2")});
  Field points = Field::Ones(20, 2);
  points.row(13) << 0.5, -2;
  EXPECT_THROW(value("x/0", 1, 0), NumericsError);
  EXPECT_THAT(message_of<NumericsError>([&] { compiled(points); }),
              AllOf(HasSubstr("kinetics: f of u2: \"x*log(y)\" "), HasSubstr("is nan at x = 0.5, y = -2")));
  for (const char* kink : {"min(x, log(y))", "max(log(y), x)", "abs(log(y))", "sign(log(y))", "step(log(y))"})
    EXPECT_THROW(value(kink, 0, -1), NumericsError) << kink;
}

}  // namespace
}  // namespace esfem::test_formula
