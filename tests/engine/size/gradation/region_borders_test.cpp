// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/region_borders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// Boxes beside one another, each as large as 1 by 1, with a bound each; 0 for none.
Domain row(const std::vector<double>& bounds) {
  Pslg pslg;
  const auto count = static_cast<double>(bounds.size());
  add_box(pslg, {0, 0}, {count, 1});
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const auto x = static_cast<double>(i);
    if (i > 0) add_segment(pslg, {x, 0}, {x, 1});
    if (bounds[i] > 0)
      pslg.regions.push_back({{x + 0.5, 0.5}, static_cast<std::int32_t>(i), bounds[i]});
  }
  return *triangulate(pslg, {});
}

double length(const RegionBorders& borders) {
  double sum = 0;
  for (const Line& line : borders.lines)
    sum += std::hypot(line.b.x - line.a.x, line.b.y - line.a.y);
  return sum;
}

TEST(RegionBorders, AreThoseToLargerBoundsAndToTheOutside) {
  const auto borders = region_borders(row({0, 2, 1, 2}));
  ASSERT_EQ(borders.size(), 2u);
  EXPECT_EQ(borders[0].max_area, 1);
  EXPECT_DOUBLE_EQ(length(borders[0]), 4);
  EXPECT_EQ(borders[1].max_area, 2);
  EXPECT_DOUBLE_EQ(length(borders[1]), 3 + 3);  // without those of the third box
}

TEST(RegionBorders, OfABoundThatNoRegionExceedsAreNone) {
  EXPECT_TRUE(region_borders(row({0, 0})).empty());
  EXPECT_TRUE(region_borders(row({3, 3})).empty());
  const auto borders = region_borders(row({3, 5}));
  ASSERT_EQ(borders.size(), 1u);
  EXPECT_EQ(borders[0].max_area, 3);
}

TEST(RegionBorders, OfNearlyEqualBoundsAreOneWithTheLeast) {
  const auto borders = region_borders(row({1.05, 1, 1.09, 0}));
  ASSERT_EQ(borders.size(), 2u);
  EXPECT_EQ(borders[0].max_area, 1);
  EXPECT_DOUBLE_EQ(length(borders[0]), 6);
  EXPECT_EQ(borders[1].max_area, 1.09);
}

TEST(RegionBorders, AreFew) {
  std::vector<double> bounds{0};
  for (int i = -300; i <= 300; i += 2) bounds.push_back(std::pow(10.0, i));
  const auto borders = region_borders(row(bounds));
  EXPECT_LE(borders.size(), kMaxRegionBorders + 1);
  EXPECT_GE(borders.size(), kMaxRegionBorders / 2);
  EXPECT_EQ(borders[0].max_area, 1e-300);
}

}  // namespace
}  // namespace weft
