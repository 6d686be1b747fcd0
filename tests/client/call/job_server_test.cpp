// SPDX-License-Identifier: Apache-2.0
#include "client/call/job_server.h"

#include <gtest/gtest.h>

#include "client/call/fetch_mesh.h"
#include "client/call/mesh_request.h"
#include "client/report/watch_job.h"
#include "tests/client/support/fake_jobs.h"
#include "tests/client/support/torn_relay.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

using grpc::StatusCode;

class JobCalls : public ::testing::Test {
 protected:
  JobServer connect(const std::string& address, std::uint32_t retries = 8,
                    std::optional<double> timeout = std::nullopt) {
    JobServer server =
        std::move(JobServer::connect({{.server = address}, timeout, retries}, {}).value());
    server.on_away([this](const std::string& what) { told_.push_back(what); });
    return server;
  }
  static v1::SubmitJobRequest submission(const std::string& request_id) {
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = make_request(square_domain(4), {});
    request.set_request_id(request_id);
    return request;
  }
  template <class T>
  static int exit_of(const Result<T>& result) {
    return result ? 0 : static_cast<int>(result.error().exit);
  }

  TempFolder folder_;
  JobsServer fake_{"unix:" + (folder_ / "s").string()};
  FakeJobs& jobs_ = fake_.jobs();
  JobServer server_ = connect(fake_.address());
  std::vector<std::string> told_;
};

TEST_F(JobCalls, NeedAServerThatIsNamed) {
  const auto server = JobServer::connect({}, {});
  ASSERT_EQ(exit_of(server), 2);
  EXPECT_NE(server.error().message.find("give --server ADDR, or WEFT_SERVER"), std::string::npos);
}

TEST_F(JobCalls, SubmitOnceWhereTheAnswerIsLost) {
  jobs_.fail("SubmitJob", {{.done = true}, {.done = false}, {.done = true}});
  const auto job = server_.submit(submission("nightly"));
  ASSERT_TRUE(job) << job.error().message;
  EXPECT_EQ(job->request_id(), "nightly");
  EXPECT_EQ(jobs_.count(), 1u);
  EXPECT_EQ(jobs_.calls("SubmitJob"), 4u);
  EXPECT_EQ(told_, (std::vector<std::string>{"the server " + fake_.address() +
                                             " answers UNAVAILABLE, trying again"}));
}

TEST_F(JobCalls, SubmitAgainWhenAQueueHasRoom) {
  jobs_.fail("SubmitJob", {{.status = queue_full(1)}, {.status = queue_full(1)}});
  EXPECT_TRUE(server_.submit(submission("a")));
  EXPECT_EQ(jobs_.calls("SubmitJob"), 3u);
}

TEST_F(JobCalls, GiveEveryErrorItsExitCodeAtOnce) {
  for (int code = 1; code <= 16; ++code) {
    if (code == StatusCode::UNAVAILABLE) continue;
    const std::vector<Fault> fault = {{.status = {static_cast<StatusCode>(code), "no"}}};
    for (const char* call :
         {"SubmitJob", "GetJob", "ListJobs", "WatchJob", "CancelJob", "DeleteJob", "FetchMesh"})
      jobs_.fail(call, fault);
    jobs_.put(sample_job("job-1", v1::JOB_STATE_SUCCEEDED));
    EXPECT_EQ(exit_of(server_.submit(submission("a"))), 64 + code);
    EXPECT_EQ(exit_of(server_.get("job-1")), 64 + code);
    EXPECT_EQ(exit_of(server_.list({}, {})), 64 + code);
    EXPECT_EQ(exit_of(server_.cancel("job-1")), 64 + code);
    EXPECT_EQ(exit_of(server_.remove("job-1")), 64 + code);
    EXPECT_EQ(exit_of(watch_job(server_, "job-1", {})), 64 + code);
    const auto spool = MeshSpool::create(folder_.path()).value();
    EXPECT_EQ(exit_of(fetch_mesh(server_, "job-1", *spool, {})), 64 + code);
  }
  EXPECT_TRUE(told_.empty());
}

TEST_F(JobCalls, GiveUpWhenTheServerStaysAway) {
  fake_.stop();
  JobServer server = connect(fake_.address(), 2);
  EXPECT_EQ(exit_of(server.get("job-1")), 78);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(JobCalls, FindTheServerThatComesBack) {
  fake_.stop();
  jobs_.put(sample_job("job-1", v1::JOB_STATE_QUEUED));
  server_.on_away([this](const std::string&) { fake_.start(); });
  EXPECT_TRUE(server_.get("job-1"));
}

TEST_F(JobCalls, EndAtTheirTimeout) {
  fake_.stop();
  JobServer server = connect(fake_.address(), 1'000'000, 0.3);
  const int code = exit_of(server.get("job-1"));
  EXPECT_TRUE(code == 68 || code == 78) << code;  // in the middle of a try, or between two
}

TEST_F(JobCalls, ListAllPagesInOrder) {
  jobs_.set_page_limit(3);
  for (int i = 100; i < 111; ++i)
    jobs_.put(sample_job("job-" + std::to_string(i),
                         i % 2 == 0 ? v1::JOB_STATE_QUEUED : v1::JOB_STATE_FAILED));
  const auto all = server_.list({}, {});
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 11u);
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ((*all)[i].id(), "job-" + std::to_string(110 - i));
  EXPECT_EQ(jobs_.calls("ListJobs"), 4u);
  const auto queued = server_.list({v1::JOB_STATE_QUEUED}, {});
  ASSERT_TRUE(queued);
  EXPECT_EQ(queued->size(), 6u);
  EXPECT_EQ(queued->back().id(), "job-100");
}

TEST_F(JobCalls, ListNoMoreThanTheLimit) {
  jobs_.set_page_limit(3);
  for (int i = 100; i < 111; ++i)
    jobs_.put(sample_job("job-" + std::to_string(i), v1::JOB_STATE_QUEUED));
  EXPECT_EQ(server_.list({}, 5).value().size(), 5u);
  EXPECT_EQ(jobs_.page_sizes(), (std::vector<std::uint32_t>{5, 2}));
  EXPECT_EQ(server_.list({}, 1).value().size(), 1u);
}

TEST_F(JobCalls, ListAPageAgainWhereItBroke) {
  jobs_.set_page_limit(2);
  for (int i = 0; i < 5; ++i)
    jobs_.put(sample_job("job-" + std::to_string(i), v1::JOB_STATE_QUEUED));
  jobs_.fail("ListJobs", {{}});
  EXPECT_EQ(server_.list({}, {}).value().size(), 5u);
}

TEST_F(JobCalls, TakeAJobForDeletedThatIsGoneWhenTheAnswerWasLost) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_FAILED));
  jobs_.fail("DeleteJob", {{.done = true}});
  EXPECT_TRUE(server_.remove("job-1"));
  EXPECT_EQ(exit_of(server_.remove("job-1")), 69);
}

TEST_F(JobCalls, DoNotDeleteAJobThatHasNotEnded) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_RUNNING));
  EXPECT_EQ(exit_of(server_.remove("job-1")), 73);
}

TEST_F(JobCalls, CancelAgainWhereTheAnswerWasLost) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_RUNNING));
  jobs_.fail("CancelJob", {{.done = true}});
  EXPECT_EQ(server_.cancel("job-1").value().state(), v1::JOB_STATE_CANCELLED);
}

// A job that queues, runs twice as far, and succeeds.
std::vector<v1::Job> steps_to_success() {
  std::vector<v1::Job> steps = {
      sample_job("", v1::JOB_STATE_QUEUED), sample_job("", v1::JOB_STATE_RUNNING),
      sample_job("", v1::JOB_STATE_RUNNING), sample_job("", v1::JOB_STATE_SUCCEEDED)};
  steps[2].mutable_progress()->set_triangles(2000);
  return steps;
}

class Watch : public JobCalls {
 protected:
  std::string submit() {
    jobs_.plan(steps_to_success());
    return server_.submit(submission("a")).value().id();
  }
  // States, and triangles of those that run.
  std::vector<std::string> seen_;
  Result<v1::Job> watch(JobServer& server, const std::string& id) {
    return watch_job(server, id, [this](const v1::Job& job) {
      seen_.push_back(v1::JobState_Name(job.state()).substr(10) +
                      (job.has_progress() ? std::to_string(job.progress().triangles()) : ""));
    });
  }
  const std::vector<std::string> kAll = {"QUEUED", "RUNNING1000", "RUNNING2000", "SUCCEEDED"};
};

TEST_F(Watch, TellsEveryChangeToTheEnd) {
  const auto job = watch(server_, submit());
  ASSERT_TRUE(job) << job.error().message;
  EXPECT_EQ(job->state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job->summary().triangles(), 32u);
  EXPECT_EQ(seen_, kAll);
}

TEST_F(Watch, TellsNothingTwiceWhereverItBreaks) {
  // Each watch shows one more change, and breaks; one even before it says a word.
  jobs_.fail("WatchJob", {{.messages = 1}, {.messages = 2}, {.messages = 0}, {.messages = 2}});
  const auto job = watch(server_, submit());
  ASSERT_TRUE(job) << job.error().message;
  EXPECT_EQ(seen_, kAll);
  EXPECT_EQ(jobs_.calls("WatchJob"), 5u);
}

TEST_F(Watch, IsContentWithTheLastWordWhateverFollows) {
  jobs_.fail("WatchJob", {{.messages = 4}});
  EXPECT_TRUE(watch(server_, submit()));
  EXPECT_EQ(jobs_.calls("WatchJob"), 1u);
}

TEST_F(Watch, IsTakenUpWhereItEndsBeforeTheJob) {
  jobs_.fail("WatchJob", {{.status = grpc::Status::OK, .messages = 2}});
  EXPECT_TRUE(watch(server_, submit()));
  EXPECT_EQ(seen_, kAll);
}

TEST_F(Watch, GivesUpWhenNothingNewComes) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_RUNNING));
  jobs_.fail("WatchJob", std::vector<Fault>(10, Fault{.messages = 1}));
  JobServer server = connect(fake_.address(), 2);
  EXPECT_EQ(exit_of(watch(server, "job-1")), 78);
  EXPECT_EQ(jobs_.calls("WatchJob"), 3u);
}

TEST_F(Watch, SaysThatAJobIsUnknown) {
  EXPECT_EQ(exit_of(watch(server_, "job-9")), 69);
}

TEST_F(Watch, EndsWhenAskedToStop) {
  std::stop_source stop;
  JobServer server =
      JobServer::connect({.server = {.server = fake_.address()}}, stop.get_token()).value();
  const std::string id = submit();
  const auto job = watch_job(server, id, [&stop](const v1::Job& now) {
    if (now.state() == v1::JOB_STATE_RUNNING) stop.request_stop();
  });
  EXPECT_EQ(exit_of(job), 65);
}

class Fetch : public JobCalls {
 protected:
  Fetch() { jobs_.put(sample_job("job-1", v1::JOB_STATE_SUCCEEDED)); }
  Result<MeshReport> fetch(JobServer& server, const FetchMeshOptions& options = {}) {
    spool_ = MeshSpool::create(folder_.path()).value();
    return fetch_mesh(server, "job-1", *spool_, options);
  }
  void expect_whole(const Result<MeshReport>& report) {
    ASSERT_TRUE(report) << report.error().message;
    const auto view = spool_->view().value();
    const Mesh whole = square_mesh(4);
    EXPECT_TRUE(std::ranges::equal(view.coordinates, whole.coordinates));
    EXPECT_TRUE(std::ranges::equal(view.triangles, whole.triangles));
    EXPECT_TRUE(std::ranges::equal(view.regions, whole.regions));
    EXPECT_TRUE(std::ranges::equal(view.edges, whole.edges));
    EXPECT_TRUE(std::ranges::equal(view.edge_markers, whole.edge_markers));
    EXPECT_EQ(report->summary.triangles(), 32u);
    EXPECT_EQ(report->accepted.engine_version(), "1");
  }
  std::unique_ptr<MeshSpool> spool_;
};

TEST_F(Fetch, BringsTheMeshAndTheReport) {
  std::vector<std::uint64_t> triangles;
  const auto report =
      fetch(server_, {.on_triangles = [&](std::uint64_t so_far) { triangles.push_back(so_far); }});
  expect_whole(report);
  EXPECT_EQ(triangles, (std::vector<std::uint64_t>{10, 21, 32}));
  EXPECT_GT(report->bytes_received, 0u);
  EXPECT_GT(report->first_chunk_seconds, 0);
}

TEST_F(Fetch, GoesOnAtEveryPlaceWhereAStreamCanBreak) {
  // accepted, three chunks, summary
  for (std::size_t messages = 0; messages <= 5; ++messages) {
    jobs_.fail("FetchMesh", {{.messages = messages}});
    expect_whole(fetch(server_));
    const std::uint32_t chunks = messages == 0 ? 0 : std::min<std::size_t>(messages - 1, 3);
    if (messages < 5) {
      EXPECT_EQ(jobs_.first_chunks().back(), chunks) << messages;
    }
  }
}

TEST_F(Fetch, GoesOnAsOftenAsAChunkComesInBetween) {
  JobServer server = connect(fake_.address(), 1);
  jobs_.fail("FetchMesh", {{.messages = 2}, {.messages = 2}, {.messages = 2}});
  expect_whole(fetch(server));
  EXPECT_EQ(jobs_.first_chunks(), (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST_F(Fetch, GivesUpWhenNoChunkComes) {
  JobServer server = connect(fake_.address(), 2);
  jobs_.fail("FetchMesh", std::vector<Fault>(10, Fault{.messages = 1}));
  EXPECT_EQ(exit_of(fetch(server)), 78);
  EXPECT_EQ(jobs_.calls("FetchMesh"), 3u);
}

TEST_F(Fetch, GoesOnWhereTheWireTearsInTheMiddleOfAMessage) {
  std::size_t torn = 0;
  for (const std::size_t bytes : {40, 150, 300, 500, 700, 900, 1100}) {
    const auto wire = folder_ / ("wire" + std::to_string(bytes));
    const TornRelay relay(wire, folder_ / "s", {bytes, bytes + 30});
    JobServer server = connect(relay.address());
    expect_whole(fetch(server));
    torn += relay.torn();
  }
  EXPECT_GE(torn, 7u);
}

TEST_F(Fetch, RefusesADamagedChunkAndDoesNotAskAgain) {
  jobs_.mesh[2].mutable_chunk()->set_coordinates(0, 0.5);
  const auto report = fetch(server_);
  EXPECT_EQ(exit_of(report), 79);
  EXPECT_EQ(report.error().message, "the stream is damaged: chunk 1 does not match its SHA-256");
  EXPECT_EQ(jobs_.calls("FetchMesh"), 1u);
}

TEST_F(Fetch, RefusesAStreamThatEndsWithoutASummary) {
  jobs_.mesh.pop_back();
  EXPECT_EQ(exit_of(fetch(server_)), 79);
}

TEST_F(Fetch, RefusesAMeshThatBelongsToAnotherDomain) {
  expect_whole(fetch(server_, {.domain = DomainCounts{4, 4}}));
  const auto report = fetch(server_, {.domain = DomainCounts{4, 3}});
  EXPECT_EQ(exit_of(report), 79);
  EXPECT_EQ(report.error().message, "the stream is damaged: chunk 2 names segment 3 of 3");
}

TEST_F(Fetch, DoesNotGoOnWithAnotherEngine) {
  jobs_.fail("FetchMesh", {{.messages = 3}});
  server_.on_away(
      [this](const std::string&) { jobs_.mesh[0].mutable_accepted()->set_engine_version("2"); });
  const auto report = fetch(server_);
  EXPECT_EQ(exit_of(report), 79);
  EXPECT_EQ(report.error().message,
            "the stream is damaged: it was resumed by engine 2, engine 1 had begun it");
}

}  // namespace
}  // namespace weft::client
