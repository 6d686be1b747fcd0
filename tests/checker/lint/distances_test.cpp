// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/checker/lint/drawn_domain.h"

namespace weft::check {
namespace {

TEST(LintEnds, FindsEndsThatNoOtherSegmentTouches) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).line({{0, 0}, {1, 2}});
  EXPECT_EQ(drawn.told(), "open-end 1");
  EXPECT_EQ(drawn.faults().kept().at(0).at, (Vec2{1, 2}));
  EXPECT_EQ(drawn.faults().kept().at(0).offenders.at(0), (Offender{Offender::What::kSegment, 4}));
}

TEST(LintEnds, ALineMayEndInAPolygonButNotOutside) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).no_polygon().line({{1, 1}, {2, 1}});
  EXPECT_EQ(drawn.told(), "");
  drawn.line({{5, 5}, {6, 5}});
  EXPECT_EQ(drawn.told(), "open-end 2");
}

TEST(LintEnds, TwoNearEndsAreAGap) {
  DrawnDomain drawn;
  drawn.line({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0.005}});
  EXPECT_EQ(drawn.told(), "gap 1");
  const Fault fault = drawn.faults().kept().at(0);
  EXPECT_EQ(fault.measure, 0.005);
  EXPECT_EQ(fault.at, (Vec2{0, 0}));
  EXPECT_EQ(fault.to, (Vec2{0, 0.005}));
}

TEST(LintEnds, AnEndNearASegmentIsAGap) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {10, 10}).line({{0, 0}, {5, 9.995}});
  EXPECT_EQ(drawn.told(), "gap 1");
  EXPECT_NEAR(drawn.faults().kept().at(0).measure, 0.005, 1e-12);
}

// Its second next segment is near its end, too.
TEST(LintEnds, AFineLineIsNoGap) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {10, 10}).line({{5, 5}, {5.001, 5}, {5.002, 5}, {5.003, 5}, {5.02, 5}});
  EXPECT_EQ(drawn.told(), "open-end 2");
}

TEST(LintEnds, ASnapClosesGaps) {
  DrawnDomain drawn;
  drawn.line({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0.005}});
  drawn.line({{0, 10}, {5, 0.005}});
  drawn.domain.regions = {{{9, 9}, 1, {}}};
  EXPECT_EQ(drawn.told(), "gap 2, seed-outside 1");
  drawn.domain.snap = 0.011;
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintDistances, FindsPointsNearOthers) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).box({4.0001, 4.0001}, {8, 8});
  EXPECT_EQ(drawn.told(), "near-points 1");
  EXPECT_NEAR(drawn.faults().kept().at(0).measure, 1.414e-4, 1e-6);
  drawn.domain.snap = 1.5e-4;
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintDistances, WhatIsNearDependsOnTheSegments) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).box({4.0001, 4.0001}, {4.5, 4.5});
  EXPECT_EQ(drawn.told(), "");
}

// The mesher does not tell them apart.
TEST(LintDistances, RoundingIsNoFault) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).box({4 + 1e-13, 4}, {8, 8});
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintDistances, FindsAPointNearASegment) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {10, 10}).ring({{5, 0.0002}, {7, 5}, {3, 5}});
  EXPECT_EQ(drawn.told(), "near-segment 1");
  EXPECT_EQ(drawn.faults().kept().at(0).measure, 0.0002);
}

TEST(LintDistances, FindsALonePointNearASegment) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {10, 10}).line({{5, 0.0002}});
  EXPECT_EQ(drawn.told(), "near-segment 1");
}

}  // namespace
}  // namespace weft::check
