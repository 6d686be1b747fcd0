// SPDX-License-Identifier: Apache-2.0
// Several runs on one arena.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/engine/parallel/parallel.h"
#include "tests/support/event.h"

namespace weft {
namespace {

// Blocks at a chunk until it is allowed to go on.
struct BlockingSink : ChunkSink {
  explicit BlockingSink(std::uint32_t at) : at(at) {}
  bool accept(Chunk&& chunk) override {
    if (chunk.index == at) {
      blocked.set();
      EXPECT_TRUE(may_go_on.wait());
    }
    return true;
  }
  const std::uint32_t at;
  Event blocked;
  Event may_go_on;
};

TEST(SharedArena, IsNotHeldBackByAReaderThatStopsReading) {
  const MeshRequest large = busy_square(60'000, 200);
  const MeshRequest small = busy_square(5'000, 200);
  const std::string large_alone = outcome(mesh_on(nullptr, large));
  const std::string small_alone = outcome(mesh_on(nullptr, small));
  for (const int threads : {1, 2, 4}) {
    SCOPED_TRACE(threads);
    Arena arena(threads);
    BlockingSink sink(3);
    std::string first;
    std::thread job([&] { first = outcome(mesh_on(&arena, large, sink)); });
    EXPECT_TRUE(sink.blocked.wait());
    // The first one's sink blocks until this one is done.
    EXPECT_EQ(outcome(mesh_on(&arena, small)), small_alone);
    sink.may_go_on.set();
    job.join();
    EXPECT_EQ(first, large_alone);
  }
}

TEST(SharedArena, GivesEachOfManyJobsItsOwnMesh) {
  std::vector<MeshRequest> requests;
  std::vector<std::string> alone;
  for (int i = 0; i < 6; ++i) {
    requests.push_back(busy_square(3'000 + 2'000 * i, 100 + 50 * i));
    alone.push_back(outcome(mesh_on(nullptr, requests.back())));
  }
  Arena arena(3);
  std::vector<std::string> together(requests.size());
  std::vector<std::thread> jobs;
  for (std::size_t i = 0; i < requests.size(); ++i)
    jobs.emplace_back([&, i] { together[i] = outcome(mesh_on(&arena, requests[i])); });
  for (std::thread& job : jobs) job.join();
  EXPECT_EQ(together, alone);
}

TEST(SharedArena, GivesAJobOneMeshWhateverItsShareOfThreads) {
  const MeshRequest request = busy_square(20'000, 200);
  const std::string alone = outcome(mesh_on(nullptr, request));
  Arena arena(4);
  for (const int share : {1, 2, 3, 4, 9}) {
    ExecutionContext context;
    context.set_arena(arena, share);
    ForgetfulSink sink;
    EXPECT_EQ(outcome(generate_mesh(request, sink, context)), alone) << share;
  }
}

TEST(SharedArena, ShowsProgressThatNeverFallsAndEndsAtOne) {
  struct Watches : ChunkSink {
    explicit Watches(const ExecutionContext& context) : context(context) {}
    bool accept(Chunk&&) override {
      const double now = context.progress().fraction;
      EXPECT_GE(now, last);
      EXPECT_LE(now, 1);
      last = now;
      return true;
    }
    const ExecutionContext& context;
    double last = 0;
  };
  Arena arena(3);
  ExecutionContext context;
  context.set_arena(arena);
  Watches sink(context);
  ASSERT_TRUE(generate_mesh(busy_square(30'000, 200), sink, context));
  EXPECT_NEAR(context.progress().fraction, 1, 1e-9);
}

}  // namespace
}  // namespace weft
