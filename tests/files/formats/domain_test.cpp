// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domain.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::files {
namespace {

TEST(FlatDomain, FlattensArcsToEqualChordsOfTwoDegrees) {
  Domain domain;
  domain.points = {{1, 0}, {-1, 0}, {0, 0}};
  domain.point_markers = {4, 5, 6};
  domain.segments = {{2, 0, 3}, {0, 1, 7}, {1, 0, 8}};
  domain.arcs = {{1, 1}, {2, std::tan(std::acos(-1.0) / 4)}};
  domain.segment_places.add(0, "disk.dxf:", 10, "");
  ASSERT_TRUE(flatten_arcs(domain));
  EXPECT_TRUE(domain.arcs.empty());
  ASSERT_EQ(domain.segments.size(), 181u);
  ASSERT_EQ(domain.points.size(), 181u);
  EXPECT_EQ(domain.point_markers.size(), 181u);
  EXPECT_EQ(domain.segments[0], (Domain::Segment{2, 0, 3}));
  double area = 0;
  for (std::size_t s = 1; s < 181; ++s) {
    const Domain::Segment& segment = domain.segments[s];
    const Point a = domain.points[segment.a], b = domain.points[segment.b];
    EXPECT_NEAR(std::hypot(a.x, a.y), 1, 1e-14);
    EXPECT_EQ(segment.marker, s < 91 ? 7 : 8);
    EXPECT_EQ(domain.segment_places.locate(s), s < 91 ? "disk.dxf:11" : "disk.dxf:12");
    area += 0.5 * (a.x * b.y - b.x * a.y);
  }
  EXPECT_NEAR(area, 90 * std::sin(std::acos(-1.0) / 90), 1e-12);
}

TEST(FlatDomain, WithoutArcsStaysAsItIs) {
  Domain domain;
  domain.points = {{0, 0}, {1, 0}};
  domain.segments = {{0, 1}};
  ASSERT_TRUE(flatten_arcs(domain));
  EXPECT_EQ(domain.points.size(), 2u);
  EXPECT_EQ(domain.segments.size(), 1u);
}

TEST(FlatDomain, OfTooManyChordsIsRefused) {
  Domain domain;
  domain.points = {{0, 0}, {1, 0}};
  for (std::uint32_t i = 0; i < 45'000; ++i) {
    domain.segments.push_back({0, 1});
    domain.arcs.push_back({i, -1});
  }
  const auto flat = flatten_arcs(domain);
  ASSERT_FALSE(flat);
  EXPECT_EQ(flat.error().message,
            "the domain's 45,000 arcs are 4,050,000 chords of 2 degrees, and at most 4,000,000 are "
            "made");
  EXPECT_EQ(domain.arcs.size(), 45'000u);
}

}  // namespace
}  // namespace weft::files
