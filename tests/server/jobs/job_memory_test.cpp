// SPDX-License-Identifier: Apache-2.0
// Jobs when there is no memory for them outside the engine: it costs an attempt at most, never the
// server, and what was taken is given back. The same within the engine, but where it is the job's
// own budget that runs out.
#include <atomic>
#include <new>
#include <stdexcept>

#include "tests/server/faulty_store.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

EngineFn engine_of_chunks(std::uint32_t chunks) {
  return [=](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, chunks); };
}

// No memory for the first so many calls of this name; `calls` counts them.
JobServer::Wrap without_memory(std::string name, int times, std::atomic<int>& calls) {
  return [=, &calls](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
    return std::make_unique<FaultyStore>(
        std::move(store), [=, &calls](std::string_view call) -> std::optional<StoreError> {
          if (call == name && calls++ < times) throw std::bad_alloc();
          return std::nullopt;
        });
  };
}

JobOptions collecting() {
  JobOptions jobs = quick_jobs();
  jobs.runner.keep.age = std::chrono::hours(1);
  jobs.runner.keep.bytes = std::uint64_t{1} << 30;
  jobs.runner.between_collections = std::chrono::milliseconds(5);
  return jobs;
}

class WantOfMemory : public ::testing::TestWithParam<const char*> {};

TEST_P(WantOfMemory, CostsAnAttemptAtMost) {
  std::atomic<int> calls{0};
  JobServer server(engine_of_chunks(3), collecting(), without_memory(GetParam(), 1, calls));
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_LE(job.attempts(), 2u);
  EXPECT_TRUE(eventually([&] { return calls > 0; })) << "it was never called";
  // The last figures may come after the answer.
  EXPECT_TRUE(eventually([&] { return server.metric("weft_running_jobs{queue=\"jobs\"}") == 0; }));
  EXPECT_EQ(server.metric("weft_admission_bytes{queue=\"jobs\"}"), 0);
}

INSTANTIATE_TEST_SUITE_P(In, WantOfMemory, ::testing::Values("claim", "finish", "reap", "collect"),
                         [](const auto& info) { return std::string(info.param); });

TEST(WantOfMemory, WhenALeaseIsRenewedIsOvercome) {
  std::atomic<int> renewals{0};
  JobServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        EXPECT_TRUE(eventually([&] { return renewals > 2; }));
        return send_chunks(sink, 1);
      },
      quick_jobs(), without_memory("renew", 2, renewals));
  JobClient client = server.client();
  EXPECT_EQ(client.wait(client.submit(valid_request())).attempts(), 1u);
}

TEST(WantOfMemory, InTheEngineCostsAnAttempt) {
  std::atomic<int> runs{0};
  JobServer server([&](const auto&, ChunkSink& sink, auto&) -> Result<Summary> {
    if (runs++ == 0) throw std::bad_alloc();
    return send_chunks(sink, 1);
  });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 2u);
}

TEST(WantOfMemory, InTheEngineEveryTimeFailsTheJobByItsName) {
  JobServer server(
      [](const auto&, ChunkSink&, auto&) -> Result<Summary> { throw std::bad_alloc(); });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 3u);
  const grpc::Status status(grpc::RESOURCE_EXHAUSTED, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "OUT_OF_MEMORY");
}

TEST(WantOfMemory, OfTheBudgetFailsTheJobAtOnce) {
  JobServer server([](const auto&, ChunkSink&, auto&) -> Result<Summary> {
    return fail(ErrorCode::kBudgetExceeded, "budget.max_bytes", "over the budget");
  });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 1u);
  const grpc::Status status(grpc::RESOURCE_EXHAUSTED, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "BUDGET_EXCEEDED");
}

TEST(WantOfMemory, EveryTimeFailsTheJob) {
  std::atomic<int> calls{0};
  JobServer server(engine_of_chunks(3), quick_jobs(), without_memory("finish", 1000, calls));
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 3u);
  EXPECT_EQ(calls, 3);
  const grpc::Status status(grpc::RESOURCE_EXHAUSTED, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "OUT_OF_MEMORY");
  EXPECT_TRUE(eventually([&] { return server.metric("weft_jobs_total{state=\"failed\"}") == 1; }));
}

TEST(WantOfMemory, WhileAJobIsWatchedEndsTheWatchAlone) {
  Event begun;
  std::atomic<bool> short_of_memory{false};
  JobServer server(
      [&](const auto&, ChunkSink&, ExecutionContext& context) {
        begun.set();
        return work_until_stopped(context);
      },
      quick_jobs(),
      [&](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
        return std::make_unique<FaultyStore>(std::move(store), [&](std::string_view call) {
          if (call == "get" && short_of_memory) throw std::bad_alloc();
          return std::optional<StoreError>();
        });
      });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_id(id);
  const auto reader = client.stub().WatchJob(&context, request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(reader->Read(&message));
  short_of_memory = true;
  while (reader->Read(&message)) continue;
  EXPECT_EQ(reader->Finish().error_code(), grpc::INTERNAL);
  short_of_memory = false;
  EXPECT_EQ(client.get(id).message.job().state(), v1::JOB_STATE_RUNNING);
}

TEST(JobAttempts, ThatWereCutShortByAStopDoNotCount) {
  const client::TempFolder folder;
  {
    // Claimed and put back as by servers that stop, more often than there are attempts.
    const auto store = SqliteStore::open({.folder = folder.path().string()}).value();
    v1::GenerateMeshRequest mesh = valid_request();
    Submission submission{.request_id = "r", .key = std::string(32, 'k')};
    submission.request = mesh.SerializeAsString();
    ASSERT_TRUE(store->submit(submission));
    for (int i = 0; i < 5; ++i) {
      const auto claim = store->claim("stops", std::chrono::hours(1), 1 << 30);
      ASSERT_TRUE(claim && *claim);
      ASSERT_TRUE(store->release((*claim)->ref, std::chrono::milliseconds(0), false));
    }
  }
  std::atomic<int> runs{0};
  JobServer server(
      [&](const auto&, ChunkSink& sink, auto&) -> Result<Summary> {
        if (runs++ == 0) throw std::runtime_error("out of order");
        return send_chunks(sink, 1);
      },
      quick_jobs(), folder.path().string());
  JobClient client = server.client();
  const auto list = client.list({});
  ASSERT_EQ(list.message.jobs_size(), 1);
  const v1::Job job = client.wait(list.message.jobs(0).id());
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED) << job.DebugString();
  EXPECT_EQ(job.attempts(), 2u);
}

}  // namespace
}  // namespace weft::server::testing
