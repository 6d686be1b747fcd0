// SPDX-License-Identifier: Apache-2.0
#include "checker/size/raster_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft::check {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// a + b x + c y + d x y at the nodes of a grid of steps 2 and 3 from (1, -1).
RasterField bilinear(double a, double b, double c, double d) {
  RasterField field{{1, -1}, 2, 3, 5, 4, {}};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i) {
      const double x = 1 + 2 * i, y = -1 + 3 * j;
      field.values.push_back(static_cast<float>(a + b * x + c * y + d * x * y));
    }
  }
  return field;
}

TEST(CheckersRasterField, IsExactForWhatIsBilinear) {
  const RasterField field = bilinear(-7, 2, 0.5, 0.25);
  for (const double x : {1.0, 1.75, 4.0, 8.5, 9.0}) {
    for (const double y : {-1.0, 0.5, 3.5, 8.0}) {
      EXPECT_NEAR(field.value({x, y}), -7 + 2 * x + 0.5 * y + 0.25 * x * y, 1e-12);
      EXPECT_NEAR(field.slope({x, y}), std::hypot(2 + 0.25 * y, 0.5 + 0.25 * x), 1e-12);
    }
  }
}

TEST(CheckersRasterField, IsUndefinedMoreThanHalfACellOutsideTheGrid) {
  const RasterField field = bilinear(1, 0, 0, 0);
  EXPECT_EQ(field.value({9, 8}), 1);
  EXPECT_EQ(field.value({9.4, -1 - 0.4}), 1);
  for (const Vec2 p : {Vec2{-1.1, 0}, Vec2{11.1, 0}, Vec2{5, -4.1}, Vec2{5, 11.1}, Vec2{kNan, 0}}) {
    EXPECT_TRUE(std::isnan(field.value(p)));
    EXPECT_TRUE(std::isnan(field.slope(p)));
  }
}

TEST(CheckersRasterField, IsUndefinedInACellWithANodeThatIs) {
  RasterField field = bilinear(1, 0, 0, 0);
  field.values[1 * 5 + 2] = kNan;  // at (5, 2)
  for (const Vec2 p : {Vec2{4, 1}, Vec2{6, 1}, Vec2{4, 4}, Vec2{6, 4}}) {
    EXPECT_TRUE(std::isnan(field.value(p)));
    EXPECT_TRUE(std::isnan(field.slope(p)));
  }
  EXPECT_EQ(field.value({2.9, 1}), 1);
  EXPECT_EQ(field.value({4, 5.1}), 1);
  for (float& value : field.values) value = kNan;
  EXPECT_TRUE(std::isnan(field.value({2.9, 1})));
}

TEST(CheckersRasterField, OfOneColumnIsALine) {
  const RasterField line{{2, 0}, 1, 1, 1, 3, {1, 3, 7}};
  EXPECT_EQ(line.value({2, 1.5}), 5);
  EXPECT_EQ(line.slope({2, 1.5}), 4);
  EXPECT_TRUE(std::isnan(line.value({2.6, 1.5})));
  EXPECT_EQ((RasterField{{2, 0}, 1, 1, 1, 1, {6}}.value({2, 0})), 6);
}

TEST(CheckersRasterField, OfNonsenseHasAFault) {
  EXPECT_FALSE((RasterField{{0, 0}, 1, 1, 1, 1, {6}}.fault()));
  EXPECT_EQ(*(RasterField{{0, 0}, 1, 1, 0, 0, {}}.fault()), "0 values on 0 x 0 nodes");
  EXPECT_EQ(*(RasterField{{0, 0}, 1, 1, 2, 2, {1, 2, 3}}.fault()), "3 values on 2 x 2 nodes");
  // The product is 4 modulo 2^64.
  const std::size_t huge = (std::size_t{1} << 62) + 1;
  EXPECT_TRUE((RasterField{{0, 0}, 1, 1, 4, huge, {1, 2, 3, 4}}.fault()));
  EXPECT_EQ(*(RasterField{{0, 0}, 0, 1, 1, 1, {6}}.fault()), "the steps are 0 and 1");
  EXPECT_TRUE((RasterField{{0, 0}, 1, kNan, 1, 1, {6}}.fault()));
  EXPECT_EQ(*(RasterField{{kNan, 0}, 1, 1, 1, 1, {6}}.fault()), "the origin is (nan, 0)");
}

}  // namespace
}  // namespace weft::check
