// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/flattened.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft::check::testing {
namespace {

TEST(Flattened, AnArcIsPiecesOfTwoDegreesAtMost) {
  EXPECT_EQ(flattened({1, 0}, {-1, 0}, 1).size(), 89u);
  EXPECT_EQ(flattened({1, 0}, {-1, 0}, std::tan(0.4 * std::numbers::pi / 180)).size(), 0u);
  EXPECT_EQ(flattened({1, 0}, {-1, 0}, std::tan(0.6 * std::numbers::pi / 180)).size(), 1u);
  EXPECT_EQ(flattened({1, 0}, {-1, 0}, 0).size(), 0u);
  for (const Vec2 p : flattened({1, 0}, {-1, 0}, -1)) {
    EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-15);
    EXPECT_LT(p.y, 0);
  }
}

TEST(Flattened, PiecesKeepWhatTheirSegmentHas) {
  Domain domain;
  domain.points = {{0, 0}, {1, 0}, {0, 1}};
  domain.segments = {{0, 1}, {1, 2}, {2, 0}};
  domain.markers = {4, 5, 6};
  domain.segment_areas = {1, 1, 1};
  domain.areas.emplace_back();
  domain.holes = {{9, 9}};
  domain.arcs = {{1, std::tan(1.5 * std::numbers::pi / 180)}};  // 6 degrees
  domain.fill = Fill::kUnion;
  domain.snap = 0.25;
  const auto [straight, origin] = flattened(domain);
  EXPECT_EQ(origin, (std::vector<std::uint32_t>{0, 1, 1, 1, 2}));
  EXPECT_EQ(straight.markers, (std::vector<std::int32_t>{4, 5, 5, 5, 6}));
  EXPECT_EQ(straight.segment_areas, (std::vector<std::uint32_t>(5, 1)));
  EXPECT_EQ(straight.segments[1], (std::array{1u, 3u}));
  EXPECT_EQ(straight.segments[3], (std::array{4u, 2u}));
  EXPECT_EQ(straight.points.size(), 5u);
  EXPECT_EQ(straight.holes, domain.holes);
  EXPECT_TRUE(straight.arcs.empty());
  EXPECT_EQ(straight.areas.size(), 1u);
  EXPECT_EQ(straight.fill, Fill::kUnion);
  EXPECT_EQ(straight.snap, 0.25);
}

}  // namespace
}  // namespace weft::check::testing
