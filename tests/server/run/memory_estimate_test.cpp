// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_estimate.h"

#include "server/wire/translate.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

TEST(ExpectedBytes, AreThoseOfTheLibraryForTheRequestsBudget) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_expression("1e-4");
  EXPECT_EQ(expected_bytes(request, {}), estimate(to_engine(request)).bytes);
  request.mutable_quality()->set_min_angle_deg(35);
  request.mutable_size()->set_constant(1e-12);
  Limits limits;
  EXPECT_EQ(expected_bytes(request, limits), limits.max_bytes);
  request.mutable_budget()->set_max_bytes(30'000'000);
  EXPECT_EQ(expected_bytes(request, limits), 30'000'000u);
  request.mutable_budget()->clear_max_bytes();
  request.mutable_budget()->set_max_triangles(1000);
  EXPECT_LT(expected_bytes(request, limits), 2'000'000u);
}

}  // namespace
}  // namespace weft::server::testing
