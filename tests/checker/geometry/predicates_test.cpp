// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/predicates.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <random>

namespace weft::check {
namespace {

using Exact = boost::multiprecision::cpp_rational;

int sign_of(const Exact& value) {
  return value.sign();
}

int rational_orientation(Vec2 a, Vec2 b, Vec2 c) {
  return sign_of((Exact(b.x) - a.x) * (Exact(c.y) - a.y) - (Exact(b.y) - a.y) * (Exact(c.x) - a.x));
}

int rational_in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const auto x = [&](Vec2 p) { return Exact(p.x) - d.x; };
  const auto y = [&](Vec2 p) { return Exact(p.y) - d.y; };
  const auto lift = [&](Vec2 p) { return Exact(x(p) * x(p) + y(p) * y(p)); };
  return sign_of(lift(a) * (x(b) * y(c) - x(c) * y(b)) + lift(b) * (x(c) * y(a) - x(a) * y(c)) +
                 lift(c) * (x(a) * y(b) - x(b) * y(a)));
}

TEST(CheckersOrientation, IsPositiveCounterClockwise) {
  EXPECT_GT(orientation({0, 0}, {1, 0}, {0, 1}), 0);
  EXPECT_LT(orientation({0, 0}, {0, 1}, {1, 0}), 0);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(CheckersOrientation, SeesOneUnitInTheLastPlace) {
  const Vec2 a{12, 12}, b{24, 24};
  EXPECT_EQ(orientation(a, b, {0.5, 0.5}), 0);
  EXPECT_GT(orientation(a, b, {0.5, std::nextafter(0.5, 1)}), 0);
  EXPECT_LT(orientation(a, b, {0.5, std::nextafter(0.5, 0)}), 0);
}

TEST(CheckersOrientation, AgreesWithRationalArithmeticNearALine) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> ulps(-3, 3);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 a{real(random), real(random)}, b{real(random), real(random)};
    const double t = real(random);
    Vec2 c{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    c.y += ulps(random) * 0x1p-53;
    EXPECT_EQ(orientation(a, b, c), rational_orientation(a, b, c));
  }
}

TEST(CheckersOrientation, HoldsWhereProductsUnderflowOrOverflow) {
  for (const double scale : {1e-160, 1e-100, 1e100, 1e160, 1e300}) {
    EXPECT_GT(orientation({0, 0}, {scale, 0}, {0, scale}), 0) << scale;
    EXPECT_LT(orientation({0, 0}, {0, scale}, {scale, 0}), 0) << scale;
    EXPECT_EQ(orientation({scale, scale}, {2 * scale, 2 * scale}, {4 * scale, 4 * scale}), 0);
  }
  EXPECT_GT(orientation({0, 0}, {1e150, 0}, {1e150, 1e-150}), 0);
}

TEST(CrossSign, ComparesDirectionsOfSegmentsApart) {
  EXPECT_GT(cross_sign({5, 5}, {6, 5}, {-1, -1}, {-1, 0}), 0);
  EXPECT_EQ(cross_sign({0, 0}, {0.1, 0.1}, {7, 7}, {8, 8}), 0);
}

TEST(CheckersInCircle, IsPositiveStrictlyInside) {
  const Vec2 a{1, 0}, b{0, 1}, c{-1, 0};
  EXPECT_GT(in_circle(a, b, c, {0, 0}), 0);
  EXPECT_EQ(in_circle(a, b, c, {0, -1}), 0);
  EXPECT_LT(in_circle(a, b, c, {0, -2}), 0);
}

TEST(CheckersInCircle, SeesOneUnitInTheLastPlace) {
  const Vec2 a{1, 0}, b{0, 1}, c{-1, 0};
  EXPECT_GT(in_circle(a, b, c, {0, -std::nextafter(1.0, 0)}), 0);
  EXPECT_LT(in_circle(a, b, c, {0, -std::nextafter(1.0, 2)}), 0);
}

TEST(CheckersInCircle, AgreesWithRationalArithmeticNearACircle) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> ulps(-3, 3);
  std::uniform_real_distribution<double> angle(0, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const auto on_circle = [&](double at) {
      return Vec2{3 + std::cos(at) + ulps(random) * 0x1p-52, 5 + std::sin(at)};
    };
    const double first = angle(random);
    const Vec2 a = on_circle(first), b = on_circle(first + 1.6), c = on_circle(first + 3.2);
    const Vec2 d = on_circle(first + 4.5);
    EXPECT_EQ(in_circle(a, b, c, d), rational_in_circle(a, b, c, d));
  }
}

TEST(CheckersInCircle, HoldsWhereProductsUnderflowOrOverflow) {
  for (const double s : {1e-160, 1e-100, 1e-80, 1e80, 1e100, 1e150}) {
    const Vec2 a{s, 0}, b{0, s}, c{-s, 0};
    EXPECT_GT(in_circle(a, b, c, {0, -0.5 * s}), 0) << s;
    EXPECT_EQ(in_circle(a, b, c, {0, -s}), 0) << s;
    EXPECT_LT(in_circle(a, b, c, {0, -2 * s}), 0) << s;
  }
}

}  // namespace
}  // namespace weft::check
