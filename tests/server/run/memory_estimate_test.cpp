// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_estimate.h"

#include "server/wire/translate.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

TEST(MemoryEstimate, OfARunStaysWithinTheBudgetOfItsRequest) {
  v1::GenerateMeshRequest request = valid_request();
  Limits limits;
  const auto expected = [&] {
    return estimate(*to_engine(request), to_budget(request.budget(), limits)).bytes;
  };
  request.mutable_quality()->set_min_angle_deg(35);
  request.mutable_size()->set_constant(1e-12);
  EXPECT_EQ(expected(), limits.max_bytes);
  request.mutable_budget()->set_max_bytes(30'000'000);
  EXPECT_EQ(expected(), 30'000'000u);
  request.mutable_budget()->clear_max_bytes();
  request.mutable_budget()->set_max_triangles(1000);
  EXPECT_LT(expected(), 2'000'000u);
}

// A call keeps only this form while it waits for its run.
TEST(MemoryEstimate, OfARequestHasRoomForTheEnginesForm) {
  v1::GenerateMeshRequest request;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    request.mutable_domain()->add_segments(i);
    request.mutable_domain()->add_segments(i + 1);
  }
  const Pslg pslg = to_engine(request)->pslg;
  const std::uint64_t engine_bytes = pslg.segments.size() * sizeof(pslg.segments.front());
  EXPECT_LE(engine_bytes, bytes_of_larger_form(request));
  EXPECT_GT(engine_bytes, request.SpaceUsedLong()) << "the wire's form is larger";
}

}  // namespace
}  // namespace weft::server::testing
