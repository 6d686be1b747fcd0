// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ring_breaks.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

using Indices = std::vector<std::size_t>;

RingBreaks breaks_of(const std::vector<Point>& points) {
  std::vector<RingCorner> corners;
  for (const Point& point : points) corners.push_back({point, corners.empty()});
  return ring_breaks(corners);
}

const std::vector<Point> kTwoRings = {{0, 0}, {9, 0}, {9, 9}, {-999, -999},
                                      {1, 1}, {2, 1}, {2, 2}, {-999, -999}};

TEST(RingBreaks, AreRowsOfTheSameNumberBetweenRings) {
  EXPECT_EQ(breaks_of(kTwoRings).ends, (Indices{3, 7}));
  EXPECT_EQ(breaks_of({{9999, 9999}, {0, 0}, {9, 0}, {9, 9}, {9999, 9999}}).ends, (Indices{0, 4}));
}

TEST(RingBreaks, AreNotCornersThatTheOthersReach) {
  const RingBreaks square = breaks_of({{0, 0}, {999, 0}, {999, 999}, {0, 999}});
  EXPECT_EQ(square.ends, Indices{});
  EXPECT_EQ(square.doubtful, Indices{});
  EXPECT_EQ(breaks_of({{-999, -999}, {999, -999}, {999, 999}, {-999, 999}}).ends, Indices{});
}

TEST(RingBreaks, LeaveRingsOfThreeCornersOrMore) {
  const RingBreaks breaks = breaks_of({{0, 0}, {9, 0}, {-999, -999}, {9, 9}, {0, 9}, {0, 5}});
  EXPECT_EQ(breaks.ends, Indices{});
  EXPECT_EQ(breaks.doubtful, (Indices{2}));
}

TEST(RingBreaks, AreDoubtfulAtTheEndOfOneLargeRing) {
  const RingBreaks open = breaks_of({{0, 0}, {5000, 0}, {5000, 5000}, {0, 5000}, {-999, -999}});
  EXPECT_EQ(open.ends, Indices{});
  EXPECT_EQ(open.doubtful, (Indices{4}));
  const RingBreaks closed =
      breaks_of({{0, 0}, {5000, 0}, {5000, 5000}, {0, 5000}, {0, 0}, {-999, -999}});
  EXPECT_EQ(closed.ends, (Indices{5}));
  EXPECT_EQ(breaks_of({{0, 0}, {5, 0}, {5, 5}, {-999, -999}}).ends, (Indices{3}));
}

TEST(RingBreaks, AreNoOtherNumbers) {
  for (const double value : {-99.0, -998.0, 1000.0, 99999999.0})
    EXPECT_EQ(breaks_of({{0, 0}, {9, 0}, {9, 9}, {value, value}, {1, 1}, {2, 1}, {2, 2}}).ends,
              Indices{})
        << value;
  EXPECT_EQ(breaks_of({{0, 0}, {9, 0}, {9, 9}, {-999, 999}, {1, 1}, {2, 1}, {2, 2}}).ends,
            Indices{});
}

TEST(RingBreaks, AreNoneInAListOfSuchRowsAlone) {
  EXPECT_EQ(breaks_of({{-999, -999}, {-999, -999}}).ends, Indices{});
  EXPECT_EQ(breaks_of({}).ends, Indices{});
}

}  // namespace
}  // namespace weft::files
