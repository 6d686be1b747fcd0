// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/petal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "engine/engine.h"
#include "engine/refine/steiner_point.h"
#include "tests/engine/refine/sound.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// At which the points a and b are seen from p.
double angle_at(Point p, Point a, Point b) {
  const double cross = (a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x);
  const double dot = (a.x - p.x) * (b.x - p.x) + (a.y - p.y) * (b.y - p.y);
  return std::atan2(cross, dot) * kDegrees;
}

TEST(Petal, HasPlacesFromWhichTheShortestEdgeIsSeenWithinTheBound) {
  const Point a{3, 4}, b{3.5, 4.25}, c{1, 7};
  for (const double bound : {5.0, 20.0, 30.0, 36.0}) {
    const QualityBounds quality = QualityBounds::from(bound, 0, 1e-12);
    // The edge may be any of the three.
    for (const Petal& petal :
         {Petal(a, b, c, quality), Petal(b, c, a, quality), Petal(c, a, b, quality)}) {
      EXPECT_DOUBLE_EQ(petal.shortest2(), 0.3125);
      for (double half_tangent = -1; half_tangent <= 1; half_tangent += 0.125) {
        const double angle = angle_at(petal.place(half_tangent), a, b);
        EXPECT_GT(angle, bound) << half_tangent;
        EXPECT_LT(angle, 1.06 * bound) << half_tangent;
      }
    }
  }
}

TEST(Petal, LiesInTheCircumdiskOfASkinnyTriangle) {
  const Point a{0, 0}, b{1, 0}, c{0.4, 2.9};
  const QualityBounds quality = QualityBounds::from(30, 0, 1e-12);
  const double radius2 = circumradius2(a, b, c);
  const Point centre = steiner_point(a, b, c, 0.0);
  for (double half_tangent = -1; half_tangent <= 1; half_tangent += 0.125)
    EXPECT_LT(distance2(Petal(a, b, c, quality).place(half_tangent), centre), radius2);
}

TEST(Petal, IsSearchedOnBothSidesOfTheBestPlace) {
  const QualityBounds quality = QualityBounds::from(20, 0, 1e-12);
  std::multiset<double> places;
  search_petal(quality, [&](double half_tangent) {
    places.insert(half_tangent);
    return half_tangent > 0.5 && half_tangent < 0.7;
  });
  EXPECT_EQ(places, (std::multiset<double>{-0.64, 0, 0.32, 0.64, 0.96}));
}

TEST(Petal, IsSearchedAllOverAboveThirtyFourDegrees) {
  const auto places_at = [](double angle) {
    int places = 0;
    search_petal(QualityBounds::from(angle, 0, 1e-12), [&](double) {
      ++places;
      return false;
    });
    return places;
  };
  EXPECT_EQ(places_at(34), 5);
  EXPECT_EQ(places_at(34.5), 13);
}

// At 33 degrees Triangle 1.6 makes 4,886, 890 and 1,532.
struct AtThirtyThree {
  const char* model;
  std::uint64_t most;
};
class SmallModels : public testing::TestWithParam<AtThirtyThree> {};

TEST_P(SmallModels, TakeFewTrianglesAtSteepAngles) {
  const auto triangles_at = [](double angle) {
    return sound({.pslg = read_poly(model(GetParam().model)), .min_angle_deg = angle})
        .summary.triangles;
  };
  EXPECT_LE(triangles_at(33), GetParam().most);
  EXPECT_LE(triangles_at(36), 2 * GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(Of, SmallModels,
                         testing::Values(AtThirtyThree{"pipe.poly", 1'900},
                                         AtThirtyThree{"key.poly", 410},
                                         AtThirtyThree{"cylinder.poly", 490}));

}  // namespace
}  // namespace weft
