// SPDX-License-Identifier: Apache-2.0
#include "checker/lint/snapped_domain.h"

#include <gtest/gtest.h>

namespace weft::check {
namespace {

TEST(SnappedDomain, MakesOnePlaceOfPointsWithinTheSnap) {
  Domain domain;
  domain.points = {{0, 0}, {1, 0}, {1.05, 0.05}, {-0.05, 0}, {1, 1}};
  domain.segments = {{0, 1}, {2, 4}, {1, 2}};
  domain.snap = 0.1;
  const SnappedDomain merged = snapped(domain);
  EXPECT_EQ(merged.places, (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}}));
  EXPECT_EQ(merged.place_of, (std::vector<std::uint32_t>{0, 1, 1, 0, 2}));
  EXPECT_EQ(merged.point_at, (std::vector<std::uint32_t>{0, 1, 4}));
  EXPECT_EQ(merged.segments, (std::vector<SegmentEnds>{{0, 1}, {1, 2}}));
  EXPECT_EQ(merged.origin, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(merged.segments_at(1).size(), 2U);
  EXPECT_EQ(merged.reach[1], 1);
}

TEST(SnappedDomain, TheNearestPlaceTakesAPoint) {
  Domain domain;
  domain.points = {{0, 0}, {0.15, 0}, {0.09, 0}, {0.06, 0}};
  domain.snap = 0.1;
  EXPECT_EQ(snapped(domain).place_of, (std::vector<std::uint32_t>{0, 1, 1, 0}));
}

TEST(SnappedDomain, AllPointsMayBeAtTheOrigin) {
  Domain domain;
  domain.points = {{0, 0}, {0, 0}};
  domain.segments = {{0, 1}};
  EXPECT_EQ(snapped(domain).places.size(), 1U);
  EXPECT_TRUE(snapped(domain).segments.empty());
}

}  // namespace
}  // namespace weft::check
