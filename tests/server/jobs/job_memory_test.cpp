// SPDX-License-Identifier: Apache-2.0
// Jobs if there is no memory for them outside of the engine: that costs at most an attempt, never
// the server, and everything that was taken is given back. Within the engine it is the same, unless
// the job's own budget runs out.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "tests/server/faulty_store.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

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
      [&](const auto&, ChunkSink&, weft::Run& run) {
        begun.set();
        return work_until_stopped(run);
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

// A fetched mesh of 16 chunks whose client reads nothing. gRPC buffers the first messages.
class FetchedMesh : public ::testing::Test {
 protected:
  using Reader = std::unique_ptr<grpc::ClientReader<v1::FetchMeshResponse>>;

  void serve(double client_share) {
    server_.emplace([](const auto&, ChunkSink& sink,
                       auto&) { return send_chunks(sink, kChunks, kMaxChunkBytes / 2); },
                    quick_jobs(), ServiceOptions{.jobs = 2, .client_share = client_share},
                    [this](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
                      return std::make_unique<FaultyStore>(std::move(store),
                                                           [this](std::string_view call) {
                                                             if (call == "chunk") ++chunks_read_;
                                                             return std::optional<StoreError>();
                                                           });
                    });
    JobClient client = server_->client();
    id_ = client.submit(valid_request());
    EXPECT_EQ(client.wait(id_).state(), v1::JOB_STATE_SUCCEEDED);
    EXPECT_TRUE(eventually([&] { return held() == 0; }));
  }

  Reader fetch(grpc::ClientContext& context) {
    v1::FetchMeshRequest request;
    request.set_id(id_);
    stub_ = v1::JobService::NewStub(server_->channel());
    return stub_->FetchMesh(&context, request);
  }

  static std::uint32_t chunks_of(Reader& reader) {
    std::uint32_t chunks = 0;
    v1::FetchMeshResponse message;
    while (reader->Read(&message)) chunks += message.has_chunk() ? 1 : 0;
    EXPECT_TRUE(reader->Finish().ok());
    return chunks;
  }

  int chunks_read_at_rest() const {
    int before = -1;
    while (before != chunks_read_) {
      before = chunks_read_;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return before;
  }

  double held() const { return server_->metric("weft_admission_bytes{queue=\"calls\"}"); }

  static constexpr std::uint32_t kChunks = 16;
  std::string id_;
  std::atomic<int> chunks_read_{0};
  std::optional<JobServer> server_;
  std::unique_ptr<v1::JobService::Stub> stub_;
};

TEST_F(FetchedMesh, HoldsMemoryOfWhatIsReadAhead) {
  serve(1);
  grpc::ClientContext context;
  Reader reader = fetch(context);
  EXPECT_TRUE(eventually([&] { return chunks_read_ >= 4; }));
  EXPECT_GT(held(), 0);
  EXPECT_EQ(chunks_of(reader), kChunks);
  EXPECT_TRUE(eventually([&] { return held() == 0; }));
}

// The client's first reader has all of its share.
TEST_F(FetchedMesh, IsReadNoFurtherAheadThanThereIsMemory) {
  serve(1e-9);
  grpc::ClientContext first_context;
  Reader first = fetch(first_context);
  EXPECT_TRUE(eventually([&] { return chunks_read_ >= 4; }));
  const double of_one = held();
  EXPECT_GT(of_one, 0);
  const int by_first = chunks_read_at_rest();
  grpc::ClientContext second_context;
  Reader second = fetch(second_context);
  EXPECT_TRUE(eventually([&] { return chunks_read_ > by_first; }));
  EXPECT_LT(chunks_read_at_rest() - by_first, by_first);
  EXPECT_EQ(held(), of_one);
  EXPECT_EQ(chunks_of(second), kChunks);
  EXPECT_EQ(chunks_of(first), kChunks);
  EXPECT_TRUE(eventually([&] { return held() == 0; }));
}

TEST(JobAttempts, ThatWereCutShortByAStopDoNotCount) {
  const files::TempFolder folder;
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
