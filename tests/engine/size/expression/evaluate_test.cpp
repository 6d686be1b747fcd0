// SPDX-License-Identifier: Apache-2.0
// Values: the same in every batch and on every machine, and what they should be.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/expression/expression.h"
#include "tests/engine/size/expression/random_expression.h"

namespace weft {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Expression parsed(const std::string& source) {
  Result<Expression> expression = Expression::parse(source);
  if (!expression) throw std::runtime_error(expression.error().message);
  return *std::move(expression);
}

double value(const std::string& source, double x, double y) {
  return parsed(source)({x, y});
}

// All NaNs are equal: which one it is must not matter.
std::uint64_t bits(double v) {
  return std::bit_cast<std::uint64_t>(std::isnan(v) ? kNan : v);
}

TEST(Evaluate, MeansWhatTheGrammarSaysOnThousandsOfRandomExpressions) {
  testing::Random random(20060501);
  for (int trial = 0; trial < 4000; ++trial) {
    const testing::Sample sample = testing::ExpressionMaker(random).make(1 + trial % 6);
    const Result<Expression> expression = Expression::parse(sample.text);
    ASSERT_TRUE(expression) << sample.text << "\n" << expression.error().message;
    for (int i = 0; i < 8; ++i) {
      const double x = random.coordinate();
      const double y = random.coordinate();
      ASSERT_EQ(bits((*expression)({x, y})), bits(sample.value(x, y)))
          << sample.text << " at " << x << ", " << y << ": " << (*expression)({x, y}) << " and "
          << sample.value(x, y);
    }
  }
}

TEST(Evaluate, AValueDoesNotDependOnTheBatch) {
  constexpr std::size_t kPoints = 40;
  testing::Random random(7);
  for (int trial = 0; trial < 500; ++trial) {
    const testing::Sample sample = testing::ExpressionMaker(random).make(5);
    const Expression expression = parsed(sample.text);
    alignas(64) std::array<double, kPoints> x;
    alignas(64) std::array<double, kPoints> y;
    alignas(64) std::array<double, kPoints> out;
    for (std::size_t i = 0; i < kPoints; ++i) {
      x[i] = random.coordinate();
      y[i] = random.coordinate();
    }
    expression.evaluate(kPoints, x.data(), y.data(), out.data());
    for (std::size_t i = 0; i < kPoints; ++i) {
      ASSERT_EQ(bits(out[i]), bits(expression({x[i], y[i]}))) << sample.text;
    }
  }
}

TEST(Evaluate, WritesTheBatchRoundedUpAndNothingBeyond) {
  const Expression expression = parsed("x + y");
  for (std::size_t n = 0; n <= 24; ++n) {
    alignas(64) std::array<double, 40> x;
    alignas(64) std::array<double, 40> out;
    x.fill(1);
    out.fill(-7);
    expression.evaluate(n, x.data(), x.data(), out.data());
    const std::size_t rounded = (n + 7) / 8 * 8;
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(out[i], 2);
    for (std::size_t i = rounded; i < 40; ++i) EXPECT_EQ(out[i], -7);
  }
}

TEST(Evaluate, GivesTheSameBitsOnEveryMachineAndFromEveryCompiler) {
  // FNV-1a over the bits of each expression at 4,096 points; recorded once.
  const std::vector<std::pair<std::string, std::uint64_t>> recorded = {
      {"x*y + 0.1*x - y/3", 0x1867aea036347af2u},
      {"0.4*sqrt((x-200)^2+(y-200)^2)+1", 0x25aa9319003ee52eu},
      {"sin(x) + cos(y)*tan(x*y)", 0x7e65f50717ec634au},
      {"exp(-x^2/50)*log(abs(y)+1)", 0x6bdd5c315a9f12ecu},
      {"pow(abs(x), 1.3) + abs(y)^-0.7", 0xa6674af34f422bf6u},
      {"hypot(x, y) + atan2(y, x)", 0xf8ec89aebb257277u},
  };
  for (const auto& [source, digest] : recorded) {
    const Expression expression = parsed(source);
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 4096; ++i) {
      const double x = (i % 64 - 31.7) * 1.37;
      const double y = (i / 64 - 30.1) * 0.83;
      std::uint64_t word = bits(expression({x, y}));
      for (int byte = 0; byte < 8; ++byte, word >>= 8) {
        hash = (hash ^ (word & 0xff)) * 0x100000001b3u;
      }
    }
    EXPECT_EQ(hash, digest) << source;
  }
}

TEST(Evaluate, FunctionsAgreeWithTheMathematicalLibraryToFourUnitsInTheLastPlace) {
  using Unary = double (*)(double);
  const std::vector<std::pair<std::string, Unary>> functions = {
      {"sin(x)", std::sin},
      {"cos(x)", std::cos},
      {"tan(x)", std::tan},
      {"exp(x)", std::exp},
      {"log(abs(x))", [](double v) { return std::log(std::abs(v)); }},
  };
  testing::Random random(3);
  for (const auto& [source, reference] : functions) {
    const Expression expression = parsed(source);
    for (int i = 0; i < 2000; ++i) {
      const double x = random.between(-100, 100);
      const double expected = reference(x);
      EXPECT_NEAR(expression({x, 0}), expected, 4 * 0x1p-52 * std::abs(expected)) << source << x;
    }
  }
}

TEST(Evaluate, TheSideNotTakenHasNoEffect) {
  EXPECT_EQ(value("x < 0 ? sqrt(-x) : sqrt(x)", 4, 0), 2);
  EXPECT_EQ(value("x < 0 ? sqrt(-x) : sqrt(x)", -9, 0), 3);
  EXPECT_EQ(value("x == 0 ? 1 : 1/x", 0, 0), 1);
  EXPECT_EQ(value("x > 0 ? log(x) : 7", -1, 0), 7);
}

TEST(Evaluate, DivisionByZeroIsIeees) {
  EXPECT_EQ(value("1/x", 0, 0), kInfinity);
  EXPECT_EQ(value("-1/x", 0, 0), -kInfinity);
  EXPECT_TRUE(std::isnan(value("x/y", 0, 0)));
  EXPECT_EQ(value("1/(x-y)", 2, 2), kInfinity);
  EXPECT_EQ(value("x^-2", 0, 0), kInfinity);
}

TEST(Evaluate, MinAndMaxOfNanAreNanFromEitherSide) {
  for (const char* source : {"min(sqrt(x), 1)", "min(1, sqrt(x))", "max(sqrt(x), 1)",
                             "max(1, sqrt(x))", "clamp(sqrt(x), 0, 1)", "min(1, 2, sqrt(x), 3)"}) {
    EXPECT_TRUE(std::isnan(value(source, -1, 0))) << source;
    EXPECT_FALSE(std::isnan(value(source, 1, 0))) << source;
  }
}

TEST(Evaluate, ComparisonsWithNanAreFalseButForNotEqual) {
  for (const char* source : {"sqrt(x) < 1", "sqrt(x) <= 1", "sqrt(x) > 1", "sqrt(x) >= 1",
                             "sqrt(x) == 1", "sqrt(x) == sqrt(x)"}) {
    EXPECT_EQ(value(source, -1, 0), 0) << source;
  }
  EXPECT_EQ(value("sqrt(x) != 1", -1, 0), 1);
}

TEST(Evaluate, EqualSubexpressionsAreComputedOnce) {
  EXPECT_EQ(parsed("sin(x)").operations(), 1u);
  EXPECT_EQ(parsed("sin(x) + sin(x)").operations(), 2u);
  EXPECT_EQ(parsed("(x+y)*(y+x)").operations(), 2u);
  EXPECT_EQ(parsed("2*3*x").operations(), 1u);
  EXPECT_EQ(parsed("x < 1 && x < 1 ? x : y").operations(), 2u);
}

}  // namespace
}  // namespace weft
