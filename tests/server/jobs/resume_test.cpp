// SPDX-License-Identifier: Apache-2.0
// Streams that begin at a later chunk, with a scripted engine; with the real one:
// tests/e2e/streaming_test.cpp.
#include <numeric>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

constexpr std::uint32_t kChunks = 20;

Outcome call_from(std::uint32_t first_chunk) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, kChunks); });
  v1::GenerateMeshRequest request = valid_request();
  request.set_first_chunk(first_chunk);
  return call(*server.stub(), request);
}

TEST(FirstChunk, LeavesOutTheChunksBeforeItAndCountsThem) {
  const Outcome outcome = call_from(7);
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  std::vector<std::uint32_t> expected(kChunks - 7);
  std::iota(expected.begin(), expected.end(), 7);
  EXPECT_EQ(outcome.chunk_indices(), expected);
  EXPECT_TRUE(outcome.messages.front().has_accepted());
  EXPECT_EQ(outcome.messages.back().summary().chunks(), kChunks);
}

TEST(FirstChunk, OfTheNumberOfChunksAsksForTheSummaryAlone) {
  const Outcome outcome = call_from(kChunks);
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  EXPECT_TRUE(outcome.chunk_indices().empty());
  EXPECT_EQ(outcome.messages.back().summary().chunks(), kChunks);
}

TEST(FirstChunk, BeyondTheMeshEndsWithOutOfRangeAndNamesTheFieldAndBothNumbers) {
  const Outcome outcome = call_from(kChunks + 1);
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(outcome.status.error_message(), "first_chunk is 21, but the mesh has 20 chunks");
  EXPECT_TRUE(outcome.chunk_indices().empty());
  const Details details = details_of(outcome.status);
  EXPECT_EQ(details.error_info.reason(), "CHUNK_OUT_OF_RANGE");
  ASSERT_TRUE(details.bad_request);
  EXPECT_EQ(details.bad_request->field_violations(0).field(), "first_chunk");
}

}  // namespace
}  // namespace weft::server::testing
