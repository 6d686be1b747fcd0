// SPDX-License-Identifier: Apache-2.0
// What is refused, and which place the error names.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/size/expression/expression.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

Error error_of(const std::string& source) {
  const Result<Expression> expression = Expression::parse(source);
  if (expression) {
    ADD_FAILURE() << "accepted: " << source.substr(0, 100);
    return {};
  }
  EXPECT_EQ(expression.error().field, "size.expression");
  return expression.error();
}

std::string message(const std::string& source) {
  const Error error = error_of(source);
  EXPECT_EQ(error.code, ErrorCode::kExpressionSyntax) << error.message;
  return error.message;
}

std::string limit(const std::string& source) {
  const Error error = error_of(source);
  EXPECT_EQ(error.code, ErrorCode::kExpressionTooComplex) << error.message;
  return error.message;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

TEST(ParseErrors, TheCaretStandsUnderTheOffender) {
  EXPECT_EQ(message("x + 2 * / y"),
            "line 1, column 9: expected a number, a name or '(', found '/'\n"
            "  x + 2 * / y\n"
            "          ^");
}

TEST(ParseErrors, LinesAreCountedAndOnlyTheOffendersLineIsShown) {
  EXPECT_EQ(message("x +\n  radius *\ny"),
            "line 2, column 3: unknown name 'radius'; the variables are x and y\n"
            "    radius *\n"
            "    ^");
}

TEST(ParseErrors, ALongLineIsCutAroundTheCaret) {
  const std::string text = message(repeated("x + ", 50) + "$" + repeated(" + y", 50));
  EXPECT_EQ(text,
            "line 1, column 201: unexpected character '$'\n"
            "  ..." +
                repeated("x + ", 10) + "$" + repeated(" + y", 7) + " + ...\n" + "  " +
                std::string(43, ' ') + "^");
}

TEST(ParseErrors, AnEmptyExpressionIsSaidToBeEmpty) {
  EXPECT_EQ(message(""), "line 1, column 1: the expression is empty\n  \n  ^");
  EXPECT_NE(message(" \t ").find("the expression is empty"), std::string::npos);
}

struct Case {
  std::string source;
  std::string says;
};

TEST(ParseErrors, EachNamesItsOffender) {
  const std::vector<Case> cases = {
      {"x +", "column 4: expected a number, a name or '(', found the end"},
      {"(x + 1", "column 7: expected ')' to close the '(' at line 1, column 1, found the end"},
      {"x)", "column 2: expected an operator, found ')'"},
      {"sqrt(x", "expected ')' to close the '(' at line 1, column 5, found the end"},
      {"2x", "column 2: expected an operator, found 'x'"},
      {"x y", "column 3: expected an operator, found 'y'"},
      {"x ? 1", "column 6: expected ':' to go with '?', found the end"},
      {"x : 1", "column 3: expected an operator, found ':'"},
      {"()", "column 2: expected a number, a name or '(', found ')'"},
      {"1..2", "column 1: malformed number '1..2'"},
      {"1.2.3", "malformed number '1.2.3'"},
      {".", "malformed number '.'"},
      {"1e5.5", "malformed number '1e5.5'"},
      {"2e", "column 2: expected an operator, found 'e'"},
      {"1e999", "column 1: the number '1e999' is outside the range of a double"},
      {"x + 1e-999", "column 5: the number '1e-999' is outside the range of a double"},
      {"0x10", "column 2: expected an operator, found 'x10'"},
      {"nan", "unknown name 'nan'"},
      {"1 + inf", "unknown name 'inf'"},
      {"sinn(x)", "column 1: unknown name 'sinn'; did you mean 'sin'?"},
      {"Sqrt(x)", "unknown name 'Sqrt'; did you mean 'sqrt'?"},
      {"hypo(x, y)", "did you mean 'hypot'?"},
      {"X + 1", "unknown name 'X'; did you mean 'x'?"},
      {"z", "unknown name 'z'; the variables are x and y"},
      {"sin", "column 1: the function 'sin' needs arguments in parentheses"},
      {"sin x", "the function 'sin' needs arguments in parentheses"},
      {"x(3)", "column 2: 'x' is not a function; a product is written *"},
      {"sin()", "column 1: 'sin' takes 1 argument, 0 given"},
      {"1 + sin(x, y)", "column 5: 'sin' takes 1 argument, 2 given"},
      {"pow(x)", "'pow' takes 2 arguments, 1 given"},
      {"min(x)", "'min' takes at least 2 arguments, 1 given"},
      {"clamp(x, 1)", "'clamp' takes 3 arguments, 2 given"},
      {"min(x,)", "column 7: expected a number, a name or '(', found ')'"},
      {"(x, y)", "column 3: expected ')' to close the '(' at line 1, column 1, found ','"},
      {"0 < x < 5", "column 7: comparisons do not chain; write a < b && b < c"},
      {"x == y == 1", "comparisons do not chain"},
      {"x ** 2", "column 3: a power is written ^"},
      {"x = 2", "column 3: unexpected '='; equality is written =="},
      {"x & y", "unexpected '&'; logical and is written &&"},
      {"x | y", "unexpected '|'; logical or is written ||"},
      {"x % 2", "unexpected '%'; there is no remainder operator"},
      {"x < 1 and y < 1", "expected an operator, found 'and'"},
      {"x; y", "column 2: unexpected character ';'"},
      {"\xc3\xa9", "column 1: unexpected byte 0xc3; an expression is printable ASCII"},
      {std::string("x\0y", 3), "column 2: unexpected byte 0x00"},
  };
  for (const Case& c : cases) {
    EXPECT_NE(message(c.source).find(c.says), std::string::npos) << c.source << "\n"
                                                                 << message(c.source);
  }
}

TEST(ParseErrors, AMessageIsPrintableAsciiWhateverTheSourceHolds) {
  const std::string text = message("x + \xff\xfe\x01 + caf\xc3\xa9");
  for (char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
}

TEST(ParseErrors, AnEndlessNameIsQuotedInPart) {
  EXPECT_LT(message(std::string(60000, 'a')).size(), 300u);
}

TEST(ParseLimits, TheLengthIsBounded) {
  const std::string text = limit(repeated("1+", 50000) + "1");
  EXPECT_EQ(text, "the size expression has 100001 bytes; the limit is 65536");
  EXPECT_TRUE(Expression::parse(std::string(kMaxExpressionBytes - 1, ' ') + "1"));
}

TEST(ParseLimits, NestingIsBoundedWhateverNests) {
  EXPECT_NE(limit(repeated("(", 10000) + "x" + repeated(")", 10000))
                .find("column 258: nested deeper than 256 levels"),
            std::string::npos);
  for (const std::string opening :
       {"(", "sqrt(", "-", "!", "x^", "min(1,", "1?", "1+(2*(", "(1<", "1||1&&1<1+1*("}) {
    const std::string source = repeated(opening, 60000 / opening.size());
    EXPECT_NE(limit(source).find("nested deeper than 256 levels"), std::string::npos) << opening;
  }
}

TEST(ParseLimits, NestingUpToTheLimitIsAccepted) {
  const std::size_t n = Expression::kMaxDepth;
  EXPECT_TRUE(Expression::parse(repeated("(", n) + "x" + repeated(")", n)));
  EXPECT_FALSE(Expression::parse(repeated("(", n + 1) + "x" + repeated(")", n + 1)));
  EXPECT_TRUE(Expression::parse(repeated("-", n) + "x"));
  EXPECT_FALSE(Expression::parse(repeated("-", n + 1) + "x"));
}

TEST(ParseLimits, OperationsAreBounded) {
  std::string sum = "x";
  for (int i = 0; i < 5000; ++i) sum.append("+").append(std::to_string(i)).append("*y");
  EXPECT_EQ(limit(sum), "the size expression has 10000 operations; the limit is 4096");
}

TEST(ParseLimits, ValuesAliveAtOnceAreBounded) {
  // Every one of n values is needed by the sum and again by the product of the others.
  const auto shared = [](int n) {
    std::string sum = "0";
    std::string product = "1";
    for (int i = 0; i < n; ++i) {
      const std::string term = "abs(x+" + std::to_string(i) + ")";
      sum += "+" + term;
      product += "*" + term;
    }
    return "(" + sum + ")/(" + product + ")";
  };
  EXPECT_TRUE(Expression::parse(shared(250)));
  EXPECT_NE(limit(shared(300)).find("values at once; the limit is 256"), std::string::npos);
}

TEST(ParseLimits, LongChainsWithinTheLimitsAreAccepted) {
  std::string distance = "1e9";
  std::string cases;
  for (int i = 0; i < 1365; ++i) {
    const std::string n = std::to_string(i);
    distance = i == 0 ? "1" : distance + "+abs(x-" + n + ")";
    cases += "x<" + n + "?" + n + "+y:";
  }
  const Result<Expression> sum = Expression::parse(distance);
  ASSERT_TRUE(sum) << sum.error().message;
  EXPECT_EQ((*sum)({0, 0}), 1 + 1364 * 1365 / 2);
  const Result<Expression> chain = Expression::parse(cases + "-1");
  ASSERT_TRUE(chain) << chain.error().message;
  EXPECT_EQ((*chain)({500.5, 0.25}), 501.25);
  EXPECT_EQ((*chain)({2000, 0}), -1);
}

TEST(ParseLimits, TheWorstSourceIsRefusedQuickly) {
  const double start = processor_seconds();
  std::string distinct;
  for (int i = 0; distinct.size() < kMaxExpressionBytes - 16; ++i) {
    distinct += "+x^" + std::to_string(i) + "." + std::to_string(i % 7 + 1);
  }
  (void)error_of("1" + distinct);
  (void)error_of(repeated("(", kMaxExpressionBytes));
  (void)error_of(std::string(kMaxExpressionBytes, 'a'));
  (void)error_of(std::string(kMaxExpressionBytes, '1'));
  // 20 ms in a release build; the bound is for sanitizers on a busy machine.
  EXPECT_LT(processor_seconds() - start, 5 * slowdown());
}

}  // namespace
}  // namespace weft
