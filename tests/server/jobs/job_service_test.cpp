// SPDX-License-Identifier: Apache-2.0
// JobService over a real socket and a real store, with engines that do what the test says.
#include <google/protobuf/util/message_differencer.h>

#include <atomic>
#include <cmath>
#include <random>
#include <thread>

#include "engine/base/context.h"
#include "tests/server/job_harness.h"
#include "tests/server/jobs/counted_engines.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

EngineFn endless_engine(Event& begun, Event& stopped) {
  return [&](const auto&, ChunkSink&, weft::Run& run) {
    begun.set();
    auto result = work_until_stopped(run);
    stopped.set();
    return result;
  };
}

TEST(JobService, GivesTheMeshThatGenerateMeshGives) {
  JobServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 5, 4096); });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  const v1::Job job = client.wait(id);
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.summary().chunks(), 5);
  const Fetched fetched = client.fetch(id);
  ASSERT_TRUE(fetched.status.ok()) << fetched.status.error_message();

  const auto stub = v1::MeshService::NewStub(server.channel());
  std::vector<v1::Chunk> expected;
  for (const auto& message : call(*stub, valid_request()).messages)
    if (message.has_chunk()) expected.push_back(message.chunk());
  std::vector<v1::Chunk> chunks;
  for (const auto& message : fetched.messages)
    if (message.has_chunk()) chunks.push_back(message.chunk());
  ASSERT_EQ(chunks.size(), expected.size());
  for (std::size_t i = 0; i < chunks.size(); ++i)
    EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(chunks[i], expected[i]));
  EXPECT_TRUE(fetched.messages.front().has_accepted());
  EXPECT_EQ(fetched.messages.front().accepted().engine_version(), kEngineVersion);
  EXPECT_TRUE(fetched.messages.back().has_summary());
}

TEST(JobService, FindsTheJobOfARequestIdAgain) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  JobClient client = server.client();
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  request.set_request_id("once");
  const auto first = client.submit(request);
  const auto second = client.submit(request);
  ASSERT_TRUE(second.status.ok());
  EXPECT_EQ(second.message.job().id(), first.message.job().id());
}

TEST(JobService, RefusesARequestIdThatNamesAnotherMesh) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  JobClient client = server.client();
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  request.set_request_id("once");
  const auto first = client.submit(request);
  request.mutable_mesh()->mutable_size()->set_constant(0.2);
  const auto second = client.submit(request);
  EXPECT_EQ(second.status.error_code(), grpc::ALREADY_EXISTS);
  EXPECT_EQ(details_of(second.status).error_info.reason(), "REQUEST_ID_REUSED");
  EXPECT_NE(second.status.error_message().find(first.message.job().id()), std::string::npos);
}

TEST(JobService, TellsWhyAJobFailedWithItsDetails) {
  JobServer server([](const auto&, ChunkSink&, auto&) -> Result<Summary> {
    return weft::fail(ErrorCode::kBadCoordinate, "domain.points[3].x", "point 3 is at NaN");
  });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.attempts(), 1);
  EXPECT_EQ(job.error().code(), grpc::INVALID_ARGUMENT);
  const grpc::Status status(grpc::INVALID_ARGUMENT, "", job.error().SerializeAsString());
  EXPECT_EQ(details_of(status).error_info.reason(), "BAD_COORDINATE");
  EXPECT_EQ(details_of(status).bad_request->field_violations(0).field(), "domain.points[3].x");
}

TEST(JobService, TriesAgainWhatFailedForNoFaultOfTheRequest) {
  std::atomic<int> runs{0};
  JobServer server([&](const auto&, ChunkSink& sink, auto&) {
    if (++runs < 3) throw std::runtime_error("a bad day");
    return send_chunks(sink, 1);
  });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 3);
}

TEST(JobService, GivesUpWhatFailsEveryTime) {
  std::atomic<int> runs{0};
  JobServer server([&](const auto&, ChunkSink&, auto&) -> Result<Summary> {
    ++runs;
    throw std::runtime_error("a bad day");
  });
  JobClient client = server.client();
  const v1::Job job = client.wait(client.submit(valid_request()));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(runs, 3);
  EXPECT_NE(job.error().message().find("a bad day"), std::string::npos);
}

TEST(JobService, EndsAJobThatWorksForTooLong) {
  Event begun;
  Event stopped;
  JobServer server(endless_engine(begun, stopped));
  JobClient client = server.client();
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_budget()->set_max_seconds(0.05);
  const v1::Job job = client.wait(client.submit(request));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.error().code(), grpc::DEADLINE_EXCEEDED);
  EXPECT_NE(job.error().message().find("0.05 s"), std::string::npos) << job.error().message();
}

TEST(JobService, StopsTheWorkOfACancelledJob) {
  Event begun;
  Event stopped;
  JobServer server(endless_engine(begun, stopped));
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  const auto cancelled = client.cancel(id);
  EXPECT_EQ(cancelled.message.job().state(), v1::JOB_STATE_CANCELLED);
  EXPECT_TRUE(stopped.wait());
  EXPECT_EQ(client.get(id).message.job().state(), v1::JOB_STATE_CANCELLED);
}

TEST(JobService, GoesOnWithWorkThatAnotherJobWaitsFor) {
  std::atomic<int> runs{0};
  Event begun;
  Event release;
  JobServer server(held_engine(runs, begun, release));
  JobClient client = server.client();
  const std::string first = client.submit(valid_request());
  const std::string second = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  client.cancel(first);
  release.set();
  EXPECT_EQ(client.wait(second).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(client.wait(first).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(runs, 1);
}

TEST(JobService, DeletesOnlyJobsThatHaveEnded) {
  std::atomic<int> runs{0};
  Event begun;
  Event release;
  JobServer server(held_engine(runs, begun, release));
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  const auto refused = client.remove(id);
  EXPECT_EQ(refused.status.error_code(), grpc::FAILED_PRECONDITION);
  EXPECT_EQ(details_of(refused.status).error_info.reason(), "JOB_NOT_DONE");
  release.set();
  client.wait(id);
  EXPECT_TRUE(client.remove(id).status.ok());
  EXPECT_EQ(client.get(id).status.error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(client.remove(id).status.error_code(), grpc::NOT_FOUND);
}

TEST(JobService, SendsTheRestOfAMeshFromAnyChunk) {
  constexpr std::uint32_t kChunks = 6;
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs, kChunks));
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  const Fetched whole = client.fetch(id);
  for (std::uint32_t first = 0; first <= kChunks; ++first) {
    const Fetched rest = client.fetch(id, first);
    ASSERT_TRUE(rest.status.ok());
    ASSERT_EQ(rest.messages.size(), whole.messages.size() - first);
    for (std::size_t i = 1; i < rest.messages.size(); ++i)
      EXPECT_EQ(rest.messages[i].SerializeAsString(),
                whole.messages[i + first].SerializeAsString());
  }
  const Fetched beyond = client.fetch(id, kChunks + 1);
  EXPECT_EQ(beyond.status.error_code(), grpc::OUT_OF_RANGE);
}

TEST(JobService, HasNoMeshOfAJobThatHasNotSucceeded) {
  Event begun;
  Event stopped;
  JobServer server(endless_engine(begun, stopped));
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  EXPECT_EQ(client.fetch(id).status.error_code(), grpc::FAILED_PRECONDITION);
  client.cancel(id);
  EXPECT_EQ(client.fetch(id).status.error_code(), grpc::FAILED_PRECONDITION);
  EXPECT_EQ(client.fetch("01ARZ3NDEKTSV4RRFFQ69G5FAV").status.error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(client.watch("01ARZ3NDEKTSV4RRFFQ69G5FAV").first.error_code(), grpc::NOT_FOUND);
}

TEST(JobServiceIds, AreRefusedByTheirFieldIfTheyCanNameNoJob) {
  std::atomic<int> runs = 0;
  JobServer server(counting_engine(runs));
  const std::string long_id(60'000, 'A');
  for (const std::string& id : {std::string(), std::string("nothing of the kind"),
                                std::string("01arz3ndektsv4rrffq69g5fav"), long_id}) {
    JobClient client = server.client();
    for (const grpc::Status& status :
         {client.get(id).status, client.cancel(id).status, client.remove(id).status,
          client.watch(id).first, client.fetch(id).status}) {
      EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
      const Details details = details_of(status);
      EXPECT_EQ(details.error_info.reason(), "BAD_OPTION");
      ASSERT_TRUE(details.bad_request);
      EXPECT_EQ(details.bad_request->field_violations(0).field(), "id");
      EXPECT_LT(status.error_message().size(), 200u) << "the id was sent back";
    }
  }
  v1::ListJobsRequest request;
  request.set_page_token("nothing of the kind");
  const Details details = details_of(server.client().list(request).status);
  ASSERT_TRUE(details.bad_request);
  EXPECT_EQ(details.bad_request->field_violations(0).field(), "page_token");
  EXPECT_LT(server.log().text().size(), 10'000u);
}

TEST(JobService, TellsThoseWhoWatchHowFarTheWorkIs) {
  Event begun;
  Event release;
  JobServer server([&](const auto&, ChunkSink& sink, weft::Run& run) {
    run.context().enter(Stage::kRefine);
    run.context().add_triangles(12'345);
    begun.set();
    release.wait();
    return send_chunks(sink, 1);
  });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_id(id);
  const auto reader = client.stub().WatchJob(&context, request);
  v1::WatchJobResponse message;
  bool told = false;
  while (reader->Read(&message)) {
    if (message.job().state() != v1::JOB_STATE_RUNNING) continue;
    if (message.job().progress().triangles() != 12'345) continue;
    told = true;
    EXPECT_EQ(message.job().progress().stage(), v1::STAGE_REFINE);
    release.set();
  }
  EXPECT_TRUE(told);
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(message.job().state(), v1::JOB_STATE_SUCCEEDED);
}

TEST(JobService, ListsJobsYoungestFirstInPages) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  JobClient client = server.client();
  std::vector<std::string> ids;
  for (int i = 0; i < 7; ++i) ids.push_back(client.submit(numbered_request(i)));
  for (const auto& id : ids) client.wait(id);
  std::reverse(ids.begin(), ids.end());
  v1::ListJobsRequest request;
  request.set_page_size(3);
  std::vector<std::string> listed;
  do {
    const auto page = client.list(request);
    ASSERT_TRUE(page.status.ok());
    ASSERT_LE(page.message.jobs_size(), 3);
    for (const auto& job : page.message.jobs()) listed.push_back(job.id());
    request.set_page_token(page.message.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(listed, ids);
}

TEST(JobService, ListsJobsOfAState) {
  JobServer server([](const MeshRequest& request, ChunkSink& sink, auto&) -> Result<Summary> {
    if (std::get<double>(request.size.value) == 1)
      return weft::fail(ErrorCode::kEmptyDomain, "domain", "empty");
    return send_chunks(sink, 1);
  });
  JobClient client = server.client();
  const std::string failed = client.submit(numbered_request(0));
  const std::string succeeded = client.submit(numbered_request(1));
  client.wait(failed);
  client.wait(succeeded);
  v1::ListJobsRequest request;
  request.add_states(v1::JOB_STATE_FAILED);
  const auto page = client.list(request);
  ASSERT_EQ(page.message.jobs_size(), 1);
  EXPECT_EQ(page.message.jobs(0).id(), failed);
  request.add_states(v1::JOB_STATE_UNSPECIFIED);
  const auto refused = client.list(request);
  EXPECT_EQ(details_of(refused.status).bad_request->field_violations(0).field(), "states[1]");
}

TEST(JobService, RefusesAPageThatIsTooLarge) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  v1::ListJobsRequest request;
  request.set_page_size(1001);
  const auto refused = server.client().list(request);
  EXPECT_EQ(refused.status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_EQ(details_of(refused.status).bad_request->field_violations(0).field(), "page_size");
}

TEST(JobService, RefusesAJobWhenTooManyWait) {
  Event begun;
  Event stopped;
  JobOptions jobs = quick_jobs();
  jobs.service.max_queued = 2;
  JobServer server(endless_engine(begun, stopped), jobs, {}, {.jobs = 1});
  JobClient client = server.client();
  client.submit(numbered_request(0));
  ASSERT_TRUE(begun.wait());
  client.submit(numbered_request(1));
  client.submit(numbered_request(2));
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = numbered_request(3);
  const auto refused = client.submit(request);
  EXPECT_EQ(refused.status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(details_of(refused.status).error_info.reason(), "QUEUE_FULL");
  EXPECT_TRUE(details_of(refused.status).retry_info);
  *request.mutable_mesh() = numbered_request(2);
  EXPECT_TRUE(client.submit(request).status.ok()) << "it shares what waits already";
}

TEST(JobService, ChecksAJobBeforeItIsAccepted) {
  std::atomic<int> runs{0};
  ServiceOptions limits{.jobs = 1};
  limits.limits.max_points = 3;
  JobServer server(counting_engine(runs), quick_jobs(), {}, limits);
  JobClient client = server.client();
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  EXPECT_EQ(details_of(client.submit(request).status).bad_request->field_violations(0).field(),
            "domain.points");
  request.mutable_mesh()->mutable_domain()->mutable_points()->Truncate(3);
  EXPECT_EQ(client.submit(request).status.error_code(), grpc::INVALID_ARGUMENT);
  request.mutable_mesh()->mutable_domain()->clear_points();
  request.mutable_mesh()->mutable_size()->set_expression("1 +");
  const Details syntax = details_of(client.submit(request).status);
  EXPECT_EQ(syntax.error_info.reason(), "EXPRESSION_SYNTAX");
  EXPECT_EQ(syntax.bad_request->field_violations(0).field(), "size.expression");
  request.mutable_mesh()->mutable_size()->set_constant(-1);
  EXPECT_EQ(details_of(client.submit(request).status).error_info.reason(), "BAD_SIZE_VALUE");
  request.mutable_mesh()->clear_size();
  request.mutable_mesh()->set_first_chunk(1);
  EXPECT_EQ(details_of(client.submit(request).status).bad_request->field_violations(0).field(),
            "first_chunk");
  request.set_request_id(std::string(129, 'a'));
  EXPECT_EQ(details_of(client.submit(request).status).bad_request->field_violations(0).field(),
            "request_id");
  request.set_request_id("a\nb");
  EXPECT_EQ(details_of(client.submit(request).status).bad_request->field_violations(0).field(),
            "request_id");
  EXPECT_EQ(runs, 0);
}

TEST(JobService, TellsNobodyUnlessTheServerHasSecrets) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  request.set_notify("https://example.org/hook");
  const auto answer = server.client().submit(request);
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(answer.status.error_message(), "the server sends no callbacks");
  request.clear_notify();
  const auto accepted = server.client().submit(request);
  ASSERT_TRUE(accepted.status.ok());
  EXPECT_FALSE(accepted.message.job().has_callback());
}

TEST(JobService, ChecksTheCoordinatesOfAJobBeforeItIsAccepted) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs), quick_jobs());
  JobClient client = server.client();
  const auto refusal = [&](auto&& change) {
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = valid_request();
    change(*request.mutable_mesh()->mutable_domain());
    const Details details = details_of(client.submit(request).status);
    return details.error_info.reason() + " " + details.bad_request->field_violations(0).field();
  };
  EXPECT_EQ(refusal([](v1::Domain& d) { d.set_points(5, std::nan("")); }),
            "BAD_COORDINATE domain.points[2].y");
  EXPECT_EQ(refusal([](v1::Domain& d) { d.set_segments(3, 1000); }),
            "INDEX_OUT_OF_RANGE domain.segments[1].b");
  EXPECT_EQ(refusal([](v1::Domain& d) { d.set_snap(-1); }), "BAD_OPTION domain.snap");
  EXPECT_EQ(runs, 0);
}

TEST(JobService, IsNotThereWithoutAStore) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 1); });
  EXPECT_EQ(JobClient(server.channel()).get("x").status.error_code(), grpc::UNIMPLEMENTED);
}

TEST(JobService, AnswersAnyBytesOnAnyMethod) {
  std::atomic<int> runs{0};
  JobServer server(counting_engine(runs));
  const auto channel = server.channel();
  std::mt19937_64 random(5);
  for (int round = 0; round < 60; ++round) {
    std::string bytes(random() % 64, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    for (const char* method : {"SubmitJob", "GetJob", "ListJobs", "WatchJob", "CancelJob",
                               "DeleteJob", "FetchMesh", "NoSuchMethod"}) {
      const std::string path = std::string("/weft.v1.JobService/") + method;
      const auto [status, answer] = raw_unary(channel, path.c_str(), bytes);
      EXPECT_NE(status.error_code(), grpc::UNAVAILABLE) << method;
    }
  }
  EXPECT_TRUE(server.client().list({}).status.ok());
}

}  // namespace
}  // namespace weft::server::testing
