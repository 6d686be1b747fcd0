// SPDX-License-Identifier: Apache-2.0
// Bounds over boxes: never narrower than the values, and as tight as promised.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/size/expression/expression.h"
#include "tests/engine/size/expression/random_expression.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Interval bounds(const std::string& source, const Box& box) {
  const Result<Expression> expression = Expression::parse(source);
  if (!expression) throw std::runtime_error(expression.error().message);
  return expression->bounds(box);
}

void expect_bounds(const std::string& source, const Box& box, double lo, double hi,
                   bool may_be_nan = false) {
  const Interval b = bounds(source, box);
  EXPECT_EQ(b.lo, lo) << source;
  EXPECT_EQ(b.hi, hi) << source;
  EXPECT_EQ(b.may_be_nan, may_be_nan) << source;
}

void expect_near(const std::string& source, const Box& box, double lo, double hi,
                 bool may_be_nan = false) {
  const Interval b = bounds(source, box);
  EXPECT_LE(b.lo, lo) << source;
  EXPECT_GE(b.hi, hi) << source;
  EXPECT_NEAR(b.lo, lo, 1e-13 * std::abs(lo) + 1e-299) << source;
  EXPECT_NEAR(b.hi, hi, 1e-13 * std::abs(hi) + 1e-299) << source;
  EXPECT_EQ(b.may_be_nan, may_be_nan) << source;
}

// -0 below +0.
bool at_most(double a, double b) {
  return a < b || (a == b && std::signbit(a) >= std::signbit(b));
}

bool contains(const Interval& b, double v) {
  return std::isnan(v) ? b.may_be_nan : at_most(b.lo, v) && at_most(v, b.hi);
}

Box random_box(testing::Random& random) {
  Box box;
  box.add({random.coordinate(), random.coordinate()});
  if (random.chance(8)) return box;
  const double size = std::ldexp(1, -static_cast<int>(random.below(50)));
  const bool small = random.chance(2);
  box.add(small ? Point{box.min_x + size, box.min_y + size}
                : Point{random.coordinate(), random.coordinate()});
  return box;
}

double random_between(testing::Random& random, double lo, double hi) {
  switch (random.below(8)) {
    case 0:
      return lo;
    case 1:
      return hi;
    case 2:
      return lo <= 0 && hi >= 0 ? (random.chance(2) ? 0.0 : -0.0) : lo;
    case 3: {
      const double whole = std::floor(random.between(lo, hi));
      return whole >= lo ? whole : hi;
    }
    default:
      return random.between(lo, hi);
  }
}

TEST(Bounds, HoldEveryValueOfThousandsOfRandomExpressionsBitForBit) {
  testing::Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const std::string source = testing::ExpressionMaker(random).make(1 + trial % 5).text;
    const Result<Expression> expression = Expression::parse(source);
    ASSERT_TRUE(expression) << source;
    for (int b = 0; b < 4; ++b) {
      const Box box = random_box(random);
      const Interval interval = expression->bounds(box);
      ASSERT_FALSE(std::isnan(interval.lo) || std::isnan(interval.hi)) << source;
      for (int i = 0; i < 12; ++i) {
        const Point p{random_between(random, box.min_x, box.max_x),
                      random_between(random, box.min_y, box.max_y)};
        const double v = (*expression)(p);
        ASSERT_TRUE(contains(interval, v))
            << source << "\nat " << p.x << ", " << p.y << " is " << v << ", not in [" << interval.lo
            << ", " << interval.hi << "]\nbox " << box.min_x << " " << box.max_x << " x "
            << box.min_y << " " << box.max_y;
      }
    }
  }
}

TEST(Bounds, OfABoxThatIsAPointAreTheValueWhereNothingIsWidened) {
  testing::Random random(2);
  for (const char* source : {"x*y - x/7 + sqrt(abs(y))", "x^3 - y^2", "min(x, y)*max(x, 0.3)",
                             "floor(x) + ceil(y)", "x < y ? x : -y"}) {
    const Expression expression = Expression::parse(source).value();
    for (int i = 0; i < 200; ++i) {
      const Point p{random.between(-8, 8), random.between(-8, 8)};
      const Interval b = expression.bounds({p.x, p.y, p.x, p.y});
      EXPECT_EQ(b.lo, expression(p)) << source;
      EXPECT_EQ(b.hi, expression(p)) << source;
    }
  }
}

TEST(Bounds, CollapseWhereAPiecewiseConstantExpressionIsConstant) {
  const std::string cylinder = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";
  expect_bounds(cylinder, {1, -4, 30, 4}, 1.2e-3, 1.2e-3);
  expect_bounds(cylinder, {-30, 6, 30, 9}, 1e-2, 1e-2);
  expect_bounds(cylinder, {-2, -2, -1, 2}, 1.2e-3, 1.2e-3);
  expect_bounds(cylinder, {1, 4, 2, 6}, 1.2e-3, 1e-2);
  expect_bounds("hypot(x, y) < 1 ? 1 : 2", {3, 3, 4, 4}, 2, 2);
  expect_bounds("floor(x)", {1.2, 0, 1.8, 9}, 1, 1);
}

TEST(Bounds, OfArithmeticAreItsEndPoints) {
  expect_bounds("x + y", {1, 10, 2, 20}, 11, 22);
  expect_bounds("x - y", {1, 10, 2, 20}, -19, -8);
  expect_bounds("x * y", {-2, 3, 5, 4}, -8, 20);
  expect_bounds("x / y", {-2, 4, 6, 8}, -0.5, 1.5);
  expect_bounds("-x", {-2, 0, 6, 0}, -6, 2);
  expect_bounds("abs(x)", {-2, 0, 6, 0}, 0, 6);
  expect_bounds("sqrt(x)", {4, 0, 9, 0}, 2, 3);
  expect_bounds("min(x, y)", {1, 3, 5, 4}, 1, 4);
  expect_bounds("max(x, y)", {1, 3, 5, 4}, 3, 5);
  expect_bounds("clamp(x, 2, 3)", {0, 0, 9, 0}, 2, 3);
}

TEST(Bounds, OfPowersKnowTheirSign) {
  expect_bounds("x^2", {-3, 0, 2, 0}, 0, 9);
  expect_bounds("x*x", {-3, 0, 2, 0}, 0, 9);
  expect_bounds("x^3", {-3, 0, 2, 0}, -27, 8);
  expect_bounds("x^-2", {-2, 0, 4, 0}, 1.0 / 16, kInfinity);
  expect_bounds("x^-1", {2, 0, 4, 0}, 0.25, 0.5);
  expect_bounds("x^-1", {-2, 0, 4, 0}, -kInfinity, kInfinity);
  expect_bounds("x^16", {-2, 0, 1, 0}, 0, 65536);
}

TEST(Bounds, OfAQuotientBySomethingNotNegativeAreOneSided) {
  expect_bounds("1/(x^2 + y^2)", {-3, -4, 3, 4}, 1.0 / 25, kInfinity);
  expect_bounds("1/abs(x)", {-2, 0, 2, 0}, 0.5, kInfinity);
  expect_bounds("1/x", {0, 0, 2, 0}, -kInfinity, kInfinity);
}

TEST(Bounds, SayWhereNanMayBe) {
  expect_bounds("sqrt(x)", {-1, 0, 4, 0}, 0, 2, true);
  expect_bounds("x/y", {-1, -1, 1, 1}, -kInfinity, kInfinity, true);
  expect_bounds("sqrt(x) < 3", {-1, 0, 4, 0}, 0, 1);
  expect_bounds("sqrt(x) != 3", {-1, 0, 4, 0}, 1, 1);
  expect_bounds("sqrt(x) > 3", {-1, 0, 4, 0}, 0, 0);
  expect_bounds("x < 0 ? 1 : sqrt(x)", {-2, 0, -1, 0}, 1, 1);
  EXPECT_TRUE(bounds("log(x)", {-1, 0, 1, 0}).may_be_nan);
  EXPECT_TRUE(bounds("pow(x, 1.5)", {-1, 0, 1, 0}).may_be_nan);
  EXPECT_FALSE(bounds("pow(x, 1.5)", {0, 0, 1, 0}).may_be_nan);
  EXPECT_TRUE(bounds("min(1, sqrt(x))", {-1, 0, 1, 0}).may_be_nan);
}

TEST(Bounds, OfFunctionsAreTightToFourteenDigits) {
  using std::numbers::pi;
  expect_near("exp(x)", {0, 0, 1, 0}, 1, std::exp(1));
  expect_near("log(x)", {1.5, 0, 4, 0}, std::log(1.5), std::log(4));
  expect_near("sin(x)", {0.1, 0, 0.2, 0}, std::sin(0.1), std::sin(0.2));
  expect_near("sin(x)", {1, 0, 2, 0}, std::sin(1), 1);
  expect_near("sin(x)", {4, 0, 5, 0}, -1, std::sin(4));
  expect_near("sin(x)", {-100, 0, 100, 0}, -1, 1);
  expect_near("cos(x)", {-1, 0, 2, 0}, std::cos(2), 1);
  expect_near("cos(x)", {3, 0, 4, 0}, -1, std::cos(4));
  expect_near("cos(x)", {1001, 0, 1001.5, 0}, std::cos(1001.5), std::cos(1001));
  expect_near("tan(x)", {-1, 0, 1, 0}, -std::tan(1), std::tan(1));
  expect_bounds("tan(x)", {1, 0, 2, 0}, -kInfinity, kInfinity);
  expect_near("hypot(x, y)", {-3, 4, 1, 5}, 4, std::hypot(3, 5));
  expect_near("atan2(y, x)", {1, -1, 2, 1}, -pi / 4, pi / 4);
  expect_near("atan2(y, x)", {-1, 1, 1, 2}, pi / 4, 3 * pi / 4);
  expect_near("atan2(y, x)", {-1, -1, 1, 1}, -pi, pi);
  expect_near("pow(x, 1.5)", {4, 0, 9, 0}, 8, 27);
  expect_near("x^18", {-2, 0, 1, 0}, 0, 262144);
  expect_near("x^17", {-1, 0, 2, 0}, -131072, 131072);
}

TEST(Bounds, OfAnEmptyBoxAreAnything) {
  const Interval b = bounds("x + y", Box{});
  EXPECT_EQ(b.lo, -kInfinity);
  EXPECT_EQ(b.hi, kInfinity);
  EXPECT_TRUE(b.may_be_nan);
}

TEST(Bounds, FindAFineDiscInALargeBox) {
  const Interval b = bounds("(x-20)^2 + (y-3)^2 < 1 ? 1e-4 : 1", {-30, -20, 35, 20});
  EXPECT_EQ(b.lo, 1e-4);
  EXPECT_EQ(b.hi, 1);
}

}  // namespace
}  // namespace weft
