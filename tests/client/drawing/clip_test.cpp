// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace weft::client {
namespace {

constexpr PageBox kBox{0, 0, 100, 50};

double area_of(std::span<const PagePoint> corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PagePoint& a = corners[i];
    const PagePoint& b = corners[(i + 1) % corners.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

TEST(Clip, CutsASegmentAtTheBox) {
  const auto seen = clipped(kBox, {-100, 25}, {300, 25});
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->first.x, 0);
  EXPECT_EQ(seen->second.x, 100);
  EXPECT_EQ(seen->second.y, 25);
  EXPECT_FALSE(clipped(kBox, {-100, 60}, {300, 60}));
  EXPECT_FALSE(clipped(kBox, {-10, 20}, {5, -30}));  // past a corner
  EXPECT_FALSE(clipped(kBox, {0, 0}, {std::numeric_limits<double>::infinity(), 0}));
}

TEST(Clip, CutsATriangleAtTheBox) {
  const std::array<PagePoint, 3> over_all = {PagePoint{-1000, -1000}, {3000, -1000}, {-1000, 3000}};
  EXPECT_NEAR(area_of(ClippedTriangle(kBox, over_all).corners()), 5000, 1e-9);
  const std::array<PagePoint, 3> inside = {PagePoint{10, 10}, {20, 10}, {10, 20}};
  EXPECT_EQ(ClippedTriangle(kBox, inside).corners().size(), 3u);
  const std::array<PagePoint, 3> outside = {PagePoint{110, 10}, {120, 10}, {110, 20}};
  EXPECT_LT(ClippedTriangle(kBox, outside).corners().size(), 3u);
}

// The parts in the four boxes that a box is cut into are as large as the part in the box.
TEST(Clip, LosesNothingOfRandomTriangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-150, 250);
  const PageBox parts[] = {{0, 0, 30, 20}, {30, 0, 100, 20}, {0, 20, 30, 50}, {30, 20, 100, 50}};
  for (int i = 0; i < 2000; ++i) {
    const std::array<PagePoint, 3> p = {PagePoint{place(random), place(random)},
                                        {place(random), place(random)},
                                        {place(random), place(random)}};
    double sum = 0;
    for (const PageBox& part : parts) sum += area_of(ClippedTriangle(part, p).corners());
    EXPECT_NEAR(area_of(ClippedTriangle(kBox, p).corners()), sum, 1e-6);
  }
}

}  // namespace
}  // namespace weft::client
