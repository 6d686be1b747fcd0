// SPDX-License-Identifier: Apache-2.0
// The commands on jobs as a user runs them, against a JobService in this process.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/formats/mesh_formats.h"
#include "google/rpc/error_details.pb.h"
#include "tests/client/support/job_commands.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

using nlohmann::json;

TEST_F(JobCommands, SubmitPrintsTheIdAlone) {
  ASSERT_EQ(ask(submit({"--size", "0.5", "--min-angle", "30", "--no-cache"})), 0) << err();
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_EQ(err(), "");
  const v1::SubmitJobRequest sent = jobs_.submissions().at(0);
  EXPECT_EQ(sent.mesh().domain().points_size(), 8);
  EXPECT_EQ(sent.mesh().size().constant(), 0.5);
  EXPECT_EQ(sent.mesh().quality().min_angle_deg(), 30);
  EXPECT_TRUE(sent.no_cache());
}

TEST_F(JobCommands, SubmitMakesUpARequestIdOfItsOwn) {
  ASSERT_EQ(ask(submit()), 0);
  ASSERT_EQ(ask(submit()), 0);
  const auto sent = jobs_.submissions();
  EXPECT_EQ(sent.at(0).request_id().size(), std::string("weft-").size() + 32);
  EXPECT_NE(sent.at(0).request_id(), sent.at(1).request_id());
  EXPECT_EQ(jobs_.count(), 2u);
}

TEST_F(JobCommands, SubmitSentAgainByARequestIdFindsItsJob) {
  ASSERT_EQ(ask(submit({"--request-id", "nightly"})), 0) << err();
  ASSERT_EQ(ask(submit({"--request-id", "nightly"})), 0) << err();
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_EQ(ask(submit({"--request-id", "nightly", "--size", "2"})), 70);
  EXPECT_EQ(ask(submit({"--request-id", ""})), 2);
  EXPECT_EQ(ask(submit({"--request-id", std::string(129, 'x')})), 2);
}

TEST_F(JobCommands, SubmitMakesOneJobWhereItsAnswerIsLost) {
  jobs_.fail("SubmitJob", {{.done = true}});
  ASSERT_EQ(ask(submit()), 0);
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_NE(err().find("answers UNAVAILABLE, trying again"), std::string::npos) << err();
  EXPECT_EQ(jobs_.count(), 1u);
}

TEST_F(JobCommands, SubmitTellsHowToRepeatItWhereTheServerStaysAway) {
  jobs_.fail("SubmitJob", {{.done = true}});
  EXPECT_EQ(ask(submit({"--retries", "0", "--request-id", "nightly"})), 78);
  EXPECT_NE(err().find("with --request-id 'nightly' it is not made twice"), std::string::npos)
      << err();
}

TEST_F(JobCommands, SubmitNamesThePlaceOfAFieldAtFault) {
  google::rpc::Status details;
  google::rpc::BadRequest bad;
  bad.add_field_violations()->set_field("domain.segments[2].b");
  details.add_details()->PackFrom(bad);
  jobs_.fail("SubmitJob",
             {{.status = {grpc::StatusCode::INVALID_ARGUMENT, "no", details.SerializeAsString()}}});
  EXPECT_EQ(ask(submit()), 67);
  EXPECT_NE(err().find("in.poly:9"), std::string::npos) << err();
}

TEST_F(JobCommands, SubmitPrintsTheJobAsJson) {
  ASSERT_EQ(ask(submit({"--json"})), 0);
  EXPECT_EQ(json::parse(out())["state"], "queued");
}

TEST_F(JobCommands, SubmitWaitsToTheEnd) {
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit({"--wait"})), 0) << err();
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_EQ(err(),
            "weft: waiting\nweft: refining, 25 % done, 1,000 triangles so far\n"
            "32 triangles, 25 vertices, angles 45.00 to 90.00 degrees\n");
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit({"--wait", "--json", "-q"})), 0);
  EXPECT_EQ(json::parse(out())["summary"]["triangles"], 32);
  EXPECT_EQ(err(), "");
}

TEST_F(JobCommands, SubmitEndsAsItsJobDoes) {
  plan(v1::JOB_STATE_FAILED);
  EXPECT_EQ(ask(submit({"--wait", "-o", out_file("m.vtu"), "--json"})), 72);
  EXPECT_EQ(json::parse(out())["error"]["reason"], "BUDGET_EXCEEDED");
  EXPECT_NE(err().find("the job job-1 failed with RESOURCE_EXHAUSTED (BUDGET_EXCEEDED)\n"),
            std::string::npos);
  plan(v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(ask(submit({"--wait", "-o", out_file("m.vtu")})), 65);
  EXPECT_EQ(left_in("out"), Words{});
}

TEST_F(JobCommands, SubmitWaitsAndWritesTheMesh) {
  plan(v1::JOB_STATE_SUCCEEDED);
  jobs_.fail("FetchMesh", {{.messages = 2}});
  ASSERT_EQ(ask(submit({"--wait", "-o", out_file("m.vtu"), "--draw", out_file("d.png")})), 0)
      << err();
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_EQ(left_in("out"), (Words{"d.png", "m.vtu"}));
  EXPECT_EQ(read_mesh(out_file("m.vtu")).value(), square_mesh(4));
  EXPECT_NE(err().find("\nwrote " + out_file("m.vtu")), std::string::npos) << err();
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit({"--wait", "-o", out_file("m.vtu"), "--json"})), 0) << err();
  EXPECT_EQ(json::parse(out())["id"], "job-2");
  EXPECT_EQ(json::parse(out())["triangles"], 32);
}

TEST_F(JobCommands, SubmitWritesNothingUnlessItWaits) {
  EXPECT_EQ(ask(submit({"-o", out_file("m.vtu")})), 2);
  EXPECT_NE(err().find("give --wait"), std::string::npos) << err();
  EXPECT_EQ(jobs_.calls("SubmitJob"), 0u);
}

TEST_F(JobCommands, MeshDetachSubmits) {
  ASSERT_EQ(ask({"mesh", folder_ / "in.poly", "--size", "0.5", "--detach"}), 0) << err();
  EXPECT_EQ(out(), "job-1\n");
  EXPECT_EQ(jobs_.submissions().at(0).mesh().size().constant(), 0.5);
  EXPECT_EQ(ask({"mesh", folder_ / "in.poly", "--detach", "-o", out_file("m.vtu")}), 2);
  EXPECT_NE(err().find("leave out -o and --draw"), std::string::npos) << err();
  EXPECT_EQ(ask({"mesh", folder_ / "in.poly", "--detach", "--draw", out_file("m.png")}), 2);
  EXPECT_EQ(jobs_.calls("SubmitJob"), 1u);
}

TEST_F(JobCommands, AllNeedAServerAndSayWhy) {
  for (const Words& words :
       {submit(), Words{"mesh", folder_ / "in.poly", "--detach"}, Words{"get", "a"}, Words{"list"},
        Words{"watch", "a"}, Words{"cancel", "a"}, Words{"delete", "a"},
        Words{"fetch", "a", "-o", out_file("m.vtu")}, Words{"top"}}) {
    EXPECT_EQ(run(words), 2) << words[0];
    EXPECT_NE(err().find("give --server ADDR, or WEFT_SERVER. Jobs are kept by a server that "
                         "stays; a private weftd ends with this command"),
              std::string::npos)
        << words[0] << ": " << err();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(JobCommands, GetPrintsTheJob) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_FAILED));
  EXPECT_EQ(ask({"get", "job-1"}), 0) << err();
  EXPECT_NE(out().find("state      failed\n"), std::string::npos) << out();
  EXPECT_EQ(ask({"get", "job-1", "--json"}), 0);
  EXPECT_EQ(json::parse(out())["error"]["code"], 8);
  EXPECT_EQ(ask({"get", "job-2"}), 69);
  EXPECT_NE(err().find("NOT_FOUND\n  there is no job 'job-2'"), std::string::npos) << err();
}

TEST_F(JobCommands, ListFiltersAndLimits) {
  for (int i = 10; i < 14; ++i)
    jobs_.put(sample_job("job-" + std::to_string(i),
                         i % 2 == 0 ? v1::JOB_STATE_QUEUED : v1::JOB_STATE_CANCELLED));
  jobs_.set_page_limit(1);
  ASSERT_EQ(ask({"list"}), 0) << err();
  EXPECT_EQ(std::ranges::count(out(), '\n'), 5);
  ASSERT_EQ(ask({"list", "--state", "queued", "--json"}), 0) << err();
  const json queued = json::parse(out())["jobs"];
  ASSERT_EQ(queued.size(), 2u);
  EXPECT_EQ(queued[0]["id"], "job-12");
  ASSERT_EQ(ask({"list", "--state", "queued", "--state", "cancelled", "--limit", "3"}), 0);
  EXPECT_EQ(std::ranges::count(out(), '\n'), 4);
  EXPECT_EQ(ask({"list", "--state", "asleep"}), 2);
}

TEST_F(JobCommands, WatchPrintsPlainLinesWhereThereIsNoTerminal) {
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit()), 0);
  jobs_.fail("WatchJob", {{.messages = 1}, {}});
  ASSERT_EQ(ask({"watch", "job-1"}), 0) << err();
  EXPECT_EQ(out(), "weft: waiting\nweft: the server " + fake_.address() +
                       " answers UNAVAILABLE, trying again\n"
                       "weft: refining, 25 % done, 1,000 triangles so far\n"
                       "32 triangles, 25 vertices, angles 45.00 to 90.00 degrees\n");
}

TEST_F(JobCommands, WatchPrintsALineOfJsonForEveryChange) {
  plan(v1::JOB_STATE_FAILED);
  ASSERT_EQ(ask(submit()), 0);
  EXPECT_EQ(ask({"watch", "job-1", "--json"}), 72);
  std::istringstream lines(out());
  Words states;
  for (std::string line; std::getline(lines, line);)
    states.push_back(json::parse(line)["state"].get<std::string>());
  EXPECT_EQ(states, (Words{"queued", "running", "failed"}));
}

TEST_F(JobCommands, WatchEndsAsTheJobDid) {
  jobs_.put(sample_job("a", v1::JOB_STATE_SUCCEEDED));
  jobs_.put(sample_job("b", v1::JOB_STATE_FAILED));
  jobs_.put(sample_job("c", v1::JOB_STATE_CANCELLED));
  EXPECT_EQ(ask({"watch", "a"}), 0);
  EXPECT_EQ(ask({"watch", "b"}), 72);
  EXPECT_EQ(ask({"watch", "c"}), 65);
  EXPECT_NE(err().find("the job c was cancelled"), std::string::npos) << err();
  EXPECT_EQ(ask({"watch", "d"}), 69);
}

TEST_F(JobCommands, CancelTriesAllAndEndsAsTheFirstThatFails) {
  jobs_.put(sample_job("a", v1::JOB_STATE_RUNNING));
  jobs_.put(sample_job("c", v1::JOB_STATE_SUCCEEDED));
  EXPECT_EQ(ask({"cancel", "a", "b", "c"}), 69);
  EXPECT_EQ(out(), "a cancelled\nc succeeded\n");
  EXPECT_NE(err().find("job 'b': "), std::string::npos) << err();
  EXPECT_EQ(jobs_.find("a")->state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(ask({"cancel", "a", "--json"}), 0);
  EXPECT_EQ(json::parse(out())["jobs"][0]["state"], "cancelled");
  EXPECT_EQ(ask({"cancel"}), 2);
}

TEST_F(JobCommands, DeleteForgetsWhatHasEnded) {
  jobs_.put(sample_job("a", v1::JOB_STATE_RUNNING));
  jobs_.put(sample_job("b", v1::JOB_STATE_FAILED));
  EXPECT_EQ(ask({"delete", "a", "b"}), 73);
  EXPECT_EQ(out(), "b deleted\n");
  EXPECT_TRUE(jobs_.find("a"));
  EXPECT_FALSE(jobs_.find("b"));
}

TEST_F(JobCommands, FetchWritesTheMeshAsMeshDoes) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_SUCCEEDED));
  Words words = {"-o", out_file("a.vtu"), "-o", out_file("a.node"), "--draw", out_file("a.svg")};
  Words fetch = {"fetch", "job-1", "--domain", folder_ / "in.poly"};
  fetch.insert(fetch.end(), words.begin(), words.end());
  ASSERT_EQ(ask(fetch), 0) << err();
  EXPECT_TRUE(out().starts_with("32 triangles, 25 vertices, ")) << out();
  EXPECT_NE(out().find("\nwrote " + out_file("a.svg")), std::string::npos) << out();
  std::map<std::string, std::string> fetched;
  for (const std::string& name : left_in("out")) fetched[name] = contents_of(out_file(name));
  EXPECT_EQ(fetched.size(), 5u);
  Words mesh = {"mesh", folder_ / "in.poly"};
  mesh.insert(mesh.end(), words.begin(), words.end());
  ASSERT_EQ(run(mesh), 0) << err();
  for (const auto& [name, contents] : fetched)
    EXPECT_EQ(contents, contents_of(out_file(name))) << name;
}

// As `weft mesh` does.
TEST_F(JobCommands, DownloadsWarnOfTheBudgetAndOfMarkers) {
  plan(v1::JOB_STATE_SUCCEEDED);
  jobs_.mesh.back().mutable_summary()->mutable_request()->mutable_budget()->set_max_triangles(9);
  folder_.write("odd.poly",
                "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n"
                "4 1\n1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 99\n0\n");
  const std::string budget =
      "the mesh has 32 triangles, more than the 9 of --max-triangles, because the domain alone";
  const std::string boundary = "no edge of the mesh carries marker 7 of --open-boundary";
  const std::string hidden = "no edge of the mesh carries marker 99 of the input";
  const Words output = {"-o", out_file("g.14"), "--open-boundary", "7"};
  const auto with = [&output](Words words) {
    words.insert(words.end(), output.begin(), output.end());
    return words;
  };
  ASSERT_EQ(ask(with({"submit", folder_ / "odd.poly", "--max-triangles", "9", "--wait"})), 0)
      << err();
  for (const std::string& warning : {budget, boundary, hidden})
    EXPECT_NE(err().find("WARNING: " + warning), std::string::npos) << err();
  ASSERT_EQ(ask(with({"fetch", "job-1"})), 0) << err();
  EXPECT_NE(out().find("WARNING: " + budget), std::string::npos) << out();
  EXPECT_NE(out().find("WARNING: " + boundary), std::string::npos) << out();
  EXPECT_EQ(out().find(hidden), std::string::npos) << out();
  ASSERT_EQ(ask(with({"fetch", "job-1", "--domain", folder_ / "odd.poly"})), 0) << err();
  EXPECT_NE(out().find("WARNING: " + hidden), std::string::npos) << out();
  jobs_.mesh.back().mutable_summary()->clear_request();
  ASSERT_EQ(ask({"fetch", "job-1", "-o", out_file("g.14"), "--open-boundary", "1"}), 0) << err();
  EXPECT_EQ(out().find("WARNING"), std::string::npos) << out();
}

TEST_F(JobCommands, WatchPrintsTheServersWarningsOfTheSize) {
  v1::Job job = sample_job("a", v1::JOB_STATE_SUCCEEDED);
  job.mutable_summary()->add_size_warnings()->set_message("the size is odd");
  jobs_.put(job);
  EXPECT_EQ(ask({"watch", "a"}), 0) << err();
  EXPECT_NE(out().find("\nWARNING: the size is odd\n"), std::string::npos) << out();
}

TEST_F(JobCommands, FetchPrintsTheServersWarningsOfTheSize) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_SUCCEEDED));
  auto& warning = *jobs_.mesh.back().mutable_summary()->add_size_warnings();
  warning.set_message("the size is \x1b[31modd");
  ASSERT_EQ(ask({"fetch", "job-1", "-o", out_file("odd.vtu")}), 0) << err();
  EXPECT_NE(out().find("\nWARNING: the size is ?[31modd\n"), std::string::npos) << out();
}

TEST_F(JobCommands, FetchGoesOnWhereItBreaks) {
  jobs_.put(sample_job("job-1", v1::JOB_STATE_SUCCEEDED));
  jobs_.fail("FetchMesh", {{.messages = 2}, {.messages = 0}, {.messages = 2}});
  ASSERT_EQ(ask({"fetch", "job-1", "-o", out_file("m.vtu"), "--json"}), 0) << err();
  EXPECT_EQ(read_mesh(out_file("m.vtu")).value(), square_mesh(4));
  EXPECT_EQ(jobs_.first_chunks(), (std::vector<std::uint32_t>{0, 1, 1, 2}));
  const json report = json::parse(out());
  EXPECT_EQ(report["id"], "job-1");
  EXPECT_EQ(report["triangles"], 32);
  EXPECT_EQ(report["engine_version"], "1");
}

TEST_F(JobCommands, FetchWritesNothingOfAJobThatDidNotSucceed) {
  const auto fetch = [this](const std::string& id) {
    return ask({"fetch", id, "-o", out_file("m.vtu")});
  };
  jobs_.put(sample_job("a", v1::JOB_STATE_QUEUED));
  EXPECT_EQ(fetch("a"), 73);
  EXPECT_NE(err().find("the job a has not ended: it is queued. --wait waits for it"),
            std::string::npos)
      << err();
  jobs_.put(sample_job("b", v1::JOB_STATE_FAILED));
  EXPECT_EQ(fetch("b"), 72);
  EXPECT_EQ(fetch("c"), 69);
  jobs_.put(sample_job("d", v1::JOB_STATE_SUCCEEDED));
  jobs_.fail("FetchMesh", {{.status = {grpc::StatusCode::NOT_FOUND, "no longer kept"}}});
  EXPECT_EQ(fetch("d"), 69);
  jobs_.fail("FetchMesh", {{.messages = 3}});
  EXPECT_EQ(ask({"fetch", "d", "-o", out_file("m.vtu"), "--retries", "0"}), 78);
  EXPECT_EQ(left_in("out"), Words{});
  EXPECT_EQ(ask({"fetch", "d"}), 2);
}

TEST_F(JobCommands, FetchWaitsForTheJob) {
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit()), 0);
  ASSERT_EQ(ask({"fetch", "job-1", "--wait", "-o", out_file("m.vtu")}), 0) << err();
  EXPECT_EQ(read_mesh(out_file("m.vtu")).value(), square_mesh(4));
}

TEST_F(JobCommands, TopLooksOnceWhereThereIsNoTerminal) {
  jobs_.put(sample_job("a", v1::JOB_STATE_RUNNING));
  jobs_.put(sample_job("b", v1::JOB_STATE_FAILED));
  ASSERT_EQ(ask({"top"}), 0) << err();
  EXPECT_TRUE(out().starts_with("weftd 9.9.9 at " + fake_.address() + ", engine ")) << out();
  EXPECT_NE(out().find("queued 0  running 1  succeeded 0  failed 1  cancelled 0\n"),
            std::string::npos)
      << out();
  EXPECT_NE(out().find("AT WORK\na  refining ["), std::string::npos) << out();
  EXPECT_EQ(out().find('\033'), std::string::npos);
}

TEST_F(JobCommands, TopEndsWithTheErrorOfTheServer) {
  jobs_.fail("ListJobs", {{.status = {grpc::StatusCode::UNIMPLEMENTED, "no store"}}});
  EXPECT_EQ(ask({"top"}), 76);
}

TEST_F(JobCommands, ExplainThemselvesWithExamples) {
  for (const char* name : {"submit", "get", "list", "watch", "cancel", "delete", "fetch", "top"}) {
    EXPECT_EQ(run({name, "--help"}), 0);
    EXPECT_NE(out().find("Example"), std::string::npos) << name;
    EXPECT_NE(out().find("WEFT_SERVER"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace weft::client
