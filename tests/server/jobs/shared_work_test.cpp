// SPDX-License-Identifier: Apache-2.0
// Jobs that ask for the same mesh: they share the work, its result and its failure, and nothing
// that is one job's own.
#include <atomic>
#include <string>

#include "tests/server/job_harness.h"
#include "tests/server/jobs/counted_engines.h"

namespace weft::server::testing {
namespace {

TEST(SharedWork, MakesAMeshOnceHoweverOftenItIsAskedFor) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  JobClient client = server.client();
  const v1::Job first = client.wait(client.submit(valid_request()));
  EXPECT_FALSE(first.from_store());
  v1::GenerateMeshRequest spelled_otherwise = valid_request();
  spelled_otherwise.set_threads(7);
  spelled_otherwise.mutable_quality()->set_min_angle_deg(20);
  v1::SubmitJobRequest again;
  *again.mutable_mesh() = spelled_otherwise;
  const auto second = client.submit(again);
  ASSERT_TRUE(second.status.ok());
  EXPECT_NE(second.message.job().id(), first.id());
  EXPECT_EQ(second.message.job().state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_TRUE(second.message.job().from_store());
  EXPECT_EQ(second.message.job().summary().chunks(), 3);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(client.fetch(second.message.job().id()).chunk_indices().size(), 3);
}

TEST(SharedWork, MakesAMeshAnewWhereThatIsAskedFor) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  JobClient client = server.client();
  client.wait(client.submit(valid_request()));
  v1::SubmitJobRequest again;
  *again.mutable_mesh() = valid_request();
  again.set_no_cache(true);
  const auto second = client.submit(again);
  EXPECT_FALSE(client.wait(second.message.job().id()).from_store());
  EXPECT_EQ(runs, 2);
}

TEST(SharedWork, LetsJobsOfTheSameMeshShareTheWork) {
  std::atomic<int> runs{0};
  Event begun;
  Event release;
  JobServer server(held_engine(runs, begun, release));
  JobClient client = server.client();
  const std::string first = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  const std::string second = client.submit(valid_request());
  EXPECT_NE(first, second);
  release.set();
  EXPECT_EQ(client.wait(first).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(client.wait(second).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(runs, 1);
}

TEST(SharedWork, FailsNoJobByTheSmallerBudgetOfAnother) {
  std::atomic<int> runs{0};
  Event begun;
  JobServer server([&](const auto&, ChunkSink& sink, weft::Run& run) {
    if (runs++ > 0) return send_chunks(sink, 1);
    begun.set();
    return work_until_stopped(run);
  });
  JobClient client = server.client();
  v1::GenerateMeshRequest hasty = valid_request();
  hasty.mutable_budget()->set_max_seconds(0.3);
  const std::string first = client.submit(hasty);
  ASSERT_TRUE(begun.wait());
  const std::string second = client.submit(valid_request());
  EXPECT_EQ(client.wait(first).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(client.wait(second).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(runs, 2);
}

TEST(SharedWork, NamesEachOfTheJobsThatSharedAFailure) {
  std::atomic<int> runs{0};
  Event begun;
  Event release;
  JobServer server([&](const auto&, ChunkSink&, auto&) -> Result<Summary> {
    ++runs;
    begun.set();
    release.wait();
    return weft::fail(ErrorCode::kEmptyDomain, "domain", "empty");
  });
  JobClient client = server.client();
  const std::string first = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  const std::string second = client.submit(valid_request());
  release.set();
  for (const std::string& id : {first, second}) {
    const v1::Job job = client.wait(id);
    const grpc::Status status(grpc::INVALID_ARGUMENT, "", job.error().SerializeAsString());
    const Details details = details_of(status);
    EXPECT_EQ(details.error_info.reason(), "EMPTY_DOMAIN");
    EXPECT_EQ(details.error_info.metadata().at("job_id"), id);
  }
  EXPECT_EQ(runs, 1);
}

}  // namespace
}  // namespace weft::server::testing
