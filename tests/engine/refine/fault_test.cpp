// SPDX-License-Identifier: Apache-2.0
// Memory that runs out, at any moment and on any thread, ends the run with a typed error and leaves
// the arena fit for the next run. And what a run has allocated stays within its budget.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>

#include "tests/engine/domain/arcs/arc_shapes.h"
#include "tests/engine/parallel/parallel.h"
#include "weft/weft.h"

namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

// The allocations that still succeed.
std::atomic<std::int64_t> allocations_left{kNever};
// Whether all that follow fail too.
std::atomic<bool> for_good{false};

// Bytes of what is allocated, and the most that there were.
std::atomic<std::int64_t> held{0};
std::atomic<std::int64_t> most_held{0};

void count(void* p) {
  const auto bytes = static_cast<std::int64_t>(malloc_usable_size(p));
  const std::int64_t now = held.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  for (std::int64_t most = most_held.load(std::memory_order_relaxed); most < now;)
    if (most_held.compare_exchange_weak(most, now, std::memory_order_relaxed)) break;
}

void release(void* p) noexcept {
  held.fetch_sub(static_cast<std::int64_t>(malloc_usable_size(p)), std::memory_order_relaxed);
  std::free(p);
}

void* allocate(std::size_t size, std::size_t alignment) {
  const std::int64_t left = allocations_left.fetch_sub(1, std::memory_order_relaxed);
  if (left == 1 || (left < 1 && for_good.load(std::memory_order_relaxed))) throw std::bad_alloc();
  const std::size_t rounded = (size + alignment) / alignment * alignment;
  void* const p = alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, rounded)
                                                        : std::malloc(rounded);
  if (!p) throw std::bad_alloc();
  count(p);
  return p;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return allocate(size, 1);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
// Inlined, g++ takes them for a free of what new has returned.
[[gnu::noinline]] void operator delete(void* p) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, const std::nothrow_t&) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  release(p);
}

namespace weft {
namespace {

// While it lives, the n-th allocation fails; with `forever`, all after it as well.
class Fault {
 public:
  Fault(std::int64_t n, bool forever) {
    for_good = forever;
    allocations_left = n;
  }
  ~Fault() { allocations_left = kNever; }
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;
};

std::int64_t allocations_of(Arena& arena, const MeshRequest& request) {
  allocations_left = kNever;
  EXPECT_TRUE(mesh_on(&arena, request));
  return kNever - allocations_left.exchange(kNever);
}

class Faults : public testing::TestWithParam<bool> {};

TEST_P(Faults, InATaskEndTheJobWithATypedErrorAndLeaveTheArenaSound) {
  // With segments, regions and a graded size, in leaves enough to stream.
  MeshRequest request{.pslg = square(), .leaf_triangles = 100};
  request.size = "1.3e-4+6e-4*x^2";
  add_segment(request.pslg, {0.1, 0.1}, {0.9, 0.8}, 1);
  Arena arena(4);
  const auto whole = mesh_on(&arena, request);
  ASSERT_TRUE(whole);
  ASSERT_GE(whole->leaves.size(), 64u);
  const std::int64_t allocations = allocations_of(arena, request);
  std::mt19937_64 random(5);
  int failed = 0;
  constexpr int kFaults = kSanitized ? 100 : 400;
  for (int i = 0; i < kFaults; ++i) {
    // Each part of the run has its share.
    const std::int64_t slice = allocations / kFaults + 1;
    const std::int64_t n =
        1 + i * slice + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(slice));
    SCOPED_TRACE(n);
    const auto summary = [&] {
      const Fault fault(n, GetParam());
      return mesh_on(&arena, request);
    }();
    if (summary) {
      EXPECT_EQ(summary->digest, whole->digest);
    } else {
      ++failed;
      EXPECT_EQ(summary.error().code, ErrorCode::kOutOfMemory) << summary.error().message;
    }
    if (i % 10 == 0) {
      ASSERT_EQ(outcome(mesh_on(&arena, request)), outcome(whole));
    }
  }
  EXPECT_GT(failed, kFaults / 2);
}

INSTANTIATE_TEST_SUITE_P(Of, Faults, testing::Bool(), [](const auto& info) {
  return info.param ? "AllAllocationsFromOneOn" : "OneAllocation";
});

// Of squares that lie so close that the bound on angles asks for a million leaves between them.
TEST(HeldMemory, OfManyLeavesStaysWithinTheBudget) {
  constexpr double kApart = 1e-6;
  MeshRequest request;
  for (int i = 0; i < 50; ++i) {
    const double half = 1 - kApart * i;
    const auto first = static_cast<std::uint32_t>(request.pslg.points.size());
    for (const Point corner : {Point{-half, -half}, {half, -half}, {half, half}, {-half, half}})
      request.pslg.points.push_back(corner);
    for (std::uint32_t k = 0; k < 4; ++k)
      request.pslg.segments.push_back({first + k, first + (k + 1) % 4});
  }
  request.min_angle_deg = 20;
  for (const std::int64_t budget : {24'000'000, 64'000'000}) {
    ExecutionContext context(
        {.triangle_limit = 4'000'000'000, .max_bytes = static_cast<std::uint64_t>(budget)});
    const std::int64_t before = held;
    most_held = before;
    ForgetfulSink sink;
    const auto summary = generate_mesh(request, sink, context);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::kBudgetExceeded) << summary.error().message;
    EXPECT_LT(most_held - before, budget);
  }
}

// 3.6 M chords of 2 degrees, for a size that varies.
MeshRequest with_many_circles() {
  MeshRequest request{.size = "1 + x"};
  add_box(request.pslg, {0, 0}, {200, 100});
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 100; ++j) add_circle(request.pslg, {i + 0.5, j + 0.5}, 0.25, 2);
  return request;
}

TEST(HeldMemory, OfChordsStaysWithinTheBudget) {
  const MeshRequest request = with_many_circles();
  constexpr std::int64_t kBudget = 110'000'000;
  ExecutionContext context({.max_bytes = kBudget});
  const std::int64_t before = held;
  most_held = before;
  ForgetfulSink sink;
  const auto summary = generate_mesh(request, sink, context);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kBudgetExceeded);
  EXPECT_TRUE(summary.error().message.starts_with("chords of arcs")) << summary.error().message;
  EXPECT_LT(most_held - before, kBudget);
}

TEST(HeldMemory, OfAnEstimateIsThatOfAMillionChordsAtTheMost) {
  const MeshRequest request = with_many_circles();
  const std::int64_t before = held;
  most_held = before;
  const Estimate expected = estimate(request);
  EXPECT_LT(most_held - before, 48'000'000);
  EXPECT_GT(expected.bytes, 1'000'000'000u);  // the run makes them all
}

}  // namespace
}  // namespace weft
