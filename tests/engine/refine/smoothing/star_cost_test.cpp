// SPDX-License-Identifier: Apache-2.0
// Where a vertex should go, for triangles that are equally large for their bounds.
#include "engine/refine/smoothing/star_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/base/vector.h"

namespace weft {
namespace {

// For a link that is a regular polygon of unit radius around `centre`, the vertex being at the
// origin.
std::optional<Vector> search(Vector centre, const std::vector<double>& bounds, double scale = 1) {
  const auto edges = static_cast<std::uint32_t>(bounds.size());
  StarCost star(0.1786F);
  star.begin(edges, scale);
  for (std::uint32_t i = 0; i <= edges; ++i) {
    const double angle = 2 * std::numbers::pi * (i % edges) / edges;
    star.set_point(i, scale * (centre.x + std::cos(angle)), scale * (centre.y + std::sin(angle)));
  }
  for (std::uint32_t i = 0; i < edges; ++i) star.set_bound(i, scale * scale * bounds[i]);
  return star.search();
}

TEST(StarCost, LeavesAVertexInTheMiddle) {
  EXPECT_FALSE(search({0, 0}, std::vector<double>(6, 0.5)));
}

TEST(StarCost, TakesAVertexTowardTheMiddle) {
  for (const double scale : {1.0, 1e-6, 1e6}) {
    const auto place = search({0.3, 0.1}, std::vector<double>(6, 0.5), scale);
    ASSERT_TRUE(place);
    EXPECT_LT(std::hypot(place->x - 0.3 * scale, place->y - 0.1 * scale), 0.1 * scale);
  }
}

// The triangles that may be smaller get smaller.
TEST(StarCost, FollowsTheBounds) {
  const auto place = search({0, 0}, {0.3, 0.6, 0.6, 0.6, 0.6, 0.3});
  ASSERT_TRUE(place);
  EXPECT_GT(place->x, 0.05);
  EXPECT_NEAR(place->y, 0, 1e-6);
}

TEST(StarCost, HasNothingToSayWithoutABound) {
  EXPECT_FALSE(search({0.3, 0.1}, std::vector<double>(6, std::numeric_limits<double>::infinity())));
}

TEST(StarCost, NeverProposesAFlatTriangle) {
  const auto place = search({0.85, 0}, {9, 9, 1e-3, 1e-3, 9, 9});
  if (place) EXPECT_LT(std::hypot(place->x - 0.85, place->y), std::cos(std::numbers::pi / 6));
}

}  // namespace
}  // namespace weft
