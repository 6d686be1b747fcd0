// SPDX-License-Identifier: Apache-2.0
#include "engine/size/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace weft {
namespace {

// From 0 to 1.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

Raster random_raster(std::uint32_t columns, std::uint32_t rows, std::mt19937_64& random) {
  Raster raster{{-1, 2}, 0.1, 0.3, columns, rows, {}};
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    raster.values.push_back(std::exp(20 * uniform(random) - 10));
  return raster;
}

const Raster kSmall{{10, 20}, 2, 4, 2, 2, {1, 2, 3, 8}};

TEST(RasterSize, IsItsValuesAtItsNodesAndBilinearBetween) {
  const auto size = *RasterSize::make(kSmall);
  EXPECT_EQ(size({10, 20}), 1);
  EXPECT_EQ(size({12, 20}), 2);
  EXPECT_EQ(size({10, 24}), 3);
  EXPECT_EQ(size({12, 24}), 8);
  EXPECT_EQ(size({11, 20}), 1.5);
  EXPECT_EQ(size({10.5, 23}), (0.25 * 1 + 0.75 * 3) * 0.75 + (0.25 * 2 + 0.75 * 8) * 0.25);
}

TEST(RasterSize, IsOutsideItsGridThatOfTheNearestPoint) {
  const auto size = *RasterSize::make(kSmall);
  EXPECT_EQ(size({-1e50, -1e50}), 1);
  EXPECT_EQ(size({1e50, 1e50}), 8);
  EXPECT_EQ(size({11, -7}), 1.5);
  EXPECT_EQ(size({13, 22}), 5);
}

TEST(RasterSize, OfOneNodeIsTheSameEverywhere) {
  const Raster raster{{0, 0}, 1, 1, 1, 1, {7}};
  const auto size = *RasterSize::make(raster);
  EXPECT_EQ(size({-3, 9}), 7);
  const Interval bounds = size.bounds({-9, -9, 9, 9});
  EXPECT_EQ(bounds.lo, 7);
  EXPECT_EQ(bounds.hi, 7);
}

TEST(RasterSize, GivesTheSameBitsInEveryBatch) {
  std::mt19937_64 random(2);
  const Raster raster = random_raster(9, 5, random);
  const auto size = *RasterSize::make(raster);
  alignas(64) double x[16], y[16], out[16];
  for (int i = 0; i < 16; ++i) {
    x[i] = -1 + uniform(random);
    y[i] = 2 + uniform(random);
  }
  size.evaluate(16, x, y, out);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(out[i], size({x[i], y[i]}));
}

TEST(RasterSize, IsBoundedInEveryBox) {
  std::mt19937_64 random(1);
  for (const auto& [columns, rows] : {std::pair{1, 40}, {2, 2}, {7, 3}, {33, 70}, {300, 5}}) {
    const Raster raster = random_raster(columns, rows, random);
    const auto size = *RasterSize::make(raster);
    for (int i = 0; i < 2'000; ++i) {
      // Partly outside; from a thousandth of the raster to all of it.
      const double scale = std::pow(10, -3 * uniform(random));
      const double width = 0.1 * columns * scale;
      const double height = 0.3 * rows * scale;
      const double x = -1.1 + 0.11 * columns * uniform(random);
      const double y = 1.9 + 0.33 * rows * uniform(random);
      const Interval bounds = size.bounds({x, y, x + width, y + height});
      EXPECT_FALSE(bounds.may_be_nan);
      EXPECT_GT(bounds.lo, 0);
      for (int j = 0; j < 10; ++j) {
        const double value = size({x + width * uniform(random), y + height * uniform(random)});
        ASSERT_LE(bounds.lo, value);
        ASSERT_GE(bounds.hi, value);
      }
    }
  }
}

TEST(RasterSize, IsBoundedWhereItsValuesAreAFewRoundingsApart) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 5'000; ++i) {
    Raster raster{{0, 0}, 1, 1, 2, 2, {}};
    for (int k = 0; k < 4; ++k)
      raster.values.push_back(1.9 + static_cast<double>(random() % 2'000) * 0x1p-52);
    const auto size = *RasterSize::make(raster);
    const Box box{0.3 * uniform(random), 0.3 * uniform(random), 1 - 0.3 * uniform(random),
                  1 - 0.3 * uniform(random)};
    const Interval bounds = size.bounds(box);
    for (int j = 0; j < 50; ++j) {
      // Along the sides, where the extremes are.
      const double t = j % 2 == 0 ? 1e-3 * uniform(random) : uniform(random);
      const double value = size({box.min_x + t * box.width(), j % 4 < 2 ? box.min_y : box.max_y});
      ASSERT_LE(bounds.lo, value);
      ASSERT_GE(bounds.hi, value);
    }
  }
}

TEST(RasterSize, IsNeverBeyondTheNodesAround) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 20'000; ++i) {
    Raster raster = random_raster(2, 1, random);
    raster.origin.x = 0;
    raster.dx = 1;
    const auto size = *RasterSize::make(raster);
    const double value = size({0x1.fffffffffffffp-1, 0});  // all but at the second node
    ASSERT_LE(value, std::max(raster.values[0], raster.values[1]));
    ASSERT_GE(value, std::min(raster.values[0], raster.values[1]));
  }
}

TEST(RasterSize, HasTightBoundsInsideACell) {
  const auto size = *RasterSize::make(kSmall);
  const Interval bounds = size.bounds({10, 20, 11, 22});
  EXPECT_NEAR(bounds.lo, 1, 1e-13);
  EXPECT_NEAR(bounds.hi, 3.5, 1e-13);  // at (11, 22)
}

TEST(RasterSize, IsKnownToBeConstantWhereItIs) {
  Raster raster{{0, 0}, 1, 1, 50, 50, std::vector<double>(2500, 0.1)};
  raster.values[0] = 5;
  const auto size = *RasterSize::make(raster);
  for (const Box& box : {Box{10.2, 10.3, 10.4, 10.9}, Box{1, 1, 3.5, 4.5}, Box{20, 20, 49, 49}}) {
    EXPECT_EQ(size.bounds(box).lo, 0.1);
    EXPECT_EQ(size.bounds(box).hi, 0.1);
  }
}

TEST(RasterSize, RefusesAValueThatIsNoSizeByName) {
  for (const double bad : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    Raster raster{{0, 0}, 1, 1, 3, 2, {1, 1, 1, 1, bad, 1}};
    const auto size = RasterSize::make(raster);
    ASSERT_FALSE(size);
    EXPECT_EQ(size.error().code, ErrorCode::kBadSizeValue);
    EXPECT_EQ(size.error().field, "size.raster.values[4]");
    EXPECT_NE(size.error().message.find("column 1 of row 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace weft
