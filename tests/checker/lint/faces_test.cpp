// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/checker/lint/drawn_domain.h"

namespace weft::check {
namespace {

TEST(LintFaces, FindsSmallAngles) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {10, 0}, {10, 0.1}});
  EXPECT_EQ(drawn.told(), "small-angle 1");
  EXPECT_NEAR(drawn.faults().kept().at(0).measure, 0.573, 1e-3);
  EXPECT_EQ(drawn.faults().kept().at(0).at, (Vec2{0, 0}));
}

TEST(LintFaces, AnAngleOfADegreeIsNotSmall) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {10, 0}, {10, 0.18}});
  EXPECT_EQ(drawn.told(), "");
}

// Seen from both sides of the direction of x, at which a turn starts anew.
TEST(LintFaces, FindsSmallAnglesInEveryDirection) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {10, -0.05}, {10, 0.05}}).ring({{0, 20}, {-10, 20.05}, {-10, 19.95}});
  EXPECT_EQ(drawn.told(), "small-angle 2");
}

TEST(LintFaces, FindsAFaceThatIsThin) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {10, 0.001});
  EXPECT_EQ(drawn.told(), "sliver 1");
  EXPECT_NEAR(drawn.faults().kept().at(0).measure, 0.001, 1e-6);
  EXPECT_NEAR(drawn.faults().kept().at(0).at.x, 5, 1e-6);
}

TEST(LintFaces, AChannelOfManyEdgesIsNoSliver) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 0.002}, {2, 0.002}, {1, 0.002}, {0, 0.002}});
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintFaces, FindsTheSliverBetweenNeighbours) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {10, 10});
  drawn.polygon().ring({{10, 0}, {20, 0}, {20, 10}, {10, 10}, {10.002, 5}});
  EXPECT_EQ(drawn.told(), "sliver 1");
}

TEST(LintFaces, FindsPolygonsThatOverlap) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).polygon().box({3, 2}, {8, 3});
  EXPECT_EQ(drawn.told(), "area-overlap 1");
  const Fault fault = drawn.faults().kept().at(0);
  EXPECT_EQ(fault.measure, 1);
  EXPECT_TRUE(fault.at.x > 3 && fault.at.x < 4 && fault.at.y > 2 && fault.at.y < 3);
  drawn.domain.fill = Fill::kEvenOdd;
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintFaces, FindsAPolygonGivenTwice) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).polygon().box({0, 0}, {4, 4});
  EXPECT_EQ(drawn.told(), "area-overlap 1");
}

TEST(LintFaces, APolygonMayLieInsideAnotherOrCarveIt) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).polygon().box({1, 1}, {2, 2});
  EXPECT_EQ(drawn.told(), "");
  drawn.polygon(true).box({3, 3}, {5, 5});
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintSeeds, FindsSeedsOutsideAndOnSegments) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4});
  drawn.domain.holes = {{5, 5}};
  drawn.domain.regions = {{{4, 1}, 1, {}}};
  EXPECT_EQ(drawn.told(), "seed-outside 1, seed-on-segment 1");
  EXPECT_EQ(drawn.faults().kept().at(1).offenders,
            (std::vector<Offender>{{Offender::What::kRegion, 0}, {Offender::What::kSegment, 1}}));
}

TEST(LintSeeds, OfRegionsInOneFaceTheLastCountsOfAHoleNone) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).box({5, 0}, {8, 4});
  drawn.domain.regions = {{{1, 1}, 1, {}}, {{2, 2}, 2, {}}, {{6, 1}, 3, {}}};
  drawn.domain.holes = {{6, 2}};
  EXPECT_EQ(drawn.told(), "seed-shared 2");
  using Pair = std::vector<Offender>;
  EXPECT_EQ(drawn.faults().kept().at(0).offenders,
            (Pair{{Offender::What::kRegion, 2}, {Offender::What::kHole, 0}}));
  EXPECT_EQ(drawn.faults().kept().at(1).offenders,
            (Pair{{Offender::What::kRegion, 0}, {Offender::What::kRegion, 1}}));
}

}  // namespace
}  // namespace weft::check
