// SPDX-License-Identifier: Apache-2.0
#include "client/report/job_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/client/support/fake_jobs.h"

namespace weft::client {
namespace {

TEST(JobText, ListsJobsInATable) {
  const std::vector<v1::Job> jobs = {sample_job("job-10", v1::JOB_STATE_RUNNING),
                                     sample_job("job-9", v1::JOB_STATE_FAILED),
                                     sample_job("job-8", v1::JOB_STATE_QUEUED)};
  EXPECT_EQ(job_table(jobs),
            "ID      STATE    CREATED               DONE  TRIANGLES  ERROR\n"
            "job-10  running  2026-11-20T16:00:00Z  25 %  1,000\n"
            "job-9   failed   2026-11-20T16:00:00Z                   RESOURCE_EXHAUSTED "
            "(BUDGET_EXCEEDED)\n"
            "job-8   queued   2026-11-20T16:00:00Z\n");
  EXPECT_EQ(job_table({}), "ID  STATE  CREATED  DONE  TRIANGLES  ERROR\n");
}

TEST(JobText, NamesClientsIfTheServerTellsThemApart) {
  std::vector<v1::Job> jobs = {sample_job("job-9", v1::JOB_STATE_FAILED),
                               sample_job("job-8", v1::JOB_STATE_QUEUED)};
  jobs[0].set_client("ann");
  jobs[1].set_client("b\x1b[2J");
  EXPECT_EQ(job_table(jobs),
            "ID     STATE   CREATED               DONE  TRIANGLES  CLIENT  ERROR\n"
            "job-9  failed  2026-11-20T16:00:00Z                   ann     RESOURCE_EXHAUSTED "
            "(BUDGET_EXCEEDED)\n"
            "job-8  queued  2026-11-20T16:00:00Z                   b?[2J\n");
  EXPECT_NE(job_text(jobs[0]).find("\nclient     ann\n"), std::string::npos);
  EXPECT_EQ(job_json(jobs[0])["client"], "ann");
}

TEST(JobText, SaysOneFieldALine) {
  v1::Job job = sample_job("job-1", v1::JOB_STATE_SUCCEEDED);
  job.set_request_id("nightly");
  job.mutable_summary()->mutable_unrefined()->set_budget(2);
  EXPECT_EQ(job_text(job).substr(0, job_text(job).find("digest")),
            "id         job-1\n"
            "request id nightly\n"
            "state      succeeded\n"
            "created    2026-11-20T16:00:00Z\n"
            "started    2026-11-20T16:00:01Z\n"
            "ended      2026-11-20T16:00:05Z\n"
            "attempts   1\n"
            "worker     mill-1\n"
            "mesh       32 triangles, 25 vertices, angles 45.00 to 90.00 degrees\n"
            "           2 triangles miss a bound because --max-triangles was reached\n");
  EXPECT_NE(job_text(sample_job("job-1", v1::JOB_STATE_FAILED))
                .find("error      RESOURCE_EXHAUSTED (BUDGET_EXCEEDED)\n"
                      "           the mesh needs more than 1000 bytes\n"),
            std::string::npos);
  EXPECT_NE(job_text(sample_job("job-1", v1::JOB_STATE_RUNNING))
                .find("progress   refining, 25 % done, 1,000 triangles so far\n"),
            std::string::npos);
}

TEST(JobText, SaysWhatBecameOfACallback) {
  v1::Job job = sample_job("job-1", v1::JOB_STATE_SUCCEEDED);
  v1::Callback& callback = *job.mutable_callback();
  callback.set_url("http://example.org/\x1b[2J");
  callback.set_state(v1::CALLBACK_STATE_PENDING);
  callback.set_attempts(2);
  callback.set_error("the answer has status 500");
  EXPECT_NE(job_text(job).find("\ncallback   pending: http://example.org/?[2J\n"
                               "           attempt 2: the answer has status 500\n"),
            std::string::npos)
      << job_text(job);
  callback.set_url("http://example.org/");
  callback.set_state(v1::CALLBACK_STATE_DELIVERED);
  EXPECT_EQ(job_json(job)["callback"],
            Json::parse(R"({"url": "http://example.org/", "state": "delivered", "attempts": 2,
              "error": "the answer has status 500"})"));
  EXPECT_EQ(job_json(sample_job("job-1", v1::JOB_STATE_QUEUED)).count("callback"), 0U);
}

TEST(JobText, GivesProgramsTheFieldsThatAreSet) {
  EXPECT_EQ(job_json(sample_job("job-1", v1::JOB_STATE_QUEUED)),
            Json::parse(R"({"id": "job-1", "state": "queued",
              "create_time": "2026-11-20T16:00:00.250Z", "attempts": 0, "from_store": false})"));
  EXPECT_EQ(job_json(sample_job("job-1", v1::JOB_STATE_RUNNING))["progress"],
            Json::parse(R"({"stage": "refine", "triangles": 1000, "expected_triangles": 4000,
              "elapsed_seconds": 1.5, "fraction": 0.25})"));
  EXPECT_EQ(job_json(sample_job("job-1", v1::JOB_STATE_FAILED))["error"],
            Json::parse(R"({"code": 8, "reason": "BUDGET_EXCEEDED", "fields": [],
              "message": "the mesh needs more than 1000 bytes"})"));
  v1::Job done = sample_job("job-1", v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job_json(done)["summary"]["triangles"], 32);
  EXPECT_FALSE(job_json(done).contains("warnings"));
  done.mutable_summary()->add_size_warnings()->set_message("the size is odd");
  EXPECT_EQ(job_json(done)["warnings"], Json({"the size is odd"}));
}

TEST(JobText, MakesAnErrorOfEveryEndButSuccess) {
  const auto exit_of = [](v1::JobState state) {
    const auto error = job_error(sample_job("job-1", state));
    return error ? static_cast<int>(error->exit) : 0;
  };
  EXPECT_EQ(exit_of(v1::JOB_STATE_SUCCEEDED), 0);
  EXPECT_EQ(exit_of(v1::JOB_STATE_FAILED), 72);
  EXPECT_EQ(exit_of(v1::JOB_STATE_CANCELLED), 65);
  EXPECT_EQ(exit_of(v1::JOB_STATE_RUNNING), 73);
  EXPECT_EQ(exit_of(v1::JOB_STATE_QUEUED), 73);
  EXPECT_EQ(job_error(sample_job("job-1", v1::JOB_STATE_FAILED))->message,
            "the job job-1 failed with RESOURCE_EXHAUSTED (BUDGET_EXCEEDED)\n"
            "  the mesh needs more than 1000 bytes");
}

TEST(JobText, LivesWithJobsThatMakeNoSense) {
  v1::Job job = sample_job("job\x1b[2J", v1::JOB_STATE_FAILED);
  job.mutable_create_time()->set_seconds(std::numeric_limits<std::int64_t>::max());
  job.mutable_end_time()->set_nanos(-1);
  job.mutable_error()->set_code(99);
  job.set_worker("\x01\xff");
  EXPECT_EQ(job_text(job).find('\x1b'), std::string::npos);
  EXPECT_EQ(job_table({{job}}).find('\x1b'), std::string::npos);
  EXPECT_FALSE(json_line(job_json(job)).empty());
  EXPECT_EQ(job_error(job)->exit, ExitCode::kInternal);
  job.set_state(static_cast<v1::JobState>(77));
  EXPECT_NE(job_text(job).find("state      unknown\n"), std::string::npos);
}

}  // namespace
}  // namespace weft::client
