// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size_expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft::check {
namespace {

double value(std::string_view source, Vec2 at = {3, 5}) {
  const auto expression = SizeExpression::parse(source);
  EXPECT_TRUE(expression) << source << ": " << (expression ? "" : expression.error());
  return expression ? (*expression)(at) : std::nan("");
}

TEST(SizeExpression, ReadsNumbers) {
  EXPECT_EQ(value("1"), 1);
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("2."), 2);
  EXPECT_EQ(value("1e-3"), 1e-3);
  EXPECT_EQ(value("1.5E+2"), 150);
  EXPECT_EQ(value("0.1"), 0.1);
}

TEST(SizeExpression, KnowsVariablesAndConstants) {
  EXPECT_EQ(value("x"), 3);
  EXPECT_EQ(value("y"), 5);
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_EQ(value("e"), std::numbers::e);
  EXPECT_EQ(value("2*e"), 2 * std::numbers::e);
}

TEST(SizeExpression, BindsMinusLooserThanPower) {
  EXPECT_EQ(value("-x^2"), -9);
  EXPECT_EQ(value("(-x)^2"), 9);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-x^2"), 0x1p-9);
  EXPECT_EQ(value("2*-x"), -6);
  EXPECT_EQ(value("2^-1*3"), 1.5);
  EXPECT_EQ(value("-x*y"), -15);
  EXPECT_EQ(value("- -x"), 3);
  EXPECT_EQ(value("--x"), 3);
  EXPECT_EQ(value("+x"), 3);
  EXPECT_EQ(value("1--x"), 4);
  EXPECT_EQ(value("x-+y"), -2);
}

TEST(SizeExpression, RaisesToTheRight) {
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("(2^3)^2"), 64);
}

TEST(SizeExpression, SubtractsAndDividesToTheLeft) {
  EXPECT_EQ(value("10-4-3"), 3);
  EXPECT_EQ(value("100/10/5"), 2);
  EXPECT_EQ(value("2+3*4"), 14);
  EXPECT_EQ(value("8/4*2"), 4);
}

TEST(SizeExpression, ComparesToZeroOrOne) {
  EXPECT_EQ(value("x<y"), 1);
  EXPECT_EQ(value("x>y"), 0);
  EXPECT_EQ(value("x<=3"), 1);
  EXPECT_EQ(value("x>=3"), 1);
  EXPECT_EQ(value("x==3"), 1);
  EXPECT_EQ(value("x!=3"), 0);
  EXPECT_EQ(value("1+1<3"), 1);
  EXPECT_EQ(value("(x<y)+(y<x)"), 1);
}

TEST(SizeExpression, CombinesTruthValues) {
  EXPECT_EQ(value("1 && 0"), 0);
  EXPECT_EQ(value("2 && 3"), 1);
  EXPECT_EQ(value("0 || 0.5"), 1);
  EXPECT_EQ(value("1 || 0 && 0"), 1);
  EXPECT_EQ(value("!0"), 1);
  EXPECT_EQ(value("!x"), 0);
  EXPECT_EQ(value("!!x"), 1);
  EXPECT_EQ(value("!(x<y)"), 0);
  EXPECT_EQ(value("!x==0"), 1);
  EXPECT_EQ(value("!0^2"), 1);
  EXPECT_EQ(value("-!0"), -1);
  EXPECT_EQ(value("!-x"), 0);
  EXPECT_EQ(value("!!!x"), 0);
  EXPECT_EQ(value("-!!x"), -1);
  EXPECT_EQ(value("- ! - ! x"), -1);
  EXPECT_EQ(value("2-!0"), 1);
  EXPECT_EQ(value("2*-!0"), -2);
}

TEST(SizeExpression, ChoosesToTheRight) {
  EXPECT_EQ(value("x<y ? 1 : 2"), 1);
  EXPECT_EQ(value("0 ? 1 : 0 ? 2 : 3"), 3);
  EXPECT_EQ(value("1 ? 0 ? 4 : 5 : 6"), 5);
  EXPECT_EQ(value("0 || 1 ? 7 : 8"), 7);
  EXPECT_EQ(value("1 + (x<y ? 1 : 2)"), 2);
}

TEST(SizeExpression, KnowsItsFunctions) {
  EXPECT_EQ(value("sqrt(16)"), 4);
  EXPECT_EQ(value("abs(-x)"), 3);
  EXPECT_NEAR(value("exp(1)"), std::numbers::e, 1e-15);
  EXPECT_NEAR(value("log(e^2)"), 2, 1e-15);
  EXPECT_NEAR(value("sin(pi/6)"), 0.5, 1e-15);
  EXPECT_NEAR(value("cos(pi/3)"), 0.5, 1e-15);
  EXPECT_NEAR(value("tan(pi/4)"), 1, 1e-15);
  EXPECT_EQ(value("floor(-1.5)"), -2);
  EXPECT_EQ(value("ceil(-1.5)"), -1);
  EXPECT_EQ(value("pow(2,10)"), 1024);
  EXPECT_NEAR(value("atan2(1,-1)"), 0.75 * std::numbers::pi, 1e-15);
  EXPECT_EQ(value("hypot(3,4)"), 5);
  EXPECT_EQ(value("min(4,2)"), 2);
  EXPECT_EQ(value("min(4,2,1,3)"), 1);
  EXPECT_EQ(value("max(4,2,9,3)"), 9);
  EXPECT_EQ(value("clamp(7,1,5)"), 5);
  EXPECT_EQ(value("clamp(-7,1,5)"), 1);
  EXPECT_EQ(value("clamp(x,1,5)"), 3);
}

TEST(SizeExpression, EvaluatesTheGradingFunctionsOfTheModels) {
  EXPECT_NEAR(value("0.4*sqrt((x-200)^2+(y-200)^2)+1", {203, 204}), 3, 1e-12);
  EXPECT_NEAR(value("0.02*abs(y-46)+0.1", {0, 41}), 0.2, 1e-15);
  constexpr std::string_view kCylinder =
      "(x>=0 && abs(y)<5) or (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";
  EXPECT_FALSE(SizeExpression::parse(kCylinder));
  constexpr std::string_view kWake = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";
  EXPECT_EQ(value(kWake, {40, 4}), 1.2e-3);
  EXPECT_EQ(value(kWake, {40, 6}), 1e-2);
  EXPECT_EQ(value(kWake, {-3, 3}), 1.2e-3);
  EXPECT_EQ(value(kWake, {-4, 4}), 1e-2);
}

TEST(SizeExpression, YieldsWhatArithmeticYields) {
  EXPECT_TRUE(std::isinf(value("1/0")));
  EXPECT_TRUE(std::isnan(value("sqrt(-1)")));
  EXPECT_TRUE(std::isnan(value("0/0")));
}

TEST(SizeExpression, AcceptsWhiteSpaceAnywhereBetweenTokens) {
  EXPECT_EQ(value(" x\t+\n y "), 8);
  EXPECT_EQ(value("2*hypot (x,4) - sqrt\n\n ( 4 )"), 8);
  EXPECT_EQ(value("- sqrt \t( 4 ) + -!abs  (1)"), -2);
}

TEST(SizeExpression, DoesNotChainComparisons) {
  for (const std::string_view source :
       {"x < y == 1", "0 < x < 5", "1 == x == y", "(x) < (y) >= 1", "x < 1 ? 1 : 2 < 3 != 4"})
    EXPECT_FALSE(SizeExpression::parse(source)) << source;
  EXPECT_EQ(value("(x < y) == 1"), 1);
  EXPECT_EQ(value("1 == (x < y)"), 1);
  EXPECT_EQ(value("x < y && y > x || 1 == 2"), 1);
  EXPECT_EQ(value("x > y ? x < 1 : min(x < y, 1 < 2) == 1"), 1);
}

TEST(SizeExpression, RefusesWhatTheGrammarDoesNotHave) {
  for (const std::string_view source :
       {"",           " ",     "x+",     "(x",      "x)",        "x y",      "2x",
        "x=3",        "x,y",   "\"a\"",  "rint(x)", "_pi",       "sum(1,2)", "x & y",
        "x | y",      "1 ? 2", "min(1)", "max()",   "sqrt(1,2)", "hypot(1)", "pow(1)",
        "clamp(1,2)", "x @ y", "1e999",  "1.2.3",   "#",         "sqrt",     "x(1)",
        "()",         "a",     "x <> y", "3 ! ",    "x ! y",     "-",        "(-)",
        "1 + -",      "x != ", "e2",     "x ? y",   ":",         ","}) {
    EXPECT_FALSE(SizeExpression::parse(source)) << source;
  }
}

TEST(SizeExpression, NamesTheOffenderOfASyntaxError) {
  EXPECT_EQ(SizeExpression::parse("1 + rint(x)").error(),
            "the size expression does not parse: unknown name 'rint' at column 5");
}

TEST(SizeExpression, ReadsDeepNestingUpToItsLimit) {
  const std::string source = std::string(900, '(') + "x" + std::string(900, ')');
  EXPECT_EQ(value(source), 3);
  EXPECT_EQ(value(std::string(900, '-') + "x"), 3);
  EXPECT_EQ(value("0" + std::string(100'000, ' ') + "+x"), 3);
  for (const char sign : {'(', '-', '!'})
    EXPECT_EQ(SizeExpression::parse(std::string(100'000, sign)).error(),
              "the size expression does not parse: too many parentheses and signs at column 1002");
  std::string powers = "1", choices = "1", sums = "1";
  for (int i = 0; i < 20'000; ++i) {
    powers += "^1";
    choices += "?1:1";
    sums += "+1";
  }
  EXPECT_FALSE(SizeExpression::parse(powers));
  EXPECT_EQ(value(choices), 1);
  EXPECT_EQ(value(sums), 20'001);
}

}  // namespace
}  // namespace weft::check
