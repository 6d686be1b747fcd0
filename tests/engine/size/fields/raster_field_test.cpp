// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/raster_field.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "tests/engine/size/fields/field_laws.h"

namespace weft {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

RasterField made(FieldRaster raster) {
  const ExecutionContext context;
  auto field = RasterField::make(std::move(raster), "here", context);
  EXPECT_TRUE(field) << field.error().message;
  return std::move(*field);
}

// `holes` of a hundred nodes have no data.
FieldRaster random_raster(std::uint32_t columns, std::uint32_t rows, unsigned holes,
                          std::mt19937_64& random) {
  FieldRaster raster{{-1, 2}, 0.1, 0.3, columns, rows, {}};
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    raster.values.push_back(
        random() % 100 < holes ? kNoData : static_cast<float>(200 * uniform(random) - 100));
  return raster;
}

Box box_of(const FieldRaster& r) {
  return {r.origin.x, r.origin.y, r.origin.x + (r.columns - 1) * r.dx,
          r.origin.y + (r.rows - 1) * r.dy};
}

FieldRaster linear(std::uint32_t columns, std::uint32_t rows) {
  FieldRaster raster{{-8, 4}, 0.5, 0.25, columns, rows, {}};
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i)
      raster.values.push_back(static_cast<float>(3 * (-8 + 0.5 * i) - 4 * (4 + 0.25 * j)));
  return raster;
}

const FieldRaster kSmall{{10, 20}, 2, 4, 2, 2, {-1, 2, 3, 8}};

TEST(RasterField, IsItsValuesAtItsNodesAndBilinearBetween) {
  const RasterField field = made(kSmall);
  EXPECT_EQ(field({10, 20}), -1);
  EXPECT_EQ(field({12, 20}), 2);
  EXPECT_EQ(field({10, 24}), 3);
  EXPECT_EQ(field({12, 24}), 8);
  EXPECT_EQ(field({11, 20}), 0.5);
  EXPECT_EQ(field({10.5, 23}), (0.25 * -1 + 0.75 * 3) * 0.75 + (0.25 * 2 + 0.75 * 8) * 0.25);
}

TEST(RasterField, OfALinearFunctionIsThatFunctionAndItsSlope) {
  const FieldRaster raster = linear(40, 60);
  const RasterField field = made(raster);
  const auto slope = field.slope();
  std::mt19937_64 random(1);
  for (int i = 0; i < 1'000; ++i) {
    const Point p = random_point(box_of(raster), random);
    EXPECT_NEAR(field(p), 3 * p.x - 4 * p.y, 1e-13);
    EXPECT_EQ((*slope)(p), 5);
  }
  EXPECT_EQ(field.steepness(box_of(raster)), 5);
  EXPECT_EQ(slope->bounds(box_of(raster)).lo, 5);
  EXPECT_EQ(slope->bounds(box_of(raster)).hi, 5);
}

TEST(RasterField, HasTheSlopeOfItsPatch) {
  const RasterField field = made({{0, 0}, 1, 1, 2, 2, {0, 0, 0, 1}});  // x y
  const auto slope = field.slope();
  EXPECT_NEAR((*slope)({0.25, 0.5}), std::sqrt(0.25 * 0.25 + 0.5 * 0.5), 1e-15);
  EXPECT_NEAR((*slope)({1, 1}), std::sqrt(2), 1e-15);
  const Interval bounds = slope->bounds({0.25, 0.5, 0.5, 0.75});
  EXPECT_NEAR(bounds.lo, std::sqrt(0.25 * 0.25 + 0.5 * 0.5), 1e-13);
  EXPECT_NEAR(bounds.hi, std::sqrt(0.5 * 0.5 + 0.75 * 0.75), 1e-13);
  EXPECT_NEAR(field.steepness({0, 0, 0.5, 0.5}), std::sqrt(0.5), 1e-13);
}

TEST(RasterField, IsUndefinedOutside) {
  const RasterField field = made(kSmall);
  const auto slope = field.slope();
  for (const Point p :
       {Point{8.99, 22}, Point{13.01, 22}, Point{11, 17.9}, Point{11, 26.1}, Point{1e300, 22},
        Point{-HUGE_VAL, 22}, Point{std::nan(""), 22}, Point{11, std::nan("")}}) {
    EXPECT_TRUE(std::isnan(field(p))) << p.x << " " << p.y;
    EXPECT_TRUE(std::isnan((*slope)(p))) << p.x << " " << p.y;
  }
  EXPECT_FALSE(field.bounds({9, 18, 13, 26}).may_be_nan);
  EXPECT_TRUE(field.bounds({9, 18, 13.1, 26}).may_be_nan);
  EXPECT_TRUE(field.bounds({8.9, 18, 13, 26}).may_be_nan);
  EXPECT_TRUE(field.bounds({9, 17.9, 13, 26}).may_be_nan);
  EXPECT_TRUE(field.bounds({9, 18, 13, 26.1}).may_be_nan);
}

TEST(RasterField, HasNoBoundsInABoxBesideIt) {
  const FieldRaster one_node{{0, 0}, 1, 1, 1, 1, {3}};
  const RasterField fields[] = {made(kSmall), made(one_node)};
  const Box of_values[] = {{9, 18, 13, 26}, {-0.5, -0.5, 0.5, 0.5}};
  for (int i = 0; i < 2; ++i) {
    const Box& b = of_values[i];
    const auto slope = fields[i].slope();
    for (const Box& beside : {Box{b.min_x - 2, b.min_y, b.min_x - 0.1, b.max_y},
                              Box{b.max_x + 0.1, b.min_y, b.max_x + 2, b.max_y},
                              Box{b.min_x, b.min_y - 2, b.max_x, b.min_y - 0.1},
                              Box{b.min_x, b.max_y + 0.1, b.max_x, b.max_y + 2}}) {
      EXPECT_GT(fields[i].bounds(beside).lo, fields[i].bounds(beside).hi);
      EXPECT_GT(slope->bounds(beside).lo, slope->bounds(beside).hi);
    }
    const Box around{b.min_x - 2, b.min_y - 2, b.max_x + 2, b.max_y + 2};
    EXPECT_LE(fields[i].bounds(around).lo, fields[i].bounds(around).hi);
    EXPECT_LE(slope->bounds(around).lo, slope->bounds(around).hi);
  }
}

TEST(RasterField, HasHalfACellBesideTheGridTheValueOfTheNearestPoint) {
  const RasterField field = made(kSmall);
  EXPECT_EQ(field({9, 18}), field({10, 20}));
  EXPECT_EQ(field({12.9, 22}), field({12, 22}));
  EXPECT_EQ(field({11, 26}), field({11, 24}));
}

TEST(RasterField, EndsWhereARoundedCornerOfItsDomainMayBe) {
  const RasterField field = made({{-1.05, 0}, 0.1, 1, 3, 2, std::vector<float>(6, 7)});
  EXPECT_EQ(field({-0.8, 0.5}), 7);
  EXPECT_EQ(field({std::nextafter(-0.8, 0), 0.5}), 7);
}

TEST(RasterField, IsUndefinedInEveryCellWithANodeWithoutData) {
  FieldRaster raster{{0, 0}, 1, 1, 5, 5, std::vector<float>(25, 1)};
  raster.values[2 * 5 + 2] = kNoData;
  const RasterField field = made(raster);
  const auto slope = field.slope();
  for (double y = 0.5; y < 4; ++y) {
    for (double x = 0.5; x < 4; ++x) {
      const bool touches = x > 1 && x < 3 && y > 1 && y < 3;
      EXPECT_EQ(std::isnan(field({x, y})), touches) << x << " " << y;
      EXPECT_EQ(std::isnan((*slope)({x, y})), touches) << x << " " << y;
      EXPECT_EQ(field.bounds({x, y, x, y}).may_be_nan, touches) << x << " " << y;
    }
  }
  // The lower left side of a cell is its own, so the node without data need not have a weight.
  EXPECT_TRUE(std::isnan(field({1, 1})));
  EXPECT_TRUE(field.bounds({0, 0, 1, 1}).may_be_nan);
  EXPECT_FALSE(field.bounds({0, 0, 0.99, 4}).may_be_nan);
}

TEST(RasterField, WithoutAnyDataIsUndefinedEverywhere) {
  const RasterField field = made({{0, 0}, 1, 1, 50, 50, std::vector<float>(2500, kNoData)});
  EXPECT_TRUE(std::isnan(field({3, 3})));
  for (const Box& box : {Box{1, 1, 2, 2}, Box{0, 0, 49, 49}, Box{90, 90, 99, 99}}) {
    EXPECT_TRUE(field.bounds(box).may_be_nan);
    EXPECT_GT(field.bounds(box).lo, field.bounds(box).hi) << "no value at all";
    EXPECT_TRUE(field.slope()->bounds(box).may_be_nan);
  }
}

TEST(RasterField, OfOneRowOrColumnOrNodeIsDefinedOnIt) {
  const RasterField row = made({{0, 5}, 1, 1, 3, 1, {1, 2, 4}});
  EXPECT_EQ(row({1.5, 5}), 3);
  EXPECT_EQ((*row.slope())({1.5, 5}), 2);
  EXPECT_TRUE(std::isnan(row({1.5, 5.6})));
  const RasterField column = made({{0, 5}, 1, 1, 1, 3, {1, 2, 4}});
  EXPECT_EQ(column({0, 6.5}), 3);
  EXPECT_EQ((*column.slope())({0, 6.5}), 2);
  EXPECT_TRUE(std::isnan(column({0.6, 6.5})));
  const RasterField node = made({{0, 5}, 1, 1, 1, 1, {-3}});
  EXPECT_EQ(node({0, 5}), -3);
  EXPECT_EQ((*node.slope())({0, 5}), 0);
  EXPECT_TRUE(std::isnan(node({0, 6})));
}

TEST(RasterField, HasBoundsAndSteepnessThatHoldInEveryBox) {
  std::mt19937_64 random(3);
  for (const unsigned holes : {0u, 1u, 30u}) {
    for (const auto& [columns, rows] :
         {std::pair{1, 40}, {40, 1}, {1, 1}, {2, 2}, {7, 3}, {33, 70}, {300, 5}, {100, 100}}) {
      const FieldRaster raster = random_raster(columns, rows, holes, random);
      const RasterField field = made(raster);
      const Box box = box_of(raster);
      expect_bounds_to_hold(field, box, 0.1, 500, true, 1);
      expect_bounds_to_hold(*field.slope(), box, 0.1, 500, false, 2);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RasterField, HasBoundsThatHoldWhereItsValuesAreAFewRoundingsApart) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    FieldRaster raster{{0, 0}, 1, 1, 3, 3, {}};
    for (int k = 0; k < 9; ++k)
      raster.values.push_back(-1.9f + static_cast<float>(random() % 8) * 0x1p-23f);
    const RasterField field = made(raster);
    expect_bounds_to_hold(field, {0, 0, 2, 2}, 1, 50, true, i);
    expect_bounds_to_hold(*field.slope(), {0, 0, 2, 2}, 1, 50, false, i);
    if (HasFatalFailure()) return;
  }
}

TEST(RasterField, HasTheSameBitsAloneAndInBatches) {
  std::mt19937_64 random(5);
  const FieldRaster raster = random_raster(50, 20, 5, random);
  const RasterField field = made(raster);
  expect_same_bits_in_batches(field, box_of(raster), 6);
  expect_same_bits_in_batches(*field.slope(), box_of(raster), 7);
}

TEST(RasterField, HasTheSameBoundsOnAnyNumberOfThreads) {
  std::mt19937_64 random(6);
  const FieldRaster raster = random_raster(500, 400, 5, random);
  const RasterField alone = made(raster);
  for (const int threads : {2, 3, 7}) {
    Arena arena(threads);
    ExecutionContext context;
    context.set_arena(arena);
    const auto field = RasterField::make(raster, "here", context);
    ASSERT_TRUE(field);
    for (int i = 0; i < 1'000; ++i) {
      const Box box = random_box(box_of(raster), 0.1, random);
      EXPECT_EQ(bits(alone.bounds(box).lo), bits(field->bounds(box).lo));
      EXPECT_EQ(bits(alone.bounds(box).hi), bits(field->bounds(box).hi));
      EXPECT_EQ(bits(alone.steepness(box)), bits(field->steepness(box)));
    }
  }
}

TEST(RasterField, StaysGoodWhenItMoves) {
  RasterField field = made(kSmall);
  const RasterField moved = std::move(field);
  EXPECT_EQ(moved({12, 24}), 8);
}

TEST(RasterField, NamesTheFirstValueThatIsInfinite) {
  FieldRaster raster{{0, 0}, 1, 1, 1000, 600, std::vector<float>(600'000, 1)};
  raster.values[3] = kNoData;
  raster.values[500'001] = std::numeric_limits<float>::infinity();
  raster.values[500'002] = -std::numeric_limits<float>::infinity();
  const auto field = RasterField::make(raster, "size.fields[2].raster", ExecutionContext());
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, ErrorCode::kBadSizeValue);
  EXPECT_EQ(field.error().field, "size.fields[2].raster.values[500001]");
  EXPECT_NE(field.error().message.find("inf, at column 1 of row 500"), std::string::npos);
}

TEST(RasterField, StopsWhenTheJobIsCancelledOrLate) {
  ExecutionContext cancelled;
  cancelled.cancel();
  EXPECT_EQ(RasterField::make(kSmall, "here", cancelled).error().code, ErrorCode::kCancelled);
  ExecutionContext late;
  late.set_deadline(std::chrono::steady_clock::now());
  EXPECT_EQ(RasterField::make(kSmall, "here", late).error().code, ErrorCode::kDeadlineExceeded);
}

TEST(RasterField, TakesTheMemoryThatItSays) {
  for (const std::uint32_t side : {1u, 5u, 33u, 1000u}) {
    for (const std::uint32_t rows : {1u, side}) {
      const RasterField field =
          made({{0, 0}, 1, 1, side, rows, std::vector<float>(std::size_t{side} * rows, 1)});
      EXPECT_EQ(field.bytes() - 4 * std::size_t{side} * rows,
                RasterField::bytes_to_make(side, rows));
    }
  }
}

}  // namespace
}  // namespace weft
