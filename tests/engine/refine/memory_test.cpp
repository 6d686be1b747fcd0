// SPDX-License-Identifier: Apache-2.0
// Where the mesh is stored while it is refined: blocks by the runs of a thread, and pages that
// outlive runs of the engine.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/failure.h"
#include "engine/engine.h"
#include "engine/refine/storage/block_pool.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/reserved_memory.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

std::vector<std::uint32_t> take(BlockPool& pool, std::uint32_t count) {
  std::vector<std::uint32_t> blocks(count);
  for (std::uint32_t& block : blocks) block = pool.take().value();
  return blocks;
}

TEST(Blocks, NextToOneAnotherAreOfOneThread) {
  BlockPool pool(5, 1000);  // its first run is shorter
  auto mine = take(pool, BlockPool::kRun - 5 + 3);
  std::vector<std::uint32_t> others;
  std::thread([&] { others = take(pool, 20); }).join();
  const auto rest = take(pool, BlockPool::kRun - 3);
  mine.insert(mine.end(), rest.begin(), rest.end());
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_EQ(mine[i], 5 + i);
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_EQ(others[i], 2 * BlockPool::kRun + i);
}

TEST(Blocks, AreHandedOutOnceUntilThereAreNoMore) {
  BlockPool pool(0, 1000);
  std::vector<std::uint32_t> taken[2];
  const auto take_all = [&](std::vector<std::uint32_t>& blocks) {
    while (const auto block = pool.take()) blocks.push_back(*block);
  };
  std::thread other([&] { take_all(taken[1]); });
  take_all(taken[0]);
  other.join();
  auto& all = taken[0];
  all.insert(all.end(), taken[1].begin(), taken[1].end());
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all.size(), 1000u);
  for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
}

TEST(Blocks, GivenBackAreTakenAgainBeforeFreshOnes) {
  BlockPool pool(0, 1000);
  auto blocks = take(pool, 3 * BlockPool::kRun);
  for (const std::uint32_t block : blocks) pool.give_back(block);
  auto again = take(pool, 3 * BlockPool::kRun);
  std::sort(again.begin(), again.end());
  EXPECT_EQ(again, blocks);
  EXPECT_EQ(pool.peak(), 3 * BlockPool::kRun);
}

ReservedMemory reserved(std::size_t bytes, Pages pages) {
  auto memory = ReservedMemory::reserve(bytes, pages);
  EXPECT_TRUE(memory);
  return std::move(*memory);
}

// What other tests have left, so that nothing of it is in the way.
std::vector<ReservedMemory> all_kept() {
  std::vector<ReservedMemory> all;
  while (all.empty() || all.back().huge_pages()) all.push_back(reserved(1, Pages::kAny));
  return all;
}

bool mapped(const std::byte* page) {
  unsigned char resident = 0;
  return mincore(const_cast<std::byte*>(page), 1, &resident) == 0;
}

TEST(ReservedMemory, OfSmallPagesIsZeroAndNotKept) {
  for (int i = 0; i < 2; ++i) {
    const ReservedMemory memory = reserved(3 * kMiB, Pages::kSmall);
    EXPECT_FALSE(memory.huge_pages());
    EXPECT_GE(memory.bytes(), 3 * kMiB);
    EXPECT_TRUE(std::all_of(memory.data(), memory.data() + memory.bytes(),
                            [](std::byte b) { return b == std::byte{0}; }));
    std::memset(memory.data(), 1, memory.bytes());
  }
}

TEST(ReservedMemory, OfHugePagesIsKeptForTheNext) {
  const auto others = all_kept();
  const std::byte* left = nullptr;
  {
    const ReservedMemory memory = reserved(6 * kMiB, Pages::kHuge);
    left = memory.data();
  }
  EXPECT_TRUE(mapped(left));
  const ReservedMemory again = reserved(5 * kMiB, Pages::kAny);
  EXPECT_EQ(again.data(), left);
  EXPECT_TRUE(again.huge_pages());
  const ReservedMemory other = reserved(5 * kMiB, Pages::kSmall);
  EXPECT_NE(other.data(), left);
}

TEST(ReservedMemory, IsTakenFromTheSmallestThatHasRoom) {
  const auto others = all_kept();
  const std::byte* left[3];
  {
    const ReservedMemory large = reserved(40 * kMiB, Pages::kHuge);
    const ReservedMemory fitting = reserved(20 * kMiB, Pages::kHuge);
    const ReservedMemory small = reserved(6 * kMiB, Pages::kHuge);
    left[0] = large.data();
    left[1] = fitting.data();
    left[2] = small.data();
  }
  const ReservedMemory first = reserved(18 * kMiB, Pages::kHuge);
  EXPECT_EQ(first.data(), left[1]);
  const ReservedMemory second = reserved(18 * kMiB, Pages::kHuge);
  EXPECT_EQ(second.data(), left[0]);
  const ReservedMemory third = reserved(18 * kMiB, Pages::kHuge);
  EXPECT_NE(third.data(), left[2]);
}

TEST(ReservedMemory, IsKeptUpToANumberOfRangesAndOfBytes) {
  const auto others = all_kept();
  constexpr std::size_t kBytes = ReservedMemory::kKeptBytes + 4 * kMiB;
  std::vector<const std::byte*> left;
  {
    std::vector<ReservedMemory> all;
    for (std::size_t i = 0; i <= ReservedMemory::kKeptRanges; ++i) {
      all.push_back(reserved(kBytes, Pages::kHuge));
      all.back().data()[kBytes - 1] = std::byte{1};
      left.push_back(all.back().data());
    }
    while (!all.empty()) all.erase(all.begin());
  }
  EXPECT_FALSE(mapped(left.front()));
  for (std::size_t i = 1; i < left.size(); ++i) {
    ASSERT_TRUE(mapped(left[i]));
    EXPECT_EQ(left[i][kBytes - 1], std::byte{0});
  }
}

TEST(ReservedMemory, IsKeptUpToTheBytesOfAProcess) {
  const auto others = all_kept();
  constexpr std::size_t kOfEach = kMiB;
  ReservedMemory::keep_at_most(2 * ReservedMemory::kKeptRanges * kOfEach);
  const std::byte* left = nullptr;
  {
    const ReservedMemory memory = reserved(6 * kMiB, Pages::kHuge);
    std::memset(memory.data(), 1, memory.bytes());
    left = memory.data();
  }
  ReservedMemory::keep_at_most(2 * ReservedMemory::kKeptRanges * ReservedMemory::kKeptBytes);
  ASSERT_TRUE(mapped(left));
  for (std::size_t i = kOfEach; i < 6 * kMiB; i += 4096) EXPECT_EQ(left[i], std::byte{0}) << i;
}

TEST(ReservedMemory, IsGivenUpWhereThereIsNoRoomForMore) {
  const auto others = all_kept();
  const std::byte* left = nullptr;
  { left = reserved(6 * kMiB, Pages::kHuge).data(); }
  const auto more = ReservedMemory::reserve(std::size_t{1} << 60, Pages::kHuge);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::kOutOfMemory);
  EXPECT_FALSE(mapped(left));
}

TEST(ReservedMemory, ThatAnotherJobLeftChangesNoMesh) {
  const MeshRequest request{.pslg = square(), .size = 2e-5};
  Budget budget;
  budget.triangle_limit = 1'000'000;
  std::optional<Digest> digest;
  for (int run = 0; run < 2; ++run) {
    CollectedMesh mesh;
    ExecutionContext context(budget);
    const auto summary = generate_mesh(request, mesh, context);
    ASSERT_TRUE(summary);
    EXPECT_EQ(verdict(request, mesh, *summary), "");
    if (digest) {
      EXPECT_EQ(summary->digest, *digest);
    }
    digest = summary->digest;
    // More than the second needs for its triangles and vertices.
    std::vector<ReservedMemory> left;
    while (left.size() < ReservedMemory::kKeptRanges) {
      left.push_back(reserved(256 * kMiB, Pages::kHuge));
      std::memset(left.back().data(), 0xab, 8 * kMiB);
    }
  }
}

// The slots of a mesh with this limit end long before the memory does.
TEST(MeshSlots, EndWithALimitAndNotForWantOfMemory) {
  Domain domain;
  auto mesh = MeshStore::from(domain, 1, 1, ExecutionContext());
  ASSERT_TRUE(mesh);
  try {
    for (;;) mesh->take_triangle_block(1, 0);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.error().code, ErrorCode::kLimitExceeded);
    EXPECT_NE(failure.error().message.find("triangles in memory at the same time"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace weft
