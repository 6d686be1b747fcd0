// SPDX-License-Identifier: Apache-2.0
// Jobs when something is wrong: a store that fails, readers that do not read, servers that stop.
#include <sqlite3.h>

#include <atomic>
#include <thread>

#include "engine/base/context.h"
#include "tests/server/faulty_store.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;

EngineFn endless_engine(Event& begun) {
  return [&](const auto&, ChunkSink&, weft::Run& run) {
    begun.set();
    return work_until_stopped(run);
  };
}

// Fails the first so many calls of this name.
FaultyStore::Fault failing(std::string name, int times, StoreErrorKind kind) {
  const auto left = std::make_shared<std::atomic<int>>(times);
  return [=](std::string_view call) -> std::optional<StoreError> {
    if (call != name || (*left)-- <= 0) return std::nullopt;
    return StoreError{kind, "out of order"};
  };
}

JobServer::Wrap wrap(FaultyStore::Fault fault) {
  return [fault = std::move(fault)](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
    return std::make_unique<FaultyStore>(std::move(store), fault);
  };
}

class Unavailable : public ::testing::TestWithParam<const char*> {};

TEST_P(Unavailable, StoreForAWhileDelaysAJobAndLosesNothing) {
  JobServer server(engine_of_chunks(3), quick_jobs(),
                   wrap(failing(GetParam(), 3, StoreErrorKind::kUnavailable)));
  JobClient client = server.client();
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  auto submitted = client.submit(request);
  while (submitted.status.error_code() == grpc::UNAVAILABLE) {
    EXPECT_EQ(details_of(submitted.status).error_info.reason(), "STORE_UNAVAILABLE");
    EXPECT_TRUE(details_of(submitted.status).retry_info);
    submitted = client.submit(request);
  }
  const std::string id = submitted.message.job().id();
  std::pair<grpc::Status, std::vector<v1::Job>> watched;
  do {
    watched = client.watch(id);
  } while (watched.first.error_code() == grpc::UNAVAILABLE);
  ASSERT_FALSE(watched.second.empty());
  EXPECT_EQ(watched.second.back().state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(watched.second.back().attempts(), 1);
  Fetched fetched;
  do {
    fetched = client.fetch(id);
  } while (fetched.status.error_code() == grpc::UNAVAILABLE);
  EXPECT_EQ(fetched.chunk_indices().size(), 3);
}

INSTANTIATE_TEST_SUITE_P(Calls, Unavailable,
                         ::testing::Values("submit", "get", "mesh", "chunk", "claim", "renew",
                                           "put_chunk", "finish", "reap"),
                         [](const auto& info) { return std::string(info.param); });

TEST(JobTrouble, ADiskThatIsFullForAWhileCostsAnAttempt) {
  JobServer server(engine_of_chunks(3), quick_jobs(),
                   wrap(failing("put_chunk", 1, StoreErrorKind::kFull)));
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 2);
}

TEST(JobTrouble, ADiskThatStaysFullFailsTheJobByItsName) {
  JobServer server(engine_of_chunks(3), quick_jobs(),
                   wrap(failing("put_chunk", 1000, StoreErrorKind::kFull)));
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 3);
  const grpc::Status status(grpc::RESOURCE_EXHAUSTED, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "STORE_FULL");
}

TEST(JobTrouble, AMeshThatMissesItsBoundsFailsTheJobAtOnceAndIsNotKept) {
  std::atomic<int> runs = 0;
  JobServer server([&](const auto&, ChunkSink& sink, auto&) -> Result<Summary> {
    ++runs;
    send_chunks(sink, 3);
    return fail(ErrorCode::kBoundsNotMet, "", "12 triangles miss a bound");
  });
  JobClient client = server.client();
  for (int attempt = 1; attempt <= 2; ++attempt) {
    const std::string id = client.submit(valid_request());
    const v1::Job job = client.wait(id);
    EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
    EXPECT_EQ(job.attempts(), 1);
    EXPECT_EQ(job.error().code(), grpc::FAILED_PRECONDITION);
    EXPECT_EQ(job.error().message(), "12 triangles miss a bound");
    const grpc::Status status(grpc::FAILED_PRECONDITION, "", job.error().SerializeAsString());
    EXPECT_EQ(details_of(status).error_info.reason(), "BOUNDS_NOT_MET");
    EXPECT_FALSE(job.has_summary());
    const Fetched fetched = client.fetch(id);
    EXPECT_EQ(details_of(fetched.status).error_info.reason(), "JOB_NOT_DONE");
    EXPECT_TRUE(fetched.messages.empty());
    EXPECT_EQ(runs, attempt);
  }
}

TEST(JobTrouble, AJobWhoseWorkersAreAllLostFails) {
  Event release;
  JobOptions jobs = quick_jobs();
  jobs.runner.lease = milliseconds(50);
  JobServer server(
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        run.context().enter(Stage::kRefine);
        release.wait();
        return send_chunks(sink, 1);
      },
      jobs, {}, {.jobs = 4});
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 3);
  const grpc::Status status(grpc::ABORTED, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "WORKERS_LOST");
  EXPECT_TRUE(eventually([&] { return server.metric("weft_leases_lost_total") == 3; }));
  release.set();
}

TEST(JobTrouble, AnEngineThatHangsLosesItsLease) {
  Event release;
  std::atomic<int> runs{0};
  JobOptions jobs = quick_jobs();
  jobs.runner.lease = milliseconds(200);
  jobs.retry.max_attempts = 1000;  // a slow machine may lose leases, too
  JobServer server(
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        if (runs++ == 0) {
          run.context().enter(Stage::kRefine);
          release.wait();
        }
        return send_chunks(sink, 1);
      },
      jobs);
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_GE(job.attempts(), 2);
  EXPECT_TRUE(eventually([&] { return server.metric("weft_leases_lost_total") >= 1; }));
  release.set();
}

// A renewal may come after the commit that ended the claim, or after the job was cancelled.
TEST(JobTrouble, JobsThatEndOrAreCancelledLoseNoLease) {
  JobOptions jobs = quick_jobs();
  jobs.runner.renewal = milliseconds(1);
  Event begun;
  JobServer server(
      [&](const MeshRequest& request, ChunkSink& sink, weft::Run& run) {
        if (std::get<double>(request.size.value) != 1) return send_chunks(sink, 1);
        run.context().enter(Stage::kRefine);
        begun.set();
        return work_until_stopped(run);
      },
      jobs, {}, {.jobs = 4});
  JobClient client = server.client();
  const std::string cancelled = client.submit(numbered_request(0));
  ASSERT_TRUE(begun.wait());
  EXPECT_TRUE(client.cancel(cancelled).status.ok());
  std::vector<std::string> ids;
  for (int i = 1; i <= 200; ++i) ids.push_back(client.submit(numbered_request(i)));
  for (const std::string& id : ids) EXPECT_EQ(client.wait(id).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_TRUE(eventually([&] { return server.metric("weft_running_jobs{queue=\"jobs\"}") == 0; }));
  EXPECT_EQ(server.metric("weft_leases_lost_total"), 0);
}

TEST(JobTrouble, AServerThatStopsPutsItsJobsBack) {
  const files::TempFolder folder;
  Event begun;
  std::string id;
  {
    JobServer server(endless_engine(begun), quick_jobs(), folder.path().string());
    id = server.client().submit(valid_request());
    ASSERT_TRUE(begun.wait());
  }
  JobServer server(engine_of_chunks(2), quick_jobs(), folder.path().string());
  const v1::Job job = server.client().wait(id);
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 1) << "the attempt that was cut short is none";
}

TEST(JobTrouble, AServerThatStopsEndsWatchesAndSendsMeshesToTheirEnd) {
  Event begun;
  JobServer server([&](const MeshRequest& request, ChunkSink& sink, weft::Run& run) {
    if (std::get<double>(request.size.value) == 1) return send_chunks(sink, 16, kMaxChunkBytes);
    begun.set();
    return work_until_stopped(run);
  });
  JobClient client = server.client();
  const std::string done = client.submit(numbered_request(0));
  client.wait(done);
  const std::string endless = client.submit(numbered_request(1));
  ASSERT_TRUE(begun.wait());

  grpc::ClientContext fetching;
  v1::FetchMeshRequest fetch;
  fetch.set_id(done);
  const auto mesh = client.stub().FetchMesh(&fetching, fetch);
  v1::FetchMeshResponse message;
  ASSERT_TRUE(mesh->Read(&message));
  grpc::ClientContext watching;
  v1::WatchJobRequest watch;
  watch.set_id(endless);
  const auto jobs = client.stub().WatchJob(&watching, watch);
  v1::WatchJobResponse job;
  ASSERT_TRUE(jobs->Read(&job));

  std::thread drainer([&] { server->drain(std::chrono::seconds(30)); });
  while (jobs->Read(&job)) continue;
  EXPECT_EQ(jobs->Finish().error_code(), grpc::UNAVAILABLE);
  int chunks = 0;
  while (mesh->Read(&message)) chunks += message.has_chunk() ? 1 : 0;
  EXPECT_TRUE(mesh->Finish().ok());
  EXPECT_EQ(chunks, 16);
  drainer.join();
}

TEST(JobTrouble, ReadersThatDoNotReadHoldBackNobodyElse) {
  constexpr std::uint32_t kChunks = 12;
  JobServer server(engine_of_chunks(kChunks, kMaxChunkBytes));
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::FetchMeshResponse>>> idle;
  std::vector<JobClient> clients;
  v1::FetchMeshRequest request;
  request.set_id(id);
  for (int i = 0; i < 24; ++i) {
    clients.emplace_back(server.channel());
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    idle.push_back(clients.back().stub().FetchMesh(contexts.back().get(), request));
    v1::FetchMeshResponse first;
    ASSERT_TRUE(idle.back()->Read(&first));
  }
  EXPECT_EQ(client.fetch(id).chunk_indices().size(), kChunks);
  for (auto& reader : idle) {
    v1::FetchMeshResponse message;
    int chunks = 0;
    while (reader->Read(&message)) chunks += message.has_chunk() ? 1 : 0;
    EXPECT_EQ(chunks, static_cast<int>(kChunks)) << "they may go on later";
    EXPECT_TRUE(reader->Finish().ok());
  }
}

TEST(JobTrouble, AReaderThatReadsNothingIsCutOff) {
  ServiceOptions service{.jobs = 2};
  service.patience.stall_timeout = milliseconds(200);
  JobServer server(engine_of_chunks(24, kMaxChunkBytes), quick_jobs(), {}, service);
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  grpc::ClientContext context;
  v1::FetchMeshRequest request;
  request.set_id(id);
  const auto reader = client.stub().FetchMesh(&context, request);
  server->drain(std::chrono::seconds(30));  // returns once the reader was cut off
  v1::FetchMeshResponse message;
  int chunks = 0;
  while (reader->Read(&message)) chunks += message.has_chunk() ? 1 : 0;
  EXPECT_FALSE(reader->Finish().ok());
  EXPECT_LT(chunks, 24);
}

TEST(JobTrouble, AWatchThatHasEndedAsksTheStoreNoMoreWhetherItIsReadOrNot) {
  std::string id;
  std::atomic<int> looks{0};
  ServiceOptions service{.jobs = 2};
  service.patience.stall_timeout = milliseconds(400);
  // A job whose last message is more than a client takes that does not read.
  JobServer server(
      engine_of_chunks(1), quick_jobs(), service,
      [&](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
        id = store->submit({.key = std::string(32, 'k')})->job.id;
        google::rpc::Status error;
        error.set_message(std::string(std::size_t{16} << 20, 'x'));
        const auto claim = store->claim("test", std::chrono::hours(1), 1).value().value();
        EXPECT_EQ(store->fail(claim.ref, error.SerializeAsString()), Held::kHeld);
        return std::make_unique<FaultyStore>(std::move(store), [&](std::string_view call) {
          if (call == "get") ++looks;
          return std::optional<StoreError>();
        });
      });
  JobClient client = server.client();
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_id(id);
  const auto reader = client.stub().WatchJob(&context, request);
  EXPECT_TRUE(eventually([&] { return server.log().contains("method=WatchJob status=OK"); }));
  server->drain(std::chrono::seconds(30));  // returns once the reader was cut off
  EXPECT_EQ(looks, 1);
}

TEST(JobTrouble, AMeshThatIsNoLongerKeptIsGoneByThatName) {
  JobOptions jobs = quick_jobs();
  jobs.runner.keep = {.age = std::chrono::hours(1), .bytes = 1};
  jobs.runner.between_collections = milliseconds(5);
  JobServer server(engine_of_chunks(3), jobs);
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  Fetched fetched;
  do {
    fetched = client.fetch(id);
  } while (fetched.status.ok());
  EXPECT_EQ(fetched.status.error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(details_of(fetched.status).error_info.reason(), "MESH_GONE");
  EXPECT_EQ(client.get(id).message.job().state(), v1::JOB_STATE_SUCCEEDED);
}

// Flips a bit in the last chunk that was stored.
void flip_a_bit(const files::TempFolder& folder) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "weft.db").c_str(), &database), SQLITE_OK);
  sqlite3_busy_timeout(database, 10'000);
  sqlite3_blob* bytes = nullptr;
  ASSERT_EQ(sqlite3_blob_open(database, "main", "chunk_bytes", "bytes", 3, 1, &bytes), SQLITE_OK);
  char byte = 0;
  sqlite3_blob_read(bytes, &byte, 1, 17);
  byte ^= 4;
  EXPECT_EQ(sqlite3_blob_write(bytes, &byte, 1, 17), SQLITE_OK);
  sqlite3_blob_close(bytes);
  sqlite3_close(database);
}

TEST(JobTrouble, AMeshThatTheStoreHasDamagedIsMadeAnew) {
  const files::TempFolder folder;
  JobServer server(engine_of_chunks(3), quick_jobs(), folder.path().string());
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  const Fetched whole = client.fetch(id);
  ASSERT_TRUE(whole.status.ok());
  flip_a_bit(folder);
  EXPECT_EQ(server.metric("weft_damaged_chunks_total"), 0);
  const Fetched damaged = client.fetch(id);
  EXPECT_EQ(details_of(damaged.status).error_info.reason(), "MESH_GONE");
  EXPECT_NE(damaged.status.error_message().find("damaged"), std::string::npos);
  EXPECT_LE(damaged.chunk_indices().size(), 2u) << "nothing from the damage on";
  EXPECT_EQ(server.metric("weft_damaged_chunks_total"), 1);
  EXPECT_TRUE(server.log().contains("event=chunk_damaged job=" + id));
  const std::string again = client.submit(valid_request());
  EXPECT_FALSE(client.wait(again).from_store());
  for (const std::string& each : {id, again}) {
    const Fetched anew = client.fetch(each);
    ASSERT_TRUE(anew.status.ok()) << anew.status.error_message();
    ASSERT_EQ(anew.messages.size(), whole.messages.size());
    for (std::size_t i = 1; i + 1 < whole.messages.size(); ++i)
      EXPECT_EQ(anew.messages[i].SerializeAsString(), whole.messages[i].SerializeAsString());
  }
}

TEST(JobTrouble, AMeshThatIsMadeInSpiteOfAKeptOneMendsItsChunks) {
  const files::TempFolder folder;
  JobServer server(engine_of_chunks(3), quick_jobs(), folder.path().string());
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  flip_a_bit(folder);
  v1::SubmitJobRequest submission;
  *submission.mutable_mesh() = valid_request();
  submission.set_no_cache(true);
  const std::string again = client.submit(submission).message.job().id();
  client.wait(again);
  EXPECT_EQ(server.metric("weft_damaged_chunks_total"), 1);
  EXPECT_TRUE(client.fetch(id).status.ok());
  EXPECT_TRUE(client.fetch(again).status.ok());
}

}  // namespace
}  // namespace weft::server::testing
