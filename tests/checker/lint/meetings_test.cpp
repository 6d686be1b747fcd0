// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/checker/lint/drawn_domain.h"

namespace weft::check {
namespace {

TEST(LintMeetings, OfACrossingNamesBothSegmentsAndThePlace) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
  EXPECT_EQ(drawn.told(), "crossing 1");
  const Fault fault = drawn.faults().kept().at(0);
  EXPECT_EQ(fault.at, (Vec2{2, 2}));
  EXPECT_EQ(fault.offenders,
            (std::vector<Offender>{{Offender::What::kSegment, 0}, {Offender::What::kSegment, 2}}));
}

TEST(LintMeetings, ACrossingOfOnePolygonIsItsOwn) {
  DrawnDomain drawn;
  drawn.polygon().ring({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
  EXPECT_EQ(drawn.told(), "self-crossing 1");
}

TEST(LintMeetings, BordersOfTwoPolygonsMayBeShared) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).polygon().box({4, 0}, {8, 4});
  EXPECT_EQ(drawn.told(), "");
  drawn.polygon().box({8, 1}, {9, 3});  // a part of a side
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintMeetings, ALineMayMarkABorder) {
  DrawnDomain drawn;
  drawn.polygon().box({0, 0}, {4, 4}).no_polygon().line({{0, 0}, {4, 0}});
  EXPECT_EQ(drawn.told(), "");
}

TEST(LintMeetings, FindsAnEndOnTheInsideOfASegment) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).line({{1, 0}, {2, 1}, {3, 0}});
  EXPECT_EQ(drawn.told(), "junction 2");
  EXPECT_EQ(drawn.faults().kept().at(0).at, (Vec2{1, 0}));
}

// Doubles are seldom on a slanted segment, whichever side they fall on.
TEST(LintMeetings, ARoundedEndIsOnTheSegment) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {3, 1}, {0, 4}});
  drawn.line({{0, 2}, {0.3, 0.1}, {0.5, 1}, {0.9, 0.3}, {1, 2}, {1.8, 0.6}, {2, 1.2}, {1, 3}});
  EXPECT_EQ(drawn.told(), "junction 5");
}

TEST(LintMeetings, FindsSegmentsThatCoincideInPart) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {4, 0}, {4, 4}}).ring({{1, 0}, {6, 0}, {6, -4}});
  EXPECT_EQ(drawn.told(), "overlap 1");
  const Fault fault = drawn.faults().kept().at(0);
  EXPECT_EQ(fault.measure, 3);
  EXPECT_EQ(std::min(fault.at.x, fault.to->x), 1);
  EXPECT_EQ(std::max(fault.at.x, fault.to->x), 4);
}

TEST(LintMeetings, FindsASegmentInsideAnother) {
  DrawnDomain drawn;
  drawn.ring({{0, 0}, {4, 0}, {4, 4}}).ring({{1, 0}, {2, 0}, {2, -4}});
  EXPECT_EQ(drawn.told(), "overlap 1");
}

TEST(LintMeetings, FindsSegmentsGivenTwice) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4});
  drawn.domain.segments.push_back({1, 0});
  EXPECT_EQ(drawn.told(), "duplicate-segment 1");
  EXPECT_EQ(drawn.faults().kept().at(0).offenders.at(0).index, 4U);
}

TEST(LintMeetings, FindsPointsGivenTwiceIfSegmentsShareThem) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4}).line({{0, 0}, {2, 2}, {4, 4}});
  EXPECT_EQ(drawn.told(true), "duplicate-point 2");
  EXPECT_EQ(drawn.told(false), "");
}

TEST(LintMeetings, FindsSegmentsOfLengthZero) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {4, 4});
  drawn.domain.segments.push_back({2, 2});
  EXPECT_EQ(drawn.told(), "zero-length 1");
}

}  // namespace
}  // namespace weft::check
