// SPDX-License-Identifier: Apache-2.0
// The statistics of single triangles.
#include "engine/emit/quality_statistics.h"

#include <gtest/gtest.h>

#include "engine/domain/triangulation/predicates.h"

namespace weft {
namespace {

Summary stats_of(Point a, Point b, Point c) {
  TriangleBlock block;
  block.add(a, b, c);
  block.bound[0] = block.bound[1] = 1;
  block.on_lattice[0] = false;
  QualityStatistics statistics;
  statistics.add(block);
  Summary summary;
  statistics.write(summary);
  return summary;
}

TEST(QualityStatistics, MeasuresATriangle) {
  const Summary summary = stats_of({0, 0}, {2, 0}, {0, 2});
  EXPECT_DOUBLE_EQ(summary.area, 2);
  EXPECT_NEAR(summary.min_angle_deg, 45, 1e-12);
  EXPECT_NEAR(summary.max_angle_deg, 90, 1e-12);
  EXPECT_DOUBLE_EQ(summary.ideal_ratio, 0.5);
}

TEST(QualityStatistics, ATriangleMayTurnLeftByLessThanRounding) {
  const Point a{0.14886150470067516, 0.7144603532581918};
  const Point b{0.9415109437796415, 0.05889783655064684};
  const Point c{0.4028662800503084, 0.5043851275979977};
  ASSERT_GT(orientation_exact(a, b, c), 0);
  ASSERT_LT((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x), 0) << "rounded";
  const Summary summary = stats_of(a, b, c);
  EXPECT_GE(summary.area, 0);
  EXPECT_NEAR(summary.min_angle_deg, 0, 1e-12);
  EXPECT_NEAR(summary.max_angle_deg, 180, 1e-12);
}

}  // namespace
}  // namespace weft
