// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::files {
namespace {

TEST(SplineArcs, OfARationalQuarterOfACircleAreOneArc) {
  const Spline quarter{2, {0, 0, 0, 1, 1, 1}, {1, std::sqrt(0.5), 1}, {{1, 0}, {1, 1}, {0, 1}}};
  ASSERT_TRUE(quarter.is_sound());
  const ArcChain chain = arcs_of(quarter);
  EXPECT_EQ(chain.points, (std::vector<Point>{{1, 0}, {0, 1}}));
  EXPECT_NEAR(chain.bulges[0], std::tan(std::numbers::pi / 8), 1e-15);
}

TEST(SplineArcs, HaveTheKinksOfTheSpline) {
  // Lines: a knot at each corner. Cubics: a knot three times over, where two of them meet.
  const ArcChain lines = arcs_of({1, {0, 0, 1, 2, 3, 3}, {}, {{0, 0}, {2, 0}, {2, 2}, {0, 2}}});
  EXPECT_EQ(lines.points, (std::vector<Point>{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_EQ(lines.bulges, std::vector<double>(4, 0));
  const Spline kinked{3,
                      {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2},
                      {},
                      {{0, 0}, {1, 0}, {2, 1}, {2, 2}, {3, 2}, {4, 1}, {4, 0}}};
  ASSERT_TRUE(kinked.is_sound());
  const ArcChain chain = arcs_of(kinked);
  const auto corner = std::ranges::find(chain.points, Point{2, 2});
  ASSERT_NE(corner, chain.points.end());
  const auto i = static_cast<std::size_t>(corner - chain.points.begin());
  const auto direction_of = [&](std::size_t s, double turn) {
    const Point a = chain.points[s], b = chain.points[s + 1];
    return std::atan2(b.y - a.y, b.x - a.x) + turn * std::atan(chain.bulges[s]);
  };
  EXPECT_NEAR(direction_of(i - 1, 2), std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(direction_of(i, -2), 0, 1e-9);
}

TEST(SplineArcs, StartAtControlPointsThatCoincide) {
  const ArcChain chain =
      arcs_of({3, {0, 0, 0, 0, 1, 1, 1, 1}, {}, {{0, 0}, {0, 0}, {1, 0}, {1, 1}}});
  EXPECT_LT(chain.points.size(), 40u);
  // y = t^3, x = 3 t^2 - 2 t^3: up to the right, ever steeper.
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
    EXPECT_LT(chain.points[i].y, chain.points[i + 1].y);
    EXPECT_GE(chain.bulges[i], 0);
  }
}

TEST(SplineArcs, AreOfCurvesWhoseNumbersBelongTogether) {
  Spline spline{1, {0, 0, 1, 1}, {}, {{0, 0}, {1, 0}}};
  EXPECT_TRUE(spline.is_sound());
  spline.weights = {1};
  EXPECT_FALSE(spline.is_sound());
  spline.weights = {1, -1};
  EXPECT_FALSE(spline.is_sound());
  EXPECT_FALSE((Spline{1, {0, 1, 0, 1}, {}, {{0, 0}, {1, 0}}}.is_sound()));
  EXPECT_FALSE((Spline{1, {0, 0, 0, 0}, {}, {{0, 0}, {1, 0}}}.is_sound()));
  EXPECT_FALSE((Spline{26, {}, {}, {}}.is_sound()));
}

}  // namespace
}  // namespace weft::files
