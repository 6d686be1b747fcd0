// SPDX-License-Identifier: Apache-2.0
#include "files/geo/segment_touches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "files/geo/projection_options.h"

namespace weft::files {
namespace {

constexpr double kMillimetre = 1e-3 / kMetresPerDegree;

class SegmentTouching : public ::testing::Test {
 protected:
  // Those on the segment from point 0 to point 1.
  std::vector<std::uint32_t> on_first(std::vector<Point> lonlat, bool turned = false,
                                      double snap = kProjectedSnap) {
    Domain domain;
    domain.points = std::move(lonlat);
    domain.segments = {{0, 1, 0}};
    const LonLatExtent extent = lonlat_extent(domain).value();
    SegmentTouches touches(domain.points, extent, snap);
    auto found = turned ? touches.on(1, 0) : touches.on(0, 1);
    looked_at_ = touches.looked_at();
    return found;
  }
  std::size_t looked_at_ = 0;
};

using Indices = std::vector<std::uint32_t>;

TEST_F(SegmentTouching, FindsPointsInsideInTheirOrder) {
  const std::vector<Point> lonlat = {{10, 60},      {12, 61},   {11.5, 60.75}, {11, 60.5},
                                     {11, 60.5001}, {13, 61.5}, {10.1, 60.05}};
  EXPECT_EQ(on_first(lonlat), (Indices{6, 3, 2}));
  EXPECT_EQ(on_first(lonlat, true), (Indices{2, 3, 6}));
  EXPECT_EQ(looked_at_, 5U);  // its ends, too
}

TEST_F(SegmentTouching, TakesWhatIsMergedForOne) {
  const double off = kMillimetre;
  const std::vector<Point> beside = {
      {10, 60}, {12, 60}, {11, 60 + 1.9 * off}, {11.5, 60 + 2.1 * off}};
  EXPECT_EQ(on_first(beside), (Indices{2}));
  EXPECT_EQ(on_first(beside, false, 0.003), (Indices{2, 3}));
  // A degree of longitude is half as long there.
  EXPECT_EQ(on_first({{10, 59}, {10, 61}, {10 + 3.8 * off, 60}, {10 + 4.2 * off, 60.5}}),
            (Indices{2}));
  // Places at the ends, and of two places in one the first point.
  EXPECT_EQ(on_first({{10, 60},
                      {12, 60},
                      {10, 60},
                      {10 + off, 60},
                      {12 - off, 60},
                      {11.5, 60},
                      {11, 60},
                      {11, 60},
                      {11 + off, 60}}),
            (Indices{6, 5}));
}

TEST_F(SegmentTouching, LeavesOutSegmentsThatThePlaneHardlyBends) {
  EXPECT_EQ(on_first({{10, 60}, {10.0004, 60}, {10.0002, 60}}), Indices{});
  EXPECT_EQ(on_first({{10, 60}, {10.004, 60}, {10.002, 60}}), Indices{2});
}

TEST_F(SegmentTouching, GoesTheShortWayOverTheDateLine) {
  EXPECT_EQ(on_first({{179, -17}, {-179, -17}, {180, -17}, {-179.5, -17}, {0, -17}, {179.5, -17}}),
            (Indices{5, 2, 3}));
  EXPECT_EQ(on_first({{180, 10}, {180, 12}, {-180, 11}}), (Indices{2}));
}

TEST_F(SegmentTouching, FindsPointsBeyondTheCutOfADomainAroundAPole) {
  Domain domain;
  domain.points = {{-120, 80}, {0, 80}, {120, 80}, {-179, 80}, {179, 80}, {-60, 80}};
  domain.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  const LonLatExtent extent = lonlat_extent(domain).value();
  ASSERT_TRUE(extent.around);
  SegmentTouches touches(domain.points, extent, kProjectedSnap);
  EXPECT_EQ(touches.on(2, 0), (Indices{4, 3}));
  EXPECT_EQ(touches.on(0, 2), (Indices{3, 4}));
  EXPECT_EQ(touches.on(0, 1), (Indices{5}));
}

}  // namespace
}  // namespace weft::files
