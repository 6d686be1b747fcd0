// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_spec.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

const Raster kRaster{{0, 0}, 1, 1, 2, 1, {1, 3}};

TEST(SizeSpec, OfEachKindIsMadeIntoAFunction) {
  const auto at = [](const SizeSpec& spec) { return (**make_size(spec))({0.5, 0}); };
  EXPECT_TRUE(std::isinf(at({})));
  EXPECT_EQ(at(0.25), 0.25);
  EXPECT_EQ(at("x + 1"), 1.5);
  EXPECT_EQ(at(kRaster), 2);
}

TEST(SizeSpec, TellsWhetherItIsTheSameEverywhere) {
  const auto constant = [](const SizeSpec& spec) { return (*make_size(spec))->constant(); };
  EXPECT_TRUE(std::isinf(constant({}).value()));
  EXPECT_EQ(constant(0.25), 0.25);
  EXPECT_EQ(constant("2^3"), 8);
  EXPECT_EQ(constant("x"), std::nullopt);
  EXPECT_EQ(constant(kRaster), std::nullopt);
}

TEST(SizeSpec, OfAConstantHasItsValueInEveryLaneAndBox) {
  const SizeSpec spec = 0.25;
  const auto size = *make_size(spec);
  alignas(64) const double x[8] = {};
  alignas(64) double out[8] = {};
  size->evaluate(8, x, x, out);
  for (const double value : out) EXPECT_EQ(value, 0.25);
  const Interval bounds = size->bounds({0, 0, 1, 1});
  EXPECT_EQ(bounds.lo, 0.25);
  EXPECT_EQ(bounds.hi, 0.25);
  EXPECT_FALSE(bounds.may_be_nan);
}

TEST(SizeSpec, ThatIsNoSizeNamesItsField) {
  for (const double value : {0.0, -1.0, std::nan(""), 1 / 0.0}) {
    const auto size = make_size(value);
    ASSERT_FALSE(size) << value;
    EXPECT_EQ(size.error().code, ErrorCode::kBadSizeValue);
    EXPECT_EQ(size.error().field, "size.constant");
  }
  EXPECT_EQ(make_size("0").error().field, "size.expression");
  EXPECT_EQ(make_size("x +").error().code, ErrorCode::kExpressionSyntax);
  Raster bad = kRaster;
  bad.values[1] = 0;
  const SizeSpec spec = bad;
  EXPECT_EQ(make_size(spec).error().field, "size.raster.values[1]");
}

// Memory is asked for before it is taken, so the promise must cover it.
TEST(SizeSpec, TakesNoMoreMemoryThanItSays) {
  for (const std::uint32_t side : {1u, 4u, 5u, 33u, 1000u}) {
    const SizeSpec spec = Raster{{0, 0}, 1, 1, side, side, std::vector<double>(side * side, 1)};
    const auto size = *make_size(spec);
    const std::uint64_t held = sizeof(double) * side * side;
    EXPECT_LE(size->bytes() - held, bytes_to_make(spec)) << side;
  }
  EXPECT_EQ(bytes_to_make("x"), 0u);
}

}  // namespace
}  // namespace weft
