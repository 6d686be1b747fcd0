// SPDX-License-Identifier: Apache-2.0
// The grammar: what an accepted expression means.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "engine/size/expression/expression.h"

namespace weft {
namespace {

double value(const std::string& source, double x = 3, double y = 4) {
  const Result<Expression> expression = Expression::parse(source);
  if (!expression) {
    ADD_FAILURE() << source << "\n" << expression.error().message;
    return std::numeric_limits<double>::quiet_NaN();
  }
  return (*expression)({x, y});
}

TEST(Grammar, NumbersMayLackEitherSideOfThePoint) {
  EXPECT_EQ(value("1"), 1);
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("2."), 2);
  EXPECT_EQ(value("1e-3"), 1e-3);
  EXPECT_EQ(value("1.5E+2"), 150);
  EXPECT_EQ(value("4e-320"), 4e-320);
  EXPECT_EQ(value("0.1"), 0.1);
}

TEST(Grammar, NamesAreVariablesAndConstants) {
  EXPECT_EQ(value("x"), 3);
  EXPECT_EQ(value("y"), 4);
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_EQ(value("e"), std::numbers::e);
}

TEST(Grammar, ProductsBindTighterThanSumsAndBothAssociateLeft) {
  EXPECT_EQ(value("2 + 3 * 4"), 14);
  EXPECT_EQ(value("20 - 5 - 3"), 12);
  EXPECT_EQ(value("24 / 4 / 2"), 3);
  EXPECT_EQ(value("24 / 4 * 2"), 12);
  EXPECT_EQ(value("(2 + 3) * 4"), 20);
  EXPECT_EQ(value("x - y + 1"), 0);
}

TEST(Grammar, PowersAssociateRightAndBindTighterThanTheSignBefore) {
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("-x^2"), -9);
  EXPECT_EQ(value("(-x)^2"), 9);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-x"), 0.125);
  EXPECT_EQ(value("x^2*y"), 36);
  EXPECT_EQ(value("2*x^2"), 18);
  EXPECT_EQ(value("2^-1^2"), 0.5);
}

TEST(Grammar, UnaryOperatorsStack) {
  EXPECT_EQ(value("--x"), 3);
  EXPECT_EQ(value("-+-x"), 3);
  EXPECT_EQ(value("2 - -x"), 5);
  EXPECT_EQ(value("!!x"), 1);
  EXPECT_EQ(value("-!x"), 0);
}

TEST(Grammar, ComparisonsGiveOneOrZero) {
  EXPECT_EQ(value("x < y"), 1);
  EXPECT_EQ(value("x > y"), 0);
  EXPECT_EQ(value("x <= 3"), 1);
  EXPECT_EQ(value("x >= 3.5"), 0);
  EXPECT_EQ(value("x == 3"), 1);
  EXPECT_EQ(value("x != 3"), 0);
  EXPECT_EQ(value("(x < y) + (y < x) + (x == 3)"), 2);
  EXPECT_EQ(value("x + 1 < y + 1"), 1);
}

TEST(Grammar, AndBindsTighterThanOrAndBothLooserThanComparison) {
  EXPECT_EQ(value("1 || 0 && 0"), 1);
  EXPECT_EQ(value("(1 || 0) && 0"), 0);
  EXPECT_EQ(value("x < y || y < x && 0"), 1);
  EXPECT_EQ(value("x == 3 && y == 4"), 1);
  EXPECT_EQ(value("x == 3 && y == 5"), 0);
}

TEST(Grammar, AnythingButZeroIsTrue) {
  EXPECT_EQ(value("x && y"), 1);
  EXPECT_EQ(value("x && 0*y"), 0);
  EXPECT_EQ(value("-x ? 5 : 6"), 5);
  EXPECT_EQ(value("x - 3 ? 5 : 6"), 6);
  EXPECT_EQ(value("!(x - 3)"), 1);
  EXPECT_EQ(value("sqrt(-x) ? 5 : 6"), 5) << "NaN is true";
  EXPECT_EQ(value("!sqrt(-x)"), 0);
}

TEST(Grammar, TheConditionalIsLoosestAndAssociatesRight) {
  EXPECT_EQ(value("x < y ? 1 : 2"), 1);
  EXPECT_EQ(value("x > y || 0 ? 1 : 2 + 3"), 5);
  EXPECT_EQ(value("x == 1 ? 10 : x == 2 ? 20 : x == 3 ? 30 : 40"), 30);
  EXPECT_EQ(value("x == 3 ? y == 3 ? 1 : 2 : 3"), 2);
  EXPECT_EQ(value("(x == 1 ? 2 : 3) + 1"), 4);
  EXPECT_EQ(value("x < y ? y < x : 7"), 0) << "a truth as a number";
}

TEST(Grammar, TheSizeOfTheCylinderModelMeansWhatItSays) {
  const std::string source = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";
  EXPECT_EQ(value(source, 20, 4.9), 1.2e-3);
  EXPECT_EQ(value(source, 20, 5), 1e-2);
  EXPECT_EQ(value(source, -3, 3.9), 1.2e-3);
  EXPECT_EQ(value(source, -3, 4), 1e-2);
}

TEST(Grammar, FunctionsTakeWhatTheirNamesSay) {
  EXPECT_EQ(value("sqrt(x + 6)"), 3);
  EXPECT_EQ(value("abs(-x)"), 3);
  EXPECT_EQ(value("floor(-x/2)"), -2);
  EXPECT_EQ(value("ceil(-x/2)"), -1);
  EXPECT_EQ(value("min(x, y)"), 3);
  EXPECT_EQ(value("max(x, y)"), 4);
  EXPECT_EQ(value("min(9, x, y, 8)"), 3);
  EXPECT_EQ(value("max(x, y, 1, 2, 3)"), 4);
  EXPECT_EQ(value("clamp(x, 5, 9)"), 5);
  EXPECT_EQ(value("clamp(x, 1, 2)"), 2);
  EXPECT_EQ(value("clamp(x, 1, 9)"), 3);
  EXPECT_EQ(value("pow(x, 2)"), 9);
  EXPECT_DOUBLE_EQ(value("hypot(x, y)"), 5);
  EXPECT_DOUBLE_EQ(value("atan2(x, y)"), std::atan2(3, 4));
  EXPECT_DOUBLE_EQ(value("pow(x, y)"), 81);
}

TEST(Grammar, SpacesTabsAndNewlinesAreFree) {
  EXPECT_EQ(value(" \t x\n  +\r\n y\n"), 7);
  EXPECT_EQ(value("x+y"), 7);
  EXPECT_EQ(value("sqrt ( 9 )"), 3);
}

TEST(Grammar, ConstantsFoldAndSayThatTheyAreConstant) {
  for (const char* source : {"1", "2*pi", "sin(1)^2 + cos(1)^2", "1 < 2 ? 3 : x", "x^0",
                             "0 && x ? x : 2", "1 || y ? 1 : x", "min(1, 2)", "!1 + !0"}) {
    EXPECT_TRUE(Expression::parse(source)->constant()) << source;
  }
  for (const char* source : {"x", "x - x", "x < 1 ? 3 : 4", "0*y"}) {
    EXPECT_FALSE(Expression::parse(source)->constant()) << source;
  }
}

TEST(Expression, TellsTheArgumentsOfAMinimum) {
  const auto of = [](const char* source) { return Expression::arguments_of_min(source); };
  using Arguments = std::vector<std::string>;
  EXPECT_EQ(of("min(x, 2)"), (Arguments{"x", " 2"}));
  EXPECT_EQ(of(" min ( max(x, 1) , (y), clamp(x, 0, 1) ) "),
            (Arguments{" max(x, 1) ", " (y)", " clamp(x, 0, 1) "}));
  EXPECT_EQ(of("min(x, 2) + 1"), Arguments{});
  EXPECT_EQ(of("1 + min(x, 2)"), Arguments{});
  EXPECT_EQ(of("min(x, 2) < min(y, 3) ? 1 : 2"), Arguments{});
  EXPECT_EQ(of("max(x, 2)"), Arguments{});
  EXPECT_EQ(of("x"), Arguments{});
}

}  // namespace
}  // namespace weft
