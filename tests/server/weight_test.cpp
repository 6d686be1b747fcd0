// SPDX-License-Identifier: Apache-2.0
#include "server/weight.h"

#include <limits>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;

// For a square of area 16.
std::uint64_t weight_of(const char* expression) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_expression(expression);
  return expected_bytes(request, {});
}

TEST(Weight, GrowsWithTheTrianglesThatTheSizeAsksFor) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(16 * 1.55 / 1e6);
  const std::uint64_t million = expected_bytes(request, {});
  EXPECT_NEAR(static_cast<double>(million), 65e6, 5e6);
  request.mutable_size()->set_constant(16 * 1.55 / 1e7);
  EXPECT_NEAR(static_cast<double>(expected_bytes(request, {})), 497e6, 5e6);
}

TEST(Weight, OfAnExpressionIsThatOfItsMean) {
  EXPECT_EQ(weight_of("1e-4"), weight_of("x < 100 ? 1e-4 : 1"));
  // Half of the square asks for a hundred times as much as the other half.
  const std::uint64_t half = weight_of("x < 2 ? 1e-5 : 1e-3") - weight_of("1");
  EXPECT_NEAR(static_cast<double>(half), 0.505 * 16 * 1.55e5 * 48, 1.0 * kMegabyte);
}

TEST(Weight, OfARasterIsThatOfTheMeanOfItsValuesAndTheirOwn) {
  v1::GenerateMeshRequest request = valid_request();
  v1::Raster& raster = *request.mutable_size()->mutable_raster();
  for (int i = 0; i < 1'000'000; ++i) raster.add_values(i < 500'000 ? 1e-5 : 1e-3);
  const std::uint64_t half = expected_bytes(request, {}) - weight_of("1");
  EXPECT_NEAR(static_cast<double>(half), 0.505 * 16 * 1.55e5 * 48 + 16e6, 1.0 * kMegabyte);
}

TEST(Weight, IsAtMostWhatTheJobMayTake) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(1e-12);
  Limits limits;
  EXPECT_EQ(expected_bytes(request, limits), limits.max_bytes);
  request.mutable_budget()->set_max_bytes(30 * kMegabyte);
  EXPECT_EQ(expected_bytes(request, limits), 30 * kMegabyte);
  request.mutable_budget()->clear_max_bytes();
  request.mutable_budget()->set_max_triangles(1000);
  EXPECT_LT(expected_bytes(request, limits), 20 * kMegabyte);
}

TEST(Weight, OfARequestThatMakesNoSenseIsFinite) {
  v1::GenerateMeshRequest request = valid_request();
  for (const char* expression : {"0", "-1", "1/0", "sqrt(-1)", "x +"})
    EXPECT_LE(weight_of(expression), Limits{}.max_bytes) << expression;
  request.mutable_domain()->set_points(0, std::numeric_limits<double>::quiet_NaN());
  request.mutable_domain()->set_points(1, std::numeric_limits<double>::infinity());
  EXPECT_LE(expected_bytes(request, {}), Limits{}.max_bytes);
  EXPECT_LE(expected_bytes(v1::GenerateMeshRequest(), {}), Limits{}.max_bytes);
}

}  // namespace
}  // namespace weft::server::testing
