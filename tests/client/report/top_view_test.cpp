// SPDX-License-Identifier: Apache-2.0
#include "client/report/top_view.h"

#include <gtest/gtest.h>

#include <limits>

#include "client/report/terminal_screen.h"
#include "tests/client/support/fake_jobs.h"

namespace weft::client {
namespace {

v1::GetServerInfoResponse info() {
  v1::GetServerInfoResponse info;
  info.set_version("1.2.3");
  info.set_engine_version("4");
  info.set_threads(8);
  return info;
}

v1::Job running(const std::string& id, std::uint64_t triangles) {
  v1::Job job = sample_job(id, v1::JOB_STATE_RUNNING);
  job.mutable_progress()->set_triangles(triangles);
  return job;
}

v1::Job ended(const std::string& id, v1::JobState state, std::int64_t seconds_later) {
  v1::Job job = sample_job(id, state);
  job.mutable_end_time()->set_seconds(job.end_time().seconds() + seconds_later);
  return job;
}

TEST(TopView, ShowsServerCountsWorkAndEnds) {
  TopView view("unix:/s");
  view.add(top_sample(10, info(), {sample_job("e", v1::JOB_STATE_QUEUED), running("d", 1000)},
                      {ended("c", v1::JOB_STATE_SUCCEEDED, 0), ended("b", v1::JOB_STATE_FAILED, 9),
                       ended("a", v1::JOB_STATE_CANCELLED, 3)}));
  EXPECT_EQ(view.text(std::nullopt),
            "weftd 1.2.3 at unix:/s, engine 4, 8 threads\n"
            "queued 1  running 1  succeeded 1  failed 1  cancelled 1\n"
            "\n"
            "AT WORK\n"
            "d  refining [#######.......................] 1,000 triangles so far\n"
            "\n"
            "ENDED\n"
            "b  failed     2026-11-20T16:00:14Z  RESOURCE_EXHAUSTED (BUDGET_EXCEEDED)\n"
            "a  cancelled  2026-11-20T16:00:08Z  7.000 s\n"
            "c  succeeded  2026-11-20T16:00:05Z  4.000 s\n");
}

TEST(TopView, TellsThroughputByWhatGrewBetweenTwoLooks) {
  TopView view("s");
  view.add(top_sample(10, info(), {running("b", 5000), running("a", 1000)}, {}));
  EXPECT_EQ(view.text(std::nullopt).find("triangles/s"), std::string::npos);
  // c has just begun; b was begun anew.
  view.add(top_sample(12, info(), {running("c", 400), running("b", 100), running("a", 3000)}, {}));
  const std::string text = view.text(std::nullopt);
  EXPECT_NE(text.find("cancelled 0  1,200 triangles/s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("a  refining [#######.......................] 3,000 triangles so far"
                      ", 1,000 triangles/s\n"),
            std::string::npos)
      << text;
  EXPECT_LT(text.find("a  refining"), text.find("c  refining")) << "the oldest comes first";
}

TEST(TopView, ShowsAJobOnceThatEndedBetweenTheTwoLists) {
  TopView view("s");
  view.add(top_sample(1, info(), {running("a", 9)}, {ended("a", v1::JOB_STATE_SUCCEEDED, 0)}));
  EXPECT_NE(view.text(std::nullopt).find("running 0  succeeded 1 "), std::string::npos);
}

TEST(TopView, SaysThatMoreJobsHaveEndedThanItCounts) {
  TopView view("s");
  TopSample sample = top_sample(1, info(), {}, {ended("a", v1::JOB_STATE_SUCCEEDED, 0)});
  sample.left_out = {v1::JOB_STATE_SUCCEEDED};
  view.add(std::move(sample));
  EXPECT_NE(view.text(std::nullopt).find("queued 0  running 0  succeeded 1+  failed 0  "),
            std::string::npos);
}

TEST(TopView, CountsWhatJobsMadeThatEndedBetweenTwoLooks) {
  const auto made = [](const std::string& id, std::uint64_t triangles, std::int64_t created) {
    v1::Job job = ended(id, v1::JOB_STATE_SUCCEEDED, 0);
    job.mutable_create_time()->set_seconds(created);
    job.mutable_summary()->set_triangles(triangles);
    return job;
  };
  TopView view("s");
  v1::Job waiting = sample_job("c", v1::JOB_STATE_QUEUED);
  waiting.mutable_create_time()->set_seconds(100);
  v1::Job begun = running("b", 1000);
  begun.mutable_create_time()->set_seconds(100);
  view.add(top_sample(10, info(), {waiting, begun}, {made("a", 1'000'000, 90)}));
  v1::Job kept = made("e", 1'000'000, 101);
  kept.set_from_store(true);
  // d is new; f was left out of the first list.
  view.add(top_sample(12, info(), {},
                      {kept, made("d", 500, 101), made("c", 2000, 100), made("b", 1500, 100),
                       made("a", 1'000'000, 90), made("f", 1'000'000, 80)}));
  const std::string text = view.text(std::nullopt);
  EXPECT_NE(text.find("cancelled 0  1,500 triangles/s\n"), std::string::npos) << text;
}

TEST(TopView, CutsLinesBetweenFields) {
  TopView view("s");
  view.add(top_sample(10, info(), {running("a", 1000)}, {}));
  view.add(top_sample(12, info(), {running("a", 3000)}, {}));
  const std::string whole = "a  refining [#######.......................] 3,000 triangles so far";
  for (const std::size_t columns : {whole.size(), whole.size() + 1, whole.size() + 7}) {
    const std::string text = view.text(ScreenSize{.columns = columns, .lines = 24});
    EXPECT_NE(text.find(whole + "\n"), std::string::npos) << columns << "\n" << text;
  }
}

TEST(TopView, FitsTheScreen) {
  TopView view("s");
  std::vector<v1::Job> jobs;
  for (int i = 0; i < 50; ++i) jobs.push_back(running(std::to_string(i), 1));
  view.add(top_sample(1, info(), jobs, {ended("a", v1::JOB_STATE_SUCCEEDED, 0)}));
  const std::string text = view.text(ScreenSize{.columns = 20, .lines = 7});
  EXPECT_EQ(std::ranges::count(text, '\n'), 7);
  EXPECT_TRUE(text.starts_with("weftd 1.2.3 at s\nqueued 0  running 50\n")) << text;
}

TEST(TopView, LivesWithFiguresThatMakeNoSense) {
  TopView view("s");
  v1::Job strange = ended("b", v1::JOB_STATE_SUCCEEDED, std::numeric_limits<std::int32_t>::max());
  strange.mutable_start_time()->set_seconds(std::numeric_limits<std::int64_t>::min());
  view.add(top_sample(1, info(), {running("a", 0)}, {strange}));
  view.add(top_sample(1.001, info(), {running("a", std::numeric_limits<std::uint64_t>::max())},
                      {strange}));
  EXPECT_NE(view.text(std::nullopt).find("1,000,000,000,000,000 triangles/s"), std::string::npos);
}

TEST(TopView, KeepsTheLastSampleWhileTheServerIsAway) {
  TopView view("s");
  view.add(top_sample(1, info(), {running("a", 1)}, {}));
  view.set_problem("the server s answers UNAVAILABLE\n  gone");
  const std::string text = view.text(std::nullopt);
  EXPECT_NE(text.find("\nthe server s answers UNAVAILABLE   gone\n"), std::string::npos) << text;
  EXPECT_NE(text.find("a  refining"), std::string::npos);
}

TEST(TerminalScreen, ReplacesWhatItShowedWithoutScrolling) {
  EXPECT_EQ(redraw("one\ntwo\n"), "\033[H\033[Kone\r\n\033[Jtwo");
  EXPECT_EQ(redraw("one\n"), "\033[H\033[Jone");
}

}  // namespace
}  // namespace weft::client
