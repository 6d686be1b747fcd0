// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/predicates.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "engine/domain/triangulation/filtered.h"

namespace weft {
namespace {

TEST(Orientation, TellsLeftRightAndCollinearApart) {
  EXPECT_EQ(orientation_exact({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orientation_exact({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orientation_exact({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Orientation, SeesOneUlpWhereRoundedArithmeticDoesNot) {
  const Point a{12, 12}, b{24, 24};
  const double half = 0.5;
  const double above = std::nextafter(half, 1.0);
  EXPECT_EQ(orientation_exact(a, b, {half, half}), 0);
  EXPECT_EQ(orientation_exact(a, b, {half, above}), 1);
  EXPECT_EQ(orientation_exact(a, b, {above, half}), -1);
}

TEST(Orientation, HoldsAtTheLimitsOfCoordinates) {
  EXPECT_EQ(orientation_exact({-1e100, -1e100}, {1e100, 1e100}, {1e-100, 0}), -1);
  EXPECT_EQ(orientation_exact({-1e-100, 0}, {1e-100, 0}, {0, 1e-100}), 1);
}

TEST(InCircle, ExcludesTheCircleItself) {
  const Point a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_TRUE(in_circle_exact(a, b, c, {0.5, 0.5}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {1, 1}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {2, 2}));
}

TEST(InCircle, SeesOneUlp) {
  const Point a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_TRUE(in_circle_exact(a, b, c, {1, std::nextafter(1.0, 0.0)}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {1, std::nextafter(1.0, 2.0)}));
}

TEST(InCircle, HoldsAtTheLimitsOfCoordinates) {
  EXPECT_TRUE(in_circle_exact({0, 0}, {1e100, 0}, {0, 1e100}, {1e-100, 1e-100}));
  EXPECT_FALSE(in_circle_exact({0, 0}, {1e100, 0}, {0, 1e100}, {-1e-100, 0}));
}

using Exact = mpq_class;

int exact_orientation(Point a, Point b, Point c) {
  const Exact cx(c.x), cy(c.y);
  return sgn((a.x - cx) * (b.y - cy) - (a.y - cy) * (b.x - cx));
}

int exact_in_circle(Point a, Point b, Point c, Point d) {
  const Exact dx(d.x), dy(d.y);
  const Exact ax = a.x - dx, ay = a.y - dy, bx = b.x - dx, by = b.y - dy, cx = c.x - dx,
              cy = c.y - dy;
  return sgn((ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) +
             (cx * cx + cy * cy) * (ax * by - ay * bx));
}

// Of four points, how often the filter could not tell by itself is not seen from outside: the sign
// must be right either way.
void expect_exact_signs(const std::array<Point, 4>& p) {
  const auto [a, b, c, d] = p;
  ASSERT_EQ(orientation(a, b, c), exact_orientation(a, b, c));
  const int turn = orientation(a, b, c);
  if (turn == 0) return;
  ASSERT_EQ(turn > 0 ? in_circle(a, b, c, d) : in_circle(a, c, b, d),
            turn > 0 ? exact_in_circle(a, b, c, d) : exact_in_circle(a, c, b, d));
}

TEST(Filter, AgreesWithExactArithmeticOnGridsOfEveryScale) {
  // On small grids most points are on a line or on a circle; from about 1e-77 on the products of
  // four differences underflow, from 1e-155 on those of two.
  std::mt19937 random(1);
  for (int exponent = -1060; exponent <= 160; exponent += 5) {
    const double unit = std::ldexp(1, exponent);
    for (int round = 0; round < 300; ++round) {
      std::array<Point, 4> p;
      for (Point& q : p) q = {unit * (random() % 7), unit * (random() % 7)};
      expect_exact_signs(p);
    }
  }
}

TEST(Filter, AgreesWithExactArithmeticNearDegeneracy) {
  // On a line or a circle, then up to two ulps off.
  std::mt19937 random(2);
  for (const double offset : {0.0, 1.0, 1e6, 1e15}) {
    for (const double scale : {1e-150, 1e-100, 1e-60, 1e-20, 1.0, 1e35}) {
      for (int round = 0; round < 500; ++round) {
        std::array<Point, 4> p;
        const bool on_line = random() % 2 == 0;
        for (Point& q : p) {
          const double t = random() / 4294967296.0 * 6.28;
          q = on_line ? Point{offset + t, offset + 0.3 * t}
                      : Point{offset + std::cos(t), offset + std::sin(t)};
          q = {scale * q.x, scale * q.y};
          for (unsigned k = random() % 3; k > 0; --k) q.x = std::nextafter(q.x, 1e300);
        }
        expect_exact_signs(p);
      }
    }
  }
}

TEST(Filter, AgreesWithExactArithmeticOnUnequalMagnitudes) {
  std::mt19937 random(3);
  const auto any = [&] {
    const double magnitude = std::pow(10, -100 + 150 * (random() / 4294967296.0));
    return random() % 6 == 0 ? 0 : random() % 2 == 0 ? magnitude : -magnitude;
  };
  for (int round = 0; round < 20000; ++round) {
    std::array<Point, 4> p;
    for (Point& q : p) {
      q.x = any();
      q.y = any();
    }
    if (round % 2 == 0) p[2] = {p[0].x * 0.5, p[0].y * 0.5};
    if (round % 3 == 0) p[1] = {-p[0].x, -p[0].y};
    expect_exact_signs(p);
  }
}

}  // namespace
}  // namespace weft
