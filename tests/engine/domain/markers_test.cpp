// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weft {
namespace {

TEST(MarkerSet, HasItsMarkers) {
  const MarkerSet set({7, -2, 7});
  for (const std::int32_t marker : {7, -2}) EXPECT_TRUE(set.contains(marker));
  for (const std::int32_t marker : {0, 8, -3}) EXPECT_FALSE(set.contains(marker));
  EXPECT_FALSE(MarkerSet({}).contains(0));
}

TEST(MarkersOfSegments, TheFirstWithoutASegmentIsFound) {
  const std::vector<Segment> segments = {{0, 1, 3}, {1, 2, 5}};
  EXPECT_EQ(first_without_segment({3, 5, 3}, segments), std::nullopt);
  EXPECT_EQ(first_without_segment({3, 4, 5, 6}, segments), 1u);
  EXPECT_EQ(first_without_segment({}, segments), std::nullopt);
}

// A request may have as many markers as segments: pairs of them would take hours.
TEST(MarkersOfSegments, ManyOfManySegmentsAreFoundAtOnce) {
  constexpr std::int32_t kMany = 2'000'000;
  std::vector<Segment> segments(kMany);
  std::vector<std::int32_t> markers(kMany);
  for (std::int32_t i = 0; i < kMany; ++i) {
    segments[static_cast<std::size_t>(i)].marker = i;
    markers[static_cast<std::size_t>(kMany - 1 - i)] = i;
  }
  EXPECT_EQ(first_without_segment(markers, segments), std::nullopt);
  const MarkerSet set(markers);
  EXPECT_TRUE(std::all_of(segments.begin(), segments.end(),
                          [&](const Segment& s) { return set.contains(s.marker); }));
}

}  // namespace
}  // namespace weft
