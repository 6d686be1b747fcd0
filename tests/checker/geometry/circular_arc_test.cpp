// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/circular_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft::check::testing {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CircularArc, TurnsAsItsBulgeSays) {
  const CircularArc half({1, 0}, {-1, 0}, 1);  // to the left: through (0, 1)
  EXPECT_DOUBLE_EQ(half.turn(), kPi);
  EXPECT_DOUBLE_EQ(half.radius(), 1);
  EXPECT_NEAR(half.at(kPi / 2).x, 0, 1e-15);
  EXPECT_NEAR(half.at(kPi / 2).y, 1, 1e-15);
  EXPECT_NEAR(CircularArc({1, 0}, {-1, 0}, -1).at(kPi / 2).y, -1, 1e-15);
}

TEST(CircularArc, KnowsAnglesAndDistancesOfAllTurns) {
  for (const double degrees : {1e-3, 20.0, 90.0, 180.0, 270.0, 359.0})
    for (const double sign : {1.0, -1.0}) {
      const double turn = degrees * kPi / 180, start = 0.7;
      const Vec2 centre{3, -2};
      const auto at = [&](double angle, double radius) {
        return Vec2{centre.x + radius * std::cos(start + sign * angle),
                    centre.y + radius * std::sin(start + sign * angle)};
      };
      const CircularArc arc(at(0, 2), at(turn, 2), sign * std::tan(turn / 4));
      EXPECT_NEAR(arc.turn(), turn, 1e-15);
      for (const double part : {-0.001, 0.0, 0.1, 0.5, 0.9, 1.0, 1.001}) {
        const double angle = part * turn;
        // What its rounded ends make of it.
        const double by = 1e-14 / std::sin(turn / 2) * std::max(1.0, turn);
        EXPECT_NEAR(arc.angle(at(angle, 2)), angle, by) << degrees << " " << part;
        EXPECT_NEAR(arc.distance(at(angle, 2)), 0, by);
        EXPECT_NEAR(arc.distance(at(angle, 2.25)), 0.25, 1e-3 * turn + by);
        EXPECT_NEAR(arc.distance(at(angle, 1.75)), -0.25, 1e-3 * turn + by);
        const Vec2 tangent = arc.tangent(angle), ahead = at(angle + 1e-6, 2);
        EXPECT_NEAR(tangent.x, (ahead.x - at(angle, 2).x) / 2e-6, 1e-6);
        EXPECT_NEAR(tangent.y, (ahead.y - at(angle, 2).y) / 2e-6, 1e-6);
        EXPECT_NEAR(std::hypot(arc.at(angle).x - at(angle, 2).x, arc.at(angle).y - at(angle, 2).y),
                    0, by);
      }
    }
}

TEST(CircularArc, KeepsItsDigitsIfItIsNearlyStraight) {
  // Of bulge t and half chord 1: the highest point is t over the chord.
  for (const double bulge : {1e-3, 1e-6, 1e-9, 1e-30}) {
    const CircularArc arc({-1, 5}, {1, 5}, -bulge);
    EXPECT_NEAR(arc.at(arc.turn() / 2).y, 5 + bulge, 1e-15);
    EXPECT_NEAR(arc.distance({0, 5 + bulge}), 0, 1e-15);
    EXPECT_NEAR(arc.distance({0, 5}), -bulge, 1e-15);
    EXPECT_NEAR(arc.angle({0, 5 + bulge}) / arc.turn(), 0.5, 1e-15);
  }
}

TEST(CircularArc, TangentsMeetOverTheMiddleOfAChord) {
  const Vec2 p{1, 0}, q{0, 1};
  const CircularArc arc(p, q, std::tan(kPi / 8));
  const Vec2 corner = arc.side(p, q, CircularArc::height(p, q, kPi / 2));
  EXPECT_NEAR(corner.x, 1, 1e-15);
  EXPECT_NEAR(corner.y, 1, 1e-15);
}

}  // namespace
}  // namespace weft::check::testing
