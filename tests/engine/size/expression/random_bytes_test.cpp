// SPDX-License-Identifier: Apache-2.0
// The parser with random bytes: it returns a value or an error.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "engine/size/expression/expression.h"
#include "tests/engine/size/expression/random_expression.h"

namespace weft {
namespace {

void feed(const std::string& source) {
  const Result<Expression> expression = Expression::parse(source);
  if (expression) {
    EXPECT_LE(expression->operations(), Expression::kMaxOperations);
    (void)(*expression)({1, 2});
    (void)expression->bounds({-1, -1, 1, 1});
    return;
  }
  const Error& error = expression.error();
  EXPECT_TRUE(error.code == ErrorCode::kExpressionSyntax ||
              error.code == ErrorCode::kExpressionTooComplex);
  EXPECT_EQ(error.field, "size.expression");
  EXPECT_FALSE(error.message.empty());
  EXPECT_LT(error.message.size(), 400u) << error.message;
  for (char c : error.message) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << error.message;
}

TEST(RandomBytes, AnyBytesAreAnswered) {
  testing::Random random(11);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string source(random.below(40), ' ');
    for (char& c : source) c = static_cast<char>(random.below(256));
    feed(source);
  }
}

TEST(RandomBytes, AnyTokensAreAnswered) {
  static const std::vector<std::string> kTokens = {
      "x",   "y",   "pi", "e",  "1",  ".5", "1e3",   "1e999", "1..2",   "(",
      ")",   ",",   "?",  ":",  "||", "&&", "!",     "<",     "<=",     "==",
      "!=",  "+",   "-",  "*",  "/",  "^",  "sqrt(", "min(",  "clamp(", "pow(",
      "sin", "foo", " ",  "\n", "\t", "@",  "\xff",  "atan2("};
  testing::Random random(12);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string source;
    for (std::size_t i = random.below(20); i > 0; --i)
      source += kTokens[random.below(kTokens.size())];
    feed(source);
  }
}

TEST(RandomBytes, DamagedExpressionsAreAnswered) {
  testing::Random random(13);
  for (int trial = 0; trial < 10000; ++trial) {
    std::string source = testing::ExpressionMaker(random).make(4).text;
    for (std::size_t i = 1 + random.below(3); i > 0 && !source.empty(); --i) {
      const std::size_t at = random.below(source.size());
      switch (random.below(3)) {
        case 0:
          source.erase(at, 1 + random.below(3));
          break;
        case 1:
          source.insert(at, 1, static_cast<char>(random.below(256)));
          break;
        default:
          source[at] = "()+-*/^?:,<>=!&|.e0"[random.below(19)];
      }
    }
    feed(source);
  }
}

}  // namespace
}  // namespace weft
