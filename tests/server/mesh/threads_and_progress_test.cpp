// SPDX-License-Identifier: Apache-2.0
// What a call gets of the server's threads, and of the stream while it works.

#include <thread>

#include "engine/base/context.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

// What the call computed on, and what its client was sent.
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
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        threads.context = run.context().threads();
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
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        threads = run.context().arena()->threads();
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
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        run.context().enter(Stage::kRefine);
        run.context().add_fraction(0.5);
        EXPECT_TRUE(seen.wait());
        run.context().add_fraction(-0.25);  // an engine that errs
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

TEST(Progress, GoesBeforeTheChunksThatWaitForASlowReader) {
  std::atomic<bool> first{true};
  std::atomic<std::uint32_t> sent{0};
  std::atomic<weft::Run*> job{nullptr};
  Event release;
  ServiceOptions options;
  options.jobs = 2;
  options.tick = std::chrono::milliseconds(50);
  TestServer server(
      [&](const auto&, ChunkSink& sink, weft::Run& run) -> Result<Summary> {
        if (!first.exchange(false)) {
          release.wait();
          return send_chunks(sink, 1);
        }
        job = &run;
        return send_until_refused(sink, sent);
      },
      options);
  auto slow_stub = server.stub();
  grpc::ClientContext slow_context;
  auto slow = slow_stub->GenerateMesh(&slow_context, valid_request());
  v1::GenerateMeshResponse message;
  do ASSERT_TRUE(slow->Read(&message));
  while (!message.has_chunk());
  while (sent < 10) std::this_thread::yield();  // more than the hand-over holds

  constexpr std::uint64_t kMark = 777;
  job.load()->context().add_triangles(kMark);
  auto other_stub = server.stub();
  grpc::ClientContext other_context;
  auto other = other_stub->GenerateMesh(&other_context, valid_request());
  for (int ticks = 0; ticks < 3; ticks += message.has_progress())
    ASSERT_TRUE(other->Read(&message));

  const std::uint32_t waiting = sent;
  std::uint32_t last_chunk = 0;
  do {
    ASSERT_TRUE(slow->Read(&message));
    if (message.has_chunk()) last_chunk = message.chunk().index();
  } while (message.progress().triangles() != kMark && last_chunk < 10'000);
  EXPECT_LT(last_chunk, waiting);
  slow_context.TryCancel();
  release.set();
  EXPECT_TRUE(read_all(*other).status.ok());
}

}  // namespace
}  // namespace weft::server::testing
