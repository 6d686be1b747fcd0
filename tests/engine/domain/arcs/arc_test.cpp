// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/arc.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(Arc, SinesAndCosinesAreThoseOfTheLibrary) {
  for (double angle = -1.6; angle <= 1.6; angle += 0.001) {
    const auto [cosine, sine] = cosine_and_sine(angle);
    EXPECT_NEAR(cosine, std::cos(angle), 3e-16) << angle;
    EXPECT_NEAR(sine, std::sin(angle), 3e-16) << angle;
  }
}

TEST(Arc, TurnsByFourTimesTheArcTangentOfItsBulge) {
  for (double bulge = 1e-12; bulge < 1e7; bulge *= 1.7) {
    EXPECT_NEAR(turn_of(bulge), 4 * std::atan(bulge), 4e-15 * std::atan(bulge)) << bulge;
    EXPECT_EQ(turn_of(-bulge), -turn_of(bulge));
    EXPECT_NEAR(4 * std::atan(half_bulge(bulge)), 2 * std::atan(bulge), 1e-15);
  }
}

TEST(Arc, LiesRightOfItsChordIfItTurnsLeft) {
  const Point a{1, 0}, b{0, 1};
  const double bulge = std::tan(kPi / 8);
  const Point middle = middle_of_arc(a, b, bulge);
  EXPECT_NEAR(middle.x, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(middle.y, std::sqrt(0.5), 1e-15);
  const Point control = control_point(a, b, bulge);
  EXPECT_NEAR(control.x, 1, 1e-15);
  EXPECT_NEAR(control.y, 1, 1e-15);
  const Vector start = tangent_at_start(a, b, bulge), end = tangent_at_end(a, b, bulge);
  EXPECT_NEAR(start.x, 0, 1e-15);
  EXPECT_GT(start.y, 0);
  EXPECT_LT(end.x, 0);
  EXPECT_NEAR(end.y, 0, 1e-15);
}

TEST(Arc, PointsAfterAFractionAreOnTheCircle) {
  for (const double turn : {1e-6, 0.1, 1.0, 3.0, kPi}) {
    const Point a{2, 3}, b{2 + std::cos(0.3), 3 + std::sin(0.3)};
    const double bulge = std::tan(turn / 4);
    const double curvature = curvature_of(1, bulge);
    Vector tangent = tangent_at_start(a, b, bulge);
    tangent = {tangent.x / length(tangent), tangent.y / length(tangent)};
    double last = 0;
    for (int k = 1; k <= 8; ++k) {
      const Point p = at_fraction(a, b, bulge, k / 8.0);
      EXPECT_NEAR(offset_from_circle(a, tangent, curvature, p), 0, 2e-15) << turn << " " << k;
      const double chord = length(p - a);
      EXPECT_NEAR(chord, std::sin(k * turn / 16) / std::sin(turn / 2), 1e-14);
      const Point same = at_distance(a, tangent, curvature, chord);
      EXPECT_NEAR(length(same - p), 0, 1e-7 * (turn > 3) + 1e-14) << turn << " " << k;
      EXPECT_GT(chord, last);
      last = chord;
    }
  }
}

TEST(Arc, OffsetsAreAboveZeroOnTheRight) {
  const Vector up{0, 1};
  EXPECT_NEAR(offset_from_circle({1, 0}, up, 1, {3, 0}), 2, 1e-15);
  EXPECT_NEAR(offset_from_circle({1, 0}, up, 1, {0, -0.5}), -0.5, 1e-15);
  EXPECT_NEAR(offset_from_circle({1, 0}, up, 0, {3, 7}), 2, 1e-15);
}

TEST(Arc, BulgesOfPartsKeepTheCurvature) {
  const double bulge = 0.4, chord = 3;
  const double curvature = curvature_of(chord, bulge);
  EXPECT_NEAR(bulge_of(curvature, chord), bulge, 1e-15);
  const double half = length(middle_of_arc({0, 0}, {chord, 0}, bulge) - Point{0, 0});
  EXPECT_NEAR(bulge_of(curvature, half), half_bulge(bulge), 1e-15);
}

}  // namespace
}  // namespace weft
