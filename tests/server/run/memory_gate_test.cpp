// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/context.h"
#include "server/run/run_memory.h"

namespace weft::server {
namespace {

constexpr std::uint64_t kStep = MemoryGate::kStep;
const auto kGoOn = [] { return std::optional<Error>(); };
const auto kNoRoom = [] {};

TEST(MemoryGate, AdmitsWhatFitsAndNoMore) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  const auto first = gate.take({.estimate = 60});
  ASSERT_TRUE(first);
  EXPECT_FALSE(gate.take({.estimate = 41}));
  EXPECT_EQ(gate.room(), 40);
  const auto second = gate.take({.estimate = 40});
  EXPECT_TRUE(second);
  EXPECT_EQ(gate.taken(), 100);
}

TEST(MemoryGate, GivesWhoeverIsAloneWhatThereIs) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  const auto request = gate.take({.estimate = 30, .request = true});
  const auto heavy = gate.take({.estimate = 1000});
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->bytes(), 70);
  EXPECT_EQ(gate.taken(), 100);
  EXPECT_FALSE(gate.take({.estimate = 1}));
}

TEST(MemoryGate, LetsTheLargestRunBeginThoughSomebodyReads) {
  MemoryGate gate({.capacity = 100, .of_client = 40}, kNoRoom);
  const auto reader = gate.take({.estimate = 40, .client = "ann", .reader = true});
  ASSERT_TRUE(reader);
  EXPECT_FALSE(gate.take({.estimate = 1, .client = "ann"})) << "it is part of its client's";
  EXPECT_TRUE(gate.take({.estimate = 1000, .client = "bob"}));
}

TEST(MemoryGate, LetsTheLargestRunBeginThoughSomebodyReadsWhatARunMade) {
  int notified = 0;
  MemoryGate gate({.capacity = 100, .for_light = 30, .of_client = 20}, [&] { ++notified; });
  auto share = gate.take({.estimate = 20, .client = "ann", .light = true});
  ASSERT_TRUE(share);
  EXPECT_FALSE(gate.take({.estimate = 1000, .client = "bob"}));
  share->turn_reader();
  EXPECT_EQ(notified, 1);
  EXPECT_EQ(gate.taken(), 20);
  EXPECT_FALSE(gate.take({.estimate = 1, .client = "ann"})) << "it is part of its client's";
  EXPECT_EQ(gate.room(true), std::numeric_limits<std::int64_t>::max());
  const auto heavy = gate.take({.estimate = 1000, .client = "bob"});
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->bytes(), 80);
  share->shrink_to(0);
  share.reset();
  EXPECT_FALSE(gate.take({.estimate = 1000, .client = "cid"})) << "bob's is still at work";
}

TEST(MemoryGate, TakesBackAShareOfNothing) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  {
    const auto of_another = gate.take({.estimate = 10, .client = "ann"});
    auto share = gate.take({.estimate = 10, .client = "bob"});
    share->shrink_to(0);
  }
  EXPECT_EQ(gate.taken(), 0);
}

TEST(MemoryGate, RefusesARequestThatDoesNotFitThoughNothingRuns) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  const auto first = gate.take({.estimate = 60, .request = true});
  ASSERT_TRUE(first);
  EXPECT_FALSE(gate.take({.estimate = 41, .request = true}));
}

TEST(MemoryGate, TakesBackASharesBytesOnceAndSaysSo) {
  int told = 0;
  MemoryGate gate({.capacity = 100}, [&] { ++told; });
  {
    auto share = gate.take({.estimate = 60});
    const auto moved = std::move(*share);
    EXPECT_EQ(gate.taken(), 60);
  }
  EXPECT_EQ(gate.taken(), 0);
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(gate.take({.estimate = 1000}));
}

TEST(MemoryGate, TakesBackWhatAShareShrinksBy) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto share = gate.take({.estimate = 60});
  share->shrink_to(20);
  EXPECT_EQ(gate.taken(), 20);
  share->shrink_to(50);
  EXPECT_EQ(gate.taken(), 20);
}

TEST(MemoryGate, GrowsAShareByStepsAsLongAsThereAreAny) {
  MemoryGate gate({.capacity = 2 * kStep}, kNoRoom);
  auto share = gate.take({.estimate = 10});
  EXPECT_EQ(share->grow_to(11, kGoOn), std::nullopt);
  EXPECT_EQ(share->bytes(), 10 + kStep);
  EXPECT_EQ(share->grow_to(11 + kStep, kGoOn), std::nullopt);
  EXPECT_EQ(share->bytes(), 2 * kStep);
}

TEST(MemoryGate, RefusesWhatIsMoreThanThereIsInAll) {
  MemoryGate gate({.capacity = 100, .for_light = 10}, kNoRoom);
  auto share = gate.take({.estimate = 10});
  const auto error = share->grow_to(91, kGoOn);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kLimitExceeded);
  EXPECT_NE(error->message.find("91"), std::string::npos) << error->message;
  EXPECT_NE(error->message.find("100"), std::string::npos) << error->message;
}

TEST(MemoryGate, WaitsForWhatAnotherRunGivesBack) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto first = gate.take({.estimate = 60});
  auto second = gate.take({.estimate = 40});
  auto grown = std::async([&] { return second->grow_to(50, kGoOn); });
  while (gate.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(gate.taken(), 100);
  first.reset();
  EXPECT_EQ(grown.get(), std::nullopt);
  EXPECT_EQ(gate.waiting(), 0);
}

TEST(MemoryGate, EndsAWaitWithWhatThePollSays) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto first = gate.take({.estimate = 60});
  auto second = gate.take({.estimate = 40});
  const auto error = second->grow_to(50, [] {
    return std::optional<Error>({ErrorCode::kCancelled, "", "enough"});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kCancelled);
  EXPECT_EQ(gate.waiting(), 0);
}

// The one that was judged wrongly, though it is the older one.
TEST(MemoryGate, EndsTheRunFarthestBeyondItsEstimateIfAllWait) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto light = gate.take({.estimate = 10});
  auto heavy = gate.take({.estimate = 50});
  EXPECT_EQ(light->grow_to(50, kGoOn), std::nullopt);
  auto ended = std::async([&] {
    auto error = light->grow_to(60, kGoOn);
    light.reset();
    return error;
  });
  while (gate.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(heavy->grow_to(60, kGoOn), std::nullopt);
  const auto error = ended.get();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
}

// One that waits for a place, which only the end of the other gives it.
TEST(MemoryGate, CountsARunThatIsParkedAsOneThatWaits) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto parked = gate.take({.estimate = 50});
  auto running = gate.take({.estimate = 50});
  parked->set_parked(true);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto error = running->grow_to(60, [&]() -> std::optional<Error> {
    if (std::chrono::steady_clock::now() < deadline) return std::nullopt;
    return Error{ErrorCode::kCancelled, "", "nobody was ended"};
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
}

TEST(MemoryGate, EndsTheYoungestOfEquals) {
  MemoryGate gate({.capacity = 100}, kNoRoom);
  auto older = gate.take({.estimate = 50});
  auto younger = gate.take({.estimate = 50});
  auto grown = std::async([&] { return older->grow_to(60, kGoOn); });
  while (gate.waiting() == 0) std::this_thread::yield();
  const auto error = younger->grow_to(60, kGoOn);
  younger.reset();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(grown.get(), std::nullopt);
}

TEST(MemoryGate, NeverGivesMoreThanItHasWhateverManyRunsDo) {
  constexpr std::uint64_t kCapacity = 1000;
  MemoryGate gate({.capacity = kCapacity}, kNoRoom);
  std::atomic<std::uint64_t> held{0};
  std::atomic<int> ended{0};
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (std::uint64_t i = 0; i < 50; ++i) {
        auto share = gate.take({.estimate = 20 + t});
        if (!share) continue;
        std::uint64_t mine = 0;
        for (std::uint64_t bytes = 50; bytes < 600 && !share->grow_to(bytes, kGoOn); bytes += 50) {
          EXPECT_LE(held += bytes - mine, kCapacity);
          mine = bytes;
        }
        held -= mine;
        ++ended;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(ended, 8);
  EXPECT_EQ(gate.taken(), 0);
}

TEST(MemoryGate, KeepsAPartForLightRuns) {
  MemoryGate gate({.capacity = 100, .for_light = 20}, kNoRoom);
  auto heavy = gate.take({.estimate = 80});
  ASSERT_TRUE(heavy);
  EXPECT_FALSE(gate.take({.estimate = 1}));
  auto light = gate.take({.estimate = 15, .light = true});
  ASSERT_TRUE(light);
  EXPECT_FALSE(gate.take({.estimate = 6, .light = true}));
  EXPECT_EQ(gate.room(true), 5);
  light->turn_heavy();
  EXPECT_EQ(gate.room(false), 0);
}

TEST(MemoryGate, LetsAClientBeginNothingBeyondItsPart) {
  MemoryGate gate({.capacity = 100, .of_client = 50}, kNoRoom);
  auto first = gate.take({.estimate = 50, .client = "a"});
  EXPECT_FALSE(gate.take({.estimate = 1, .client = "a"}));
  EXPECT_TRUE(gate.take({.estimate = 1, .client = "b"}));
  first.reset();
  EXPECT_TRUE(gate.take({.estimate = 1, .client = "a"}));
}

TEST(RunMemory, GrantsWhatIsNotHeldBesides) {
  MemoryGate gate({.capacity = 10 * kStep}, kNoRoom);
  auto share = gate.take({.estimate = 100});
  RunMemory memory(*share, 30);
  EXPECT_EQ(memory.granted(), 70);
  EXPECT_EQ(*memory.grant(71, [] { return std::nullopt; }), 70 + kStep);
}

TEST(RunMemory, EndsARunAtItsLimitUntilThatBeginsAgain) {
  MemoryGate gate({.capacity = 10 * kStep}, kNoRoom);
  auto share = gate.take({.estimate = 100});
  RunMemory memory(*share, 30);
  memory.limit_to(50);
  weft::Run run;
  run.set_memory(memory, memory.granted());
  EXPECT_EQ(run.context().need_bytes(50, "the run"), std::nullopt);
  EXPECT_FALSE(memory.limit_was_reached());
  EXPECT_TRUE(run.context().need_bytes(51, "the run"));
  EXPECT_TRUE(memory.limit_was_reached());
  memory.begin_again();
  EXPECT_EQ(gate.taken(), 30) << "what is besides";
  run.begin_again();
  run.set_memory(memory, memory.granted());
  EXPECT_EQ(run.context().need_bytes(5 * kStep, "the run"), std::nullopt);
  EXPECT_EQ(gate.taken(), 30 + 5 * kStep);
}

}  // namespace
}  // namespace weft::server
