// SPDX-License-Identifier: Apache-2.0
// Records of a damaged store, on their way to the wire.
#include "server/wire/job_wire.h"

#include <gtest/gtest.h>

#include "server/store/sql_values.h"

namespace weft::server {
namespace {

TEST(JobWire, WritesWhatClientsCanReadWhateverTheRecordHolds) {
  JobRecord record;
  record.id = "id\xff";
  record.request_id = "\xc3\x28";
  record.worker = "w\x80";
  record.owner = "o\x80";
  record.progress = "\x0f";
  record.error = record.progress;
  record.brief = "\xb2\x01\x02\xff\xff";  // engine_version, no UTF-8
  const v1::Job job = to_wire(record);
  v1::Job read;
  ASSERT_TRUE(read.ParseFromString(job.SerializeAsString()));
  EXPECT_EQ(read.id(), "id?");
  EXPECT_EQ(read.request_id(), "?(");
  EXPECT_EQ(read.worker(), "w?");
  EXPECT_EQ(read.client(), "o?");
  EXPECT_EQ(read.summary().engine_version(), "");
}

TEST(JobWire, SaysWhatBecameOfACallback) {
  JobRecord record;
  EXPECT_FALSE(to_wire(record).has_callback());
  record.callback = {.url = "u\x80", .attempts = 3, .error = "e"};
  for (const auto& [state, wire] :
       {std::pair(CallbackState::kPending, v1::CALLBACK_STATE_PENDING),
        std::pair(CallbackState::kClaimed, v1::CALLBACK_STATE_PENDING),
        std::pair(CallbackState::kDelivered, v1::CALLBACK_STATE_DELIVERED),
        std::pair(CallbackState::kFailed, v1::CALLBACK_STATE_FAILED),
        std::pair(static_cast<CallbackState>(99), v1::CALLBACK_STATE_UNSPECIFIED)}) {
    record.callback.state = state;
    const v1::Job job = to_wire(record);
    EXPECT_EQ(job.callback().state(), wire);
    EXPECT_EQ(job.callback().url(), "u?");
    EXPECT_EQ(job.callback().attempts(), 3U);
    EXPECT_EQ(job.callback().error(), "e");
  }
}

TEST(JobWire, ReadsARequestThatWasChecked) {
  v1::GenerateMeshRequest request;
  for (const double c : {0., 0., 1., 0., 0., 1.}) request.mutable_domain()->add_points(c);
  for (const unsigned i : {0u, 1u, 1u, 2u, 2u, 0u}) request.mutable_domain()->add_segments(i);
  EXPECT_TRUE(read_request({.request = request.SerializeAsString()}));
  request.mutable_domain()->add_segment_markers(1);  // for one segment of three
  const auto damaged = read_request({.request = request.SerializeAsString()});
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().reason, Reason::kStoreBroken);
  EXPECT_FALSE(read_request({.request = "\x0f"}));
  EXPECT_FALSE(read_request({}));  // without a domain
}

TEST(JobWire, RefusesASummaryThatDoesNotParse) {
  EXPECT_TRUE(read_summary({}));
  const auto damaged = read_summary({.summary = "\x0f", .brief = "", .chunks = {}});
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().reason, Reason::kStoreBroken);
}

TEST(SqlValues, HoldAnyTime) {
  EXPECT_EQ(to_micros(from_micros(1'700'000'000'000'001)), 1'700'000'000'000'001);
  constexpr auto kMax = std::numeric_limits<std::int64_t>::max();
  EXPECT_GT(from_micros(kMax), from_micros(kMax / 2000));
  EXPECT_LT(from_micros(-kMax), from_micros(-kMax / 2000));
}

}  // namespace
}  // namespace weft::server
