// SPDX-License-Identifier: Apache-2.0
// Bounds of the steepness of expressions over boxes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "engine/size/expression/expression.h"
#include "tests/engine/size/fields/field_laws.h"

namespace weft {
namespace {

double steepness(const char* text, const Box& box) {
  return Expression::parse(text)->steepness(box);
}

TEST(Steepness, HoldsBetweenPointsOfRandomBoxes) {
  for (const char* text : {"x",
                           "-y",
                           "3*x - 4*y",
                           "abs(x) - abs(y-1)",
                           "sqrt(x^2 + 1)",
                           "exp(x/2)",
                           "log(x + 9)",
                           "sin(3*x)*cos(2*y)",
                           "tan(x/4)",
                           "x^2",
                           "x^3*y^5",
                           "x^-2",
                           "(x+9)^1.7",
                           "(x+9)^(y/3)",
                           "x/(y+9)",
                           "hypot(x, y)",
                           "hypot(3*x, x+y)",
                           "atan2(y+9, x)",
                           "min(x, y, 1)",
                           "max(3*x, -y)",
                           "clamp(2*x, -1, 1)",
                           "floor(x/3)",
                           "x < 2 ? x : 2*y",
                           "x > 99 ? x : y",
                           "coalesce(sqrt(x), 1)",
                           "sqrt(x)",
                           "defined(x) ? 2*x : y"}) {
    SCOPED_TRACE(text);
    expect_bounds_to_hold(*Expression::parse(text), {-4, -4, 4, 4}, 0.5, 2000, true, 11);
  }
}

TEST(Steepness, IsTight) {
  EXPECT_EQ(steepness("3*x - 4*y", {0, 0, 1, 1}), 5);
  EXPECT_EQ(steepness("hypot(x, y)", {-5, -5, 5, 5}), 1);
  EXPECT_EQ(steepness("500 + 0.15*hypot(x-3, y)", {-5, -5, 5, 5}), 0.15);
  EXPECT_NEAR(steepness("x^2 + y^2", {3, 4, 3.01, 4.01}), 10, 0.03);
  EXPECT_NEAR(steepness("sqrt(x^2 + y^2)", {3, 4, 3.01, 4.01}), 1, 0.01);
  EXPECT_NEAR(steepness("exp(x)", {2, 0, 2.001, 1}), std::exp(2), 0.01);
  EXPECT_EQ(steepness("clamp(9*x, -1, 1)", {1, 0, 2, 1}), 0);
  EXPECT_EQ(steepness("min(9*x, y+99)", {-1, 0, 1, 1}), 9);
  EXPECT_EQ(steepness("floor(x)", {0.1, 0, 0.9, 1}), 0);
  EXPECT_EQ(steepness("x < 5 ? 2*x : y", {0, 0, 1, 1}), 2);
}

TEST(Steepness, IsInfiniteAtJumpsAndPoles) {
  const Box box{-1, -1, 1, 1};
  for (const char* text : {"floor(x)", "x < 0 ? 1 : 2", "1/x", "log(x)", "sqrt(x)", "tan(2*x)",
                           "atan2(y, x)", "coalesce(sqrt(x), 9)", "(x > 0) + y"})
    EXPECT_TRUE(std::isinf(steepness(text, box))) << text;
}

}  // namespace
}  // namespace weft
