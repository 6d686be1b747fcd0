// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/arc_meeting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A quarter of the unit circle around c, from an angle on.
ArcPiece quarter(Point c, double from, std::uint32_t first = 0, std::uint32_t last = 1) {
  const auto at = [&](double angle) { return Point{c.x + std::cos(angle), c.y + std::sin(angle)}; };
  return {first, last, at(from), at(from + kPi / 2), std::tan(kPi / 8)};
}

TEST(ArcMeeting, CirclesCrossWhereTheyShould) {
  const auto at = crossing_of(quarter({0, 0}, 0.2), quarter({1, 0}, kPi / 2, 2, 3), 1e-12);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 0.5, 1e-15);
  EXPECT_NEAR(at->y, std::sqrt(0.75), 1e-15);
}

TEST(ArcMeeting, ALineCrossesAnArc) {
  const ArcPiece line(2, 3, {-1, 0.5}, {2, 0.5}, 0);
  for (const auto& at : {crossing_of(quarter({0, 0}, 0), line, 1e-12),
                         crossing_of(line, quarter({0, 0}, 0), 1e-12)}) {
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, std::sqrt(0.75), 1e-15);
    EXPECT_NEAR(at->y, 0.5, 1e-15);
  }
}

TEST(ArcMeeting, NothingCrossesBeyondTheEnds) {
  EXPECT_FALSE(crossing_of(quarter({0, 0}, 0.2), quarter({1, 0}, -kPi / 2, 2, 3), 1e-12));
  EXPECT_FALSE(crossing_of(quarter({0, 0}, 0), {2, 3, {-2, 0.5}, {-1, 0.5}, 0}, 1e-12));
  EXPECT_FALSE(crossing_of(quarter({0, 0}, 0), quarter({0, 0}, kPi / 2, 1, 2), 1e-12));
}

TEST(ArcMeeting, TheOtherHalfOfACircleIsNotNear) {
  const ArcPiece half(0, 1, {1, 0}, {-1, 0}, 1);
  EXPECT_TRUE(half.is_near({0, 1}, 1e-12));
  EXPECT_FALSE(half.is_near({0, -1}, 1e-12));
  EXPECT_FALSE(half.is_near({0.5, 0.5}, 1e-12));
}

TEST(ArcMeeting, HullsOfArcsThatBulgeTowardsEachOtherMeet) {
  const ArcPiece low(0, 1, {1, 0}, {0, 0}, 0.5);  // bulges up
  const ArcPiece high(2, 3, {0, 0.6}, {1, 0.6}, 0.5);
  EXPECT_TRUE(hulls_meet(low, high));
  EXPECT_FALSE(hulls_meet(low, {2, 3, {0, 0.7}, {1, 0.7}, -0.5}));
  EXPECT_FALSE(hulls_meet(low, {2, 3, {0, 0.7}, {1, 0.7}, 0}));
}

TEST(ArcMeeting, AtACommonEndConesCount) {
  const ArcPiece arc(0, 1, {1, 0}, {0, 0}, 0.5);
  EXPECT_TRUE(hulls_meet(arc, {1, 2, {0, 0}, {1, 0.2}, 0}));
  EXPECT_FALSE(hulls_meet(arc, {1, 2, {0, 0}, {1, -0.1}, 0}));
  EXPECT_FALSE(hulls_meet(arc, {1, 2, {0, 0}, {-1, 0}, 0}));
}

TEST(ArcMeeting, ACircleLeavesATangentTogetherWithIt) {
  const ArcPiece arc(0, 1, {0, 0}, {1, 1}, std::tan(kPi / 8));
  EXPECT_TRUE(leave_together(arc, {0, 2, {0, 0}, {5, 0}, 0}, 0));
  EXPECT_FALSE(leave_together(arc, {0, 2, {0, 0}, {-5, 0}, 0}, 0));
  EXPECT_FALSE(leave_together(arc, {0, 2, {0, 0}, {5, 0.01}, 0}, 0));
  EXPECT_TRUE(leave_together(arc, {1, 2, {1, 1}, {1, -3}, 0}, 1));
}

}  // namespace
}  // namespace weft
