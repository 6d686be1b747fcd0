// SPDX-License-Identifier: Apache-2.0
// What a server shows of its jobs beside their own calls: in lists, in its log, in its metrics, and
// of its limits by GetServerInfo.
#include <sstream>
#include <string>

#include "engine/base/context.h"
#include "server/server_options.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

const std::string kTrace = "4bf92f3577b34da6a3ce929d0e0e4736";

EngineFn engine_of_triangles(std::uint64_t triangles) {
  return [=](const auto&, ChunkSink& sink, auto&) {
    Result<Summary> summary = send_chunks(sink, 1);
    if (summary) summary->triangles = triangles;
    return summary;
  };
}

// The line of this event that holds these words; empty if there is none.
std::string line_of(const std::string& log, const std::string& event, const std::string& words) {
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("event=" + event + " ") && line.find(words) != std::string::npos)
      return line;
  return "";
}

std::string field_of(const std::string& line, const std::string& name) {
  const std::string start = " " + name + "=";
  const std::size_t at = line.find(start);
  if (at == std::string::npos) return "";
  const std::size_t value = at + start.size();
  return line.substr(value, line.find(' ', value) - value);
}

TEST(JobLists, TellTheFiguresOfMeshesThatAreKept) {
  JobServer server(engine_of_triangles(4711));
  JobClient client = server.client();
  client.wait(client.submit(numbered_request(0)));
  client.submit(numbered_request(0));  // found in the store
  const auto list = client.list({});
  ASSERT_EQ(list.message.jobs_size(), 2);
  for (const v1::Job& job : list.message.jobs()) {
    EXPECT_EQ(job.summary().triangles(), 4711u) << job.DebugString();
    EXPECT_FALSE(job.summary().engine_version().empty());
  }
}

TEST(JobLists, LeaveOutTheQuadtree) {
  JobServer server([](const auto&, ChunkSink& sink, auto&) {
    Result<Summary> summary = send_chunks(sink, 1);
    summary->leaves = {{0, 0, 1, 1}, {1, 0, 2, 1}};
    return summary;
  });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  EXPECT_EQ(client.list({}).message.jobs(0).summary().leaf_boxes_size(), 0);
  EXPECT_EQ(client.fetch(id).messages.back().summary().leaf_boxes_size(), 8);
}

TEST(Jobs, KeepTheOptionsOfTheirRequestWithTheMesh) {
  JobServer server(engine_of_triangles(1));
  JobClient client = server.client();
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->set_snap(0.25);
  request.mutable_size()->set_expression("0.1 + depth");
  request.mutable_quality()->set_min_angle_deg(0);
  request.mutable_budget()->set_max_triangles(77);
  v1::NamedField& depth = *request.mutable_size()->add_fields();
  depth.set_name("depth");
  depth.mutable_distance()->mutable_points()->Add(1);
  depth.mutable_distance()->mutable_points()->Add(2);
  v1::Name& inlet = *request.mutable_domain()->add_marker_names();
  inlet.set_id(2);
  inlet.set_name("inlet");
  v1::Name& fluid = *request.mutable_domain()->add_region_names();
  fluid.set_id(-1);
  fluid.set_name("fl\u00fcssig");
  v1::GenerateMeshRequest options = request;
  options.mutable_domain()->clear_points();
  options.mutable_domain()->clear_segments();
  options.mutable_domain()->clear_segment_markers();
  options.mutable_domain()->clear_holes();
  options.mutable_domain()->clear_regions();
  options.mutable_size()->mutable_fields(0)->mutable_distance()->clear_points();

  const std::string id = client.submit(request);
  client.wait(id);
  const v1::Summary fetched = client.fetch(id).messages.back().summary();
  EXPECT_EQ(fetched.request().DebugString(), options.DebugString());
  EXPECT_FALSE(client.list({}).message.jobs(0).summary().has_request());
}

TEST(Jobs, OfTheSameMeshWithOtherNamesHaveTheirOwn) {
  JobServer server(engine_of_triangles(1));
  JobClient client = server.client();
  v1::GenerateMeshRequest request = valid_request();
  v1::Name& name = *request.mutable_domain()->add_marker_names();
  name.set_id(2);
  for (const char* text : {"inlet", "outlet"}) {
    name.set_name(text);
    const std::string id = client.submit(request);
    client.wait(id);
    const v1::Summary fetched = client.fetch(id).messages.back().summary();
    EXPECT_EQ(fetched.request().domain().marker_names(0).name(), text);
  }
}

TEST(JobLogs, CarryTheTraceOfTheCallThroughTheWork) {
  JobServer server(engine_of_triangles(1));
  JobClient client = server.client();
  grpc::ClientContext context;
  context.AddMetadata("traceparent", "00-" + kTrace + "-00f067aa0ba902b7-01");
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = valid_request();
  v1::SubmitJobResponse response;
  ASSERT_TRUE(client.stub().SubmitJob(&context, request, &response).ok());
  client.wait(response.job().id());
  // The last line may come after the answer.
  EXPECT_TRUE(eventually([&] { return server.log().contains("event=attempt_ended"); }));
  for (const char* event : {"job_submitted", "attempt_started", "attempt_ended"})
    EXPECT_EQ(field_of(line_of(server.log().text(), event, response.job().id()), "trace"), kTrace)
        << server.log().text();
}

TEST(JobLogs, LeadFromEveryJobToTheTaskThatItShares) {
  Event begun;
  Event release;
  JobServer server([&](const auto&, ChunkSink& sink, auto&) {
    begun.set();
    EXPECT_TRUE(release.wait());
    return send_chunks(sink, 1);
  });
  JobClient client = server.client();
  const std::string first = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  const std::string second = client.submit(valid_request());
  release.set();
  client.wait(second);
  const std::string log = server.log().text();
  const std::string task = field_of(line_of(log, "attempt_started", "job=" + first), "task");
  EXPECT_FALSE(task.empty()) << log;
  EXPECT_EQ(field_of(line_of(log, "job_submitted", "job=" + first), "task"), task) << log;
  EXPECT_EQ(field_of(line_of(log, "job_submitted", "job=" + second), "task"), task) << log;
}

TEST(JobMetrics, CountTheTrianglesThatJobsMakeAndFetchingThemNoMore) {
  JobServer server([](const auto&, ChunkSink& sink, auto&) {
    Chunk chunk = make_chunk(0);
    chunk.triangles = {0, 1, 2, 0, 2, 3};
    EXPECT_TRUE(sink.accept(std::move(chunk)));
    Summary summary;
    summary.chunks = 1;
    return Result<Summary>(summary);
  });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  client.wait(id);
  EXPECT_EQ(server.metric("weft_triangles_total"), 2);
  EXPECT_TRUE(client.fetch(id).status.ok());
  EXPECT_EQ(server.metric("weft_triangles_total"), 2);
}

TEST(JobMetrics, CountACancelledJobOnce) {
  Event begun;
  JobServer server([&](const auto&, ChunkSink&, weft::Run& run) {
    begun.set();
    return work_until_stopped(run);
  });
  JobClient client = server.client();
  const std::string id = client.submit(valid_request());
  ASSERT_TRUE(begun.wait());
  client.cancel(id);
  client.cancel(id);
  EXPECT_EQ(server.metric("weft_jobs_total{state=\"cancelled\"}"), 1);
}

TEST(JobMetrics, CountATaskWhoseWorkersAreAllLost) {
  Event release;
  JobOptions jobs = quick_jobs();
  jobs.runner.lease = std::chrono::milliseconds(50);
  JobServer server(
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        run.context().enter(Stage::kRefine);
        release.wait();
        return send_chunks(sink, 1);
      },
      jobs, {}, {.jobs = 4});
  JobClient client = server.client();
  client.wait(client.submit(valid_request()));
  EXPECT_TRUE(eventually([&] { return server.metric("weft_jobs_total{state=\"failed\"}") == 1; }));
  release.set();
}

TEST(GetServerInfoOfJobs, TellsHowJobsAreQueuedAndKept) {
  JobOptions jobs = quick_jobs();
  jobs.runner.lease = std::chrono::seconds(5);
  jobs.service.max_queued = 7;
  jobs.service.max_open_of_client = 3;
  jobs.retry.max_attempts = 5;
  jobs.runner.keep = {.age = std::chrono::hours(2), .bytes = 4096, .jobs_of_owner = 7};
  ServiceOptions service{.jobs = 2, .queue = 11};
  service.patience.stall_timeout = std::chrono::milliseconds(2500);
  const JobServer server(engine_of_triangles(1), jobs, {}, service);
  grpc::ClientContext context;
  v1::GetServerInfoResponse info;
  const auto stub = v1::MeshService::NewStub(server.channel());
  ASSERT_TRUE(stub->GetServerInfo(&context, {}, &info).ok());
  EXPECT_EQ(info.limits().max_waiting_calls(), 11u);
  ServerOptions options;
  options.service.limits = service.limits;
  EXPECT_EQ(info.limits().max_admitted_bytes(), plan_memory(options).runs);
  EXPECT_EQ(info.limits().stall_seconds(), 2.5);
  EXPECT_EQ(info.jobs().max_queued(), 7u);
  EXPECT_EQ(info.jobs().max_queued_per_client(), 3u);
  EXPECT_EQ(info.jobs().max_attempts(), 5u);
  EXPECT_EQ(info.jobs().lease_seconds(), 5);
  EXPECT_EQ(info.jobs().keep_seconds(), 7200);
  EXPECT_EQ(info.jobs().keep_bytes(), 4096u);
  EXPECT_EQ(info.jobs().keep_jobs_per_client(), 7u);
}

}  // namespace
}  // namespace weft::server::testing
