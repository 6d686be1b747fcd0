// SPDX-License-Identifier: GPL-3.0-or-later
// What a job gets of the server's threads, and of the stream while it works.
#include <tbb/task_arena.h>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

// What the job computed on, and what its client was told.
struct Threads {
  int context = 0;
  std::uint32_t accepted = 0;
  std::uint32_t summary = 0;

  bool operator==(const Threads&) const = default;
};

void PrintTo(const Threads& t, std::ostream* out) {
  *out << t.context << ", accepted " << t.accepted << ", summary " << t.summary;
}

Threads threads_where_asked_for(std::uint32_t wanted) {
  Threads threads;
  ServiceOptions options;
  options.threads = 3;
  TestServer server(
      [&](const auto&, ChunkSink& sink, ExecutionContext& context) {
        threads.context = context.threads();
        return send_chunks(sink, 1);
      },
      options);
  v1::GenerateMeshRequest request = valid_request();
  request.set_threads(wanted);
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  threads.accepted = outcome.messages.front().accepted().threads();
  threads.summary = outcome.messages.back().summary().threads();
  return threads;
}

TEST(Threads, OfARequestCapTheJobsShareAndAreTold) {
  EXPECT_EQ(threads_where_asked_for(2), (Threads{2, 2, 2}));
}

TEST(Threads, AreAllOfTheServersWhereNoneAreAskedFor) {
  EXPECT_EQ(threads_where_asked_for(0), (Threads{3, 3, 3}));
}

TEST(Threads, AreCutToTheServers) {
  EXPECT_EQ(threads_where_asked_for(4), (Threads{3, 3, 3}));
  EXPECT_EQ(threads_where_asked_for(0xffffffff), (Threads{3, 3, 3}));
}

TEST(Threads, AreOneArenaForAllJobs) {
  ServiceOptions options;
  options.threads = 3;
  std::atomic<int> threads{0};
  TestServer server(
      [&](const auto&, ChunkSink& sink, ExecutionContext& context) {
        threads = context.compute([] { return tbb::this_task_arena::max_concurrency(); });
        return send_chunks(sink, 1);
      },
      options);
  EXPECT_TRUE(call(*server.stub(), valid_request()).status.ok());
  EXPECT_EQ(threads, 3);
}

TEST(Progress, TellsAFractionThatNeverFalls) {
  Event fell;
  Event seen;
  ServiceOptions options;
  options.tick = std::chrono::milliseconds(5);
  TestServer server(
      [&](const auto&, ChunkSink& sink, ExecutionContext& context) {
        context.enter(Stage::kRefine);
        context.add_fraction(0.5);
        EXPECT_TRUE(seen.wait());
        context.add_fraction(-0.25);  // an engine that errs
        EXPECT_TRUE(fell.wait());
        return send_chunks(sink, 1);
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::GenerateMeshResponse message;
  double last = 0;
  int told_half = 0;
  while (reader->Read(&message)) {
    if (!message.has_progress()) continue;
    EXPECT_GE(message.progress().fraction(), last);
    last = message.progress().fraction();
    if (last < 0.5) continue;
    seen.set();
    if (++told_half == 10) fell.set();
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(last, 0.5);
}

TEST(Progress, IsToldWhileTheStreamIsNeverIdle) {
  std::atomic<bool> enough{false};
  ServiceOptions options;
  options.tick = std::chrono::milliseconds(5);
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) -> Result<Summary> {
        std::uint32_t sent = 0;
        while (!enough)
          if (!sink.accept(make_chunk(sent++, kMaxChunkBytes)))
            return fail(ErrorCode::kCancelled, "", "refused");
        Summary summary;
        summary.chunks = sent;
        return summary;
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::GenerateMeshResponse message;
  int told = 0;
  bool summary_is_last = false;
  for (int chunks = 0; reader->Read(&message);) {
    summary_is_last = message.has_summary();
    chunks += message.has_chunk();
    told += chunks > 0 && message.has_progress();
    enough = told >= 20 || chunks >= 20'000;
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_GE(told, 20);
  EXPECT_TRUE(summary_is_last);
}

}  // namespace
}  // namespace weft::server::testing
