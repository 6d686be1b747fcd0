// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace weft {
namespace {

// The box around a point with this reach to all sides.
Box around(Point p, double reach) {
  return {p.x - reach, p.y - reach, p.x + reach, p.y + reach};
}

TEST(Hull, MissesBoxesBeyondASideAndNoneThatReachesIn) {
  const Hull hull({{0, 0}, {4, 0}, {1, 1}, {0, 4}});
  EXPECT_TRUE(hull.misses({3, 3, 5, 5}));  // beside the long side only
  EXPECT_TRUE(hull.misses({-2, 1, -1, 2}));
  EXPECT_FALSE(hull.misses({1.5, 1.5, 3, 3}));
  EXPECT_FALSE(hull.misses({-9, -9, 9, 9}));
}

TEST(Hull, KeepsBoxesThatTouchIt) {
  const Hull hull({{0, 0}, {0.3, 0.1}, {0.1, 0.3}});
  for (const Point p : {Point{0, 0}, Point{0.3, 0.1}, Point{0.1, 0.3}, Point{0.2, 0.2}})
    EXPECT_FALSE(hull.misses(around(p, 0))) << p.x << " " << p.y;
}

// It has the longest 64 of these 1,000.
TEST(Hull, KeepsAllOfADiskOfMoreSidesThanItHas) {
  std::vector<Point> points;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 1000;
    points.push_back({std::cos(angle), std::sin(angle)});
  }
  const Hull hull(points);
  for (const Point p : points) EXPECT_FALSE(hull.misses(around(p, 0)));
}

TEST(Hull, HoldsItsPointsWhereverTheyLie) {
  std::mt19937 random(5);
  for (const double offset : {0.0, 1e6}) {
    std::uniform_real_distribution<double> place(offset, offset + 1);
    for (int round = 0; round < 20; ++round) {
      std::vector<Point> points(200);
      for (Point& p : points) p = {place(random), place(random)};
      const Hull hull(points);
      for (const Point p : points) EXPECT_FALSE(hull.misses(around(p, 0)));
    }
  }
}

TEST(Hull, OfPointsOnALineMissesBoxesBesideIt) {
  const Hull hull({{0, 0}, {1, 1}, {2, 2}});
  EXPECT_FALSE(hull.misses({0.5, 0.4, 0.6, 0.5}));
  EXPECT_TRUE(hull.misses({1, 0, 1.4, 0.5}));
  EXPECT_TRUE(hull.misses({0, 1, 0.5, 1.4}));
}

}  // namespace
}  // namespace weft
