// SPDX-License-Identifier: Apache-2.0
// A mesh that leaves while it is refined takes the memory of a strip of it, whatever its reader
// does, and is the same mesh.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <thread>

#include "tests/engine/parallel/parallel.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

constexpr double kTriangles = kSanitized ? 40'000 : 400'000;
constexpr double kLeaf = kSanitized ? 200 : 500;

MeshRequest request_of(double triangles) {
  return busy_square(triangles, kLeaf);
}

// Bytes at the peak, on so many threads.
double peak_on(int threads, double triangles, ChunkSink& sink) {
  Arena arena(threads);
  const auto summary = mesh_on(&arena, request_of(triangles), sink);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return 0;
  }
  return static_cast<double>(summary->peak_bytes);
}
double peak_on(int threads, double triangles) {
  ForgetfulSink sink;
  return peak_on(threads, triangles, sink);
}

TEST(Streaming, TakesMemoryAsTheFrontGrows) {
  const double small = peak_on(2, kTriangles);
  const double large = peak_on(2, 4 * kTriangles);
  // The front alone would double, the whole mesh would take four times as much. What each leaf
  // takes, 3 kB or so, is much for leaves as small as these.
  EXPECT_LT(large, 3 * small);
  if (!kSanitized) {
    EXPECT_LT(large, 14 * 4 * kTriangles);
  }
}

// Notes how many triangles there are when the first leave.
struct NotesTheFirst : ChunkSink {
  explicit NotesTheFirst(const ExecutionContext& context) : context(context) {}
  bool accept(Chunk&& chunk) override {
    if (at_first == 0 && !chunk.triangles.empty()) at_first = context.progress().triangles;
    return true;
  }
  const ExecutionContext& context;
  std::uint64_t at_first = 0;
};

TEST(Streaming, BeginsBeforeTheCoarseMeshIsMade) {
  ExecutionContext context;
  NotesTheFirst sink(context);
  const auto summary = generate_mesh(request_of(4 * kTriangles), sink, context);
  ASSERT_TRUE(summary);
  ASSERT_GT(summary->leaves.size(), 256u);
  // The coarse mesh for these leaves has some 25 triangles in each.
  const std::uint64_t coarse = 25 * summary->leaves.size();
  EXPECT_GT(sink.at_first, 0u);
  EXPECT_LT(sink.at_first, kSanitized ? coarse : coarse / 2);
}

TEST(Streaming, IsToldByTheSummary) {
  const auto streamed = [](MeshRequest request) {
    const auto summary = mesh_on(nullptr, request);
    EXPECT_TRUE(summary);
    return summary && summary->streamed;
  };
  EXPECT_TRUE(streamed(busy_square(40'000, 200)));
  EXPECT_FALSE(streamed(busy_square(2'000, 200)));  // few leaves
  MeshRequest steep = busy_square(40'000, 200);
  steep.min_angle_deg = 30.5;
  EXPECT_FALSE(streamed(steep));
}

TEST(Streaming, IsBoundedOnManyThreads) {
  const double one = peak_on(1, 4 * kTriangles);
  const double many = peak_on(16, 4 * kTriangles);
  // What each thread may begin ahead is much of a mesh as small as those of sanitized builds.
  if (!kSanitized) {
    EXPECT_LT(many, 2.5 * one);
  }
}

// Takes no chunk for a while once it has had a few.
struct Stalls : ChunkSink {
  explicit Stalls(const ExecutionContext& context) : context(context) {}
  bool accept(Chunk&& chunk) override {
    triangles += chunk.triangles.size() / 3;
    if (++chunks != 20) return true;
    // Until refinement has stopped.
    std::uint64_t before = 0;
    do {
      before = context.progress().triangles;
      std::this_thread::sleep_for(std::chrono::milliseconds(kSanitized ? 500 : 100));
    } while (context.progress().triangles != before);
    stalled_at = before;
    return true;
  }
  const ExecutionContext& context;
  int chunks = 0;
  std::uint64_t triangles = 0;
  std::uint64_t stalled_at = 0;  // triangles of the mesh by then
};

TEST(Streaming, StopsRefinementWhileItsReaderStalls) {
  const MeshRequest request = request_of(kTriangles);
  Arena arena(2);
  const auto plain = mesh_on(&arena, request);
  ASSERT_TRUE(plain);
  ExecutionContext context;
  context.set_arena(arena);
  Stalls sink(context);
  const auto summary = generate_mesh(request, sink, context);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->digest, plain->digest);
  ASSERT_GT(sink.stalled_at, 0u);
  // What may be begun ahead of the reader is most of a mesh as small as those of sanitized builds.
  if (!kSanitized) {
    EXPECT_LT(static_cast<double>(sink.stalled_at), 0.5 * static_cast<double>(summary->triangles));
  }
  EXPECT_LT(static_cast<double>(summary->peak_bytes), 1.3 * static_cast<double>(plain->peak_bytes));
}

struct StallsAtRandom : ChunkSink {
  bool accept(Chunk&&) override {
    if (random() % 8 == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
    return true;
  }
  std::mt19937 random{1};
};

TEST(Streaming, GivesOneMeshWhateverItsReaderDoes) {
  MeshRequest request{.pslg = read_poly(model("cylinder.poly")),
                      .size = "0.02 + 0.002*(x^2+y^2)",
                      .leaf_triangles = kSanitized ? 100.0 : 200.0};
  const std::string expected = outcome(mesh_on(nullptr, request));
  for (const int threads : {1, 2, 3, 7, 16}) {
    Arena arena(threads);
    StallsAtRandom sink;
    EXPECT_EQ(outcome(mesh_on(&arena, request, sink)), expected) << threads << " threads";
  }
}

// The clean-up must come before the rest: nothing is held then, and nothing waits for ever.
TEST(Streaming, GoesOnWhereTheCleanUpComesFirst) {
  MeshRequest request{.pslg = read_poly(model("us-east-coast.poly")),
                      .size = "1e-2*(1.5+sin(x)*cos(y))",
                      .min_angle_deg = 29,
                      .allow_unrefined = true,
                      .leaf_triangles = 60};
  const std::string expected = outcome(mesh_on(nullptr, request));
  for (const int threads : {2, 7}) {
    Arena arena(threads);
    EXPECT_EQ(outcome(mesh_on(&arena, request)), expected) << threads << " threads";
  }
}

}  // namespace
}  // namespace weft
