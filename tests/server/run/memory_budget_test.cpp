// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_budget.h"

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

constexpr std::uint64_t kStep = MemoryBudget::kStep;
const auto kGoOn = [] { return std::optional<Error>(); };
const auto kNoRelease = [] {};
using Purpose = MemoryBudget::Purpose;

TEST(MemoryBudget, AdmitsWhatFitsAndNoMore) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  const auto first = budget.reserve({.estimate = 60});
  ASSERT_TRUE(first);
  EXPECT_FALSE(budget.reserve({.estimate = 41}));
  EXPECT_EQ(budget.max_estimate(false), 40);
  const auto second = budget.reserve({.estimate = 40});
  EXPECT_TRUE(second);
  EXPECT_EQ(budget.reserved(), 100);
}

TEST(MemoryBudget, GivesTheOnlyRunAllThatIsFree) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  const auto request = budget.reserve({.estimate = 30, .purpose = Purpose::kInput});
  const auto heavy = budget.reserve({.estimate = 1000});
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->bytes(), 70);
  EXPECT_EQ(budget.reserved(), 100);
  EXPECT_FALSE(budget.reserve({.estimate = 1}));
}

TEST(MemoryBudget, LetsTheLargestRunBeginThoughSomebodyReads) {
  MemoryBudget budget({.capacity = 100, .max_per_client = 40}, kNoRelease);
  const auto reader =
      budget.reserve({.estimate = 40, .client = "ann", .purpose = Purpose::kOutput});
  ASSERT_TRUE(reader);
  EXPECT_FALSE(budget.reserve({.estimate = 1, .client = "ann"})) << "it is part of its client's";
  EXPECT_TRUE(budget.reserve({.estimate = 1000, .client = "bob"}));
}

TEST(MemoryBudget, LetsTheLargestRunBeginThoughSomebodyReadsWhatARunMade) {
  int notified = 0;
  MemoryBudget budget({.capacity = 100, .light_reserve = 30, .max_per_client = 20},
                      [&] { ++notified; });
  auto reservation = budget.reserve({.estimate = 20, .client = "ann", .light = true});
  ASSERT_TRUE(reservation);
  EXPECT_FALSE(budget.reserve({.estimate = 1000, .client = "bob"}));
  reservation->reclassify_as_output();
  EXPECT_EQ(notified, 1);
  EXPECT_EQ(budget.reserved(), 20);
  EXPECT_FALSE(budget.reserve({.estimate = 1, .client = "ann"})) << "it is part of its client's";
  EXPECT_EQ(budget.max_estimate(true), std::numeric_limits<std::int64_t>::max());
  const auto heavy = budget.reserve({.estimate = 1000, .client = "bob"});
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->bytes(), 80);
  reservation->shrink_to(0);
  reservation.reset();
  EXPECT_FALSE(budget.reserve({.estimate = 1000, .client = "cid"})) << "bob's is still at work";
}

TEST(MemoryBudget, ReleasesAnEmptyReservation) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  {
    const auto of_another = budget.reserve({.estimate = 10, .client = "ann"});
    auto reservation = budget.reserve({.estimate = 10, .client = "bob"});
    reservation->shrink_to(0);
  }
  EXPECT_EQ(budget.reserved(), 0);
}

TEST(MemoryBudget, RefusesARequestThatDoesNotFitThoughNothingRuns) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  const auto first = budget.reserve({.estimate = 60, .purpose = Purpose::kInput});
  ASSERT_TRUE(first);
  EXPECT_FALSE(budget.reserve({.estimate = 41, .purpose = Purpose::kInput}));
}

TEST(MemoryBudget, KeepsTheLastByteFromRequestsSoThatARunMayBegin) {
  MemoryBudget budget({.capacity = 100, .light_reserve = 20}, kNoRelease);
  const auto first = budget.reserve({.estimate = 60, .purpose = Purpose::kInput});
  EXPECT_FALSE(budget.reserve({.estimate = 20, .purpose = Purpose::kInput}));
  const auto second = budget.reserve({.estimate = 19, .purpose = Purpose::kInput});
  ASSERT_TRUE(second);
  EXPECT_TRUE(budget.reserve({.estimate = 50}));
}

TEST(MemoryBudget, RefusesWhatNeverFitsBesideItsRequest) {
  MemoryBudget budget({.capacity = 100, .light_reserve = 10}, kNoRelease);
  EXPECT_FALSE(budget.check_fits(60, 30));
  const auto error = budget.check_fits(61, 30);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(error->message,
            "the mesh needs more than 61 bytes beside the 30 of its request; this server's limit "
            "for all of its runs is 100");
  EXPECT_TRUE(budget.check_fits(0, 91));
}

TEST(MemoryBudget, DoesNotLetARunWaitForItsOwnRequest) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  const auto request = budget.reserve({.estimate = 60, .purpose = Purpose::kInput});
  auto run = budget.reserve({.estimate = 20, .input = 60});
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->grow_to(40, kGoOn));
  const auto error = run->grow_to(41, kGoOn);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kLimitExceeded) << "trying again would end the same way";
}

TEST(MemoryBudget, ReleasesTheBytesOfAReservationOnceAndReportsIt) {
  int releases = 0;
  MemoryBudget budget({.capacity = 100}, [&] { ++releases; });
  {
    auto reservation = budget.reserve({.estimate = 60});
    const auto moved = std::move(*reservation);
    EXPECT_EQ(budget.reserved(), 60);
  }
  EXPECT_EQ(budget.reserved(), 0);
  EXPECT_EQ(releases, 1);
  EXPECT_TRUE(budget.reserve({.estimate = 1000}));
}

TEST(MemoryBudget, ReleasesWhatAReservationShrinksBy) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto reservation = budget.reserve({.estimate = 60});
  reservation->shrink_to(20);
  EXPECT_EQ(budget.reserved(), 20);
  reservation->shrink_to(50);
  EXPECT_EQ(budget.reserved(), 20);
}

TEST(MemoryBudget, GrowsAReservationByStepsWhileTheyAreFree) {
  MemoryBudget budget({.capacity = 2 * kStep}, kNoRelease);
  auto reservation = budget.reserve({.estimate = 10});
  EXPECT_EQ(reservation->grow_to(11, kGoOn), std::nullopt);
  EXPECT_EQ(reservation->bytes(), 10 + kStep);
  EXPECT_EQ(reservation->grow_to(11 + kStep, kGoOn), std::nullopt);
  EXPECT_EQ(reservation->bytes(), 2 * kStep);
}

TEST(MemoryBudget, RefusesMoreThanItsCapacity) {
  MemoryBudget budget({.capacity = 100, .light_reserve = 10}, kNoRelease);
  auto reservation = budget.reserve({.estimate = 10});
  const auto error = reservation->grow_to(91, kGoOn);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kLimitExceeded);
  EXPECT_NE(error->message.find("91"), std::string::npos) << error->message;
  EXPECT_NE(error->message.find("100"), std::string::npos) << error->message;
}

TEST(MemoryBudget, WaitsForWhatAnotherRunReleases) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto first = budget.reserve({.estimate = 60});
  auto second = budget.reserve({.estimate = 40});
  auto grown = std::async([&] { return second->grow_to(50, kGoOn); });
  while (budget.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(budget.reserved(), 100);
  first.reset();
  EXPECT_EQ(grown.get(), std::nullopt);
  EXPECT_EQ(budget.waiting(), 0);
}

TEST(MemoryBudget, EndsAWaitWithWhatThePollSays) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto first = budget.reserve({.estimate = 60});
  auto second = budget.reserve({.estimate = 40});
  const auto error = second->grow_to(50, [] {
    return std::optional<Error>({ErrorCode::kCancelled, "", "enough"});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kCancelled);
  EXPECT_EQ(budget.waiting(), 0);
}

// The one that was judged wrongly, though it is the older one.
TEST(MemoryBudget, CancelsTheRunFarthestBeyondItsEstimateIfAllWait) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto light = budget.reserve({.estimate = 10});
  auto heavy = budget.reserve({.estimate = 50});
  EXPECT_EQ(light->grow_to(50, kGoOn), std::nullopt);
  auto ended = std::async([&] {
    auto error = light->grow_to(60, kGoOn);
    light.reset();
    return error;
  });
  while (budget.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(heavy->grow_to(60, kGoOn), std::nullopt);
  const auto error = ended.get();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
}

// The blocked run waits for a slot, which only the end of the other run releases.
TEST(MemoryBudget, CountsABlockedRunAsOneThatWaits) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto blocked = budget.reserve({.estimate = 50});
  auto running = budget.reserve({.estimate = 50});
  blocked->mark_blocked(true);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto error = running->grow_to(60, [&]() -> std::optional<Error> {
    if (std::chrono::steady_clock::now() < deadline) return std::nullopt;
    return Error{ErrorCode::kCancelled, "", "no run was cancelled"};
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
}

TEST(MemoryBudget, CancelsTheYoungestOfEquals) {
  MemoryBudget budget({.capacity = 100}, kNoRelease);
  auto older = budget.reserve({.estimate = 50});
  auto younger = budget.reserve({.estimate = 50});
  auto grown = std::async([&] { return older->grow_to(60, kGoOn); });
  while (budget.waiting() == 0) std::this_thread::yield();
  const auto error = younger->grow_to(60, kGoOn);
  younger.reset();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(grown.get(), std::nullopt);
}

TEST(MemoryBudget, NeverReservesMoreThanItsCapacity) {
  constexpr std::uint64_t kCapacity = 1000;
  MemoryBudget budget({.capacity = kCapacity}, kNoRelease);
  std::atomic<std::uint64_t> held{0};
  std::atomic<int> ended{0};
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (std::uint64_t i = 0; i < 50; ++i) {
        auto reservation = budget.reserve({.estimate = 20 + t});
        if (!reservation) continue;
        std::uint64_t mine = 0;
        for (std::uint64_t bytes = 50; bytes < 600 && !reservation->grow_to(bytes, kGoOn);
             bytes += 50) {
          EXPECT_LE(held += bytes - mine, kCapacity);
          mine = bytes;
        }
        held -= mine;
        ++ended;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(ended, 8);
  EXPECT_EQ(budget.reserved(), 0);
}

TEST(MemoryBudget, KeepsAReserveForLightRuns) {
  MemoryBudget budget({.capacity = 100, .light_reserve = 20}, kNoRelease);
  auto heavy = budget.reserve({.estimate = 80});
  ASSERT_TRUE(heavy);
  EXPECT_FALSE(budget.reserve({.estimate = 1}));
  auto light = budget.reserve({.estimate = 15, .light = true});
  ASSERT_TRUE(light);
  EXPECT_FALSE(budget.reserve({.estimate = 6, .light = true}));
  EXPECT_EQ(budget.max_estimate(true), 5);
  light->reclassify_as_heavy();
  EXPECT_EQ(budget.max_estimate(false), 0);
}

TEST(MemoryBudget, LetsAClientBeginNothingBeyondItsMaximum) {
  MemoryBudget budget({.capacity = 100, .max_per_client = 50}, kNoRelease);
  auto first = budget.reserve({.estimate = 50, .client = "a"});
  EXPECT_FALSE(budget.reserve({.estimate = 1, .client = "a"}));
  EXPECT_TRUE(budget.reserve({.estimate = 1, .client = "b"}));
  first.reset();
  EXPECT_TRUE(budget.reserve({.estimate = 1, .client = "a"}));
}

TEST(RunMemory, GrantsWhatIsNotHeldBesides) {
  MemoryBudget budget({.capacity = 10 * kStep}, kNoRelease);
  auto reservation = budget.reserve({.estimate = 100});
  RunMemory memory(*reservation, 30);
  EXPECT_EQ(memory.granted(), 70);
  EXPECT_EQ(*memory.grant(71, [] { return std::nullopt; }), 70 + kStep);
}

TEST(RunMemory, EndsARunAtItsLimitUntilThatBeginsAgain) {
  MemoryBudget budget({.capacity = 10 * kStep}, kNoRelease);
  auto reservation = budget.reserve({.estimate = 100});
  RunMemory memory(*reservation, 30);
  memory.limit_to(50);
  weft::Run run;
  run.set_memory(memory, memory.granted());
  EXPECT_EQ(run.context().need_bytes(50, "the run"), std::nullopt);
  EXPECT_FALSE(memory.limit_was_reached());
  EXPECT_TRUE(run.context().need_bytes(51, "the run"));
  EXPECT_TRUE(memory.limit_was_reached());
  memory.begin_again();
  EXPECT_EQ(budget.reserved(), 30) << "what is besides";
  run.begin_again();
  run.set_memory(memory, memory.granted());
  EXPECT_EQ(run.context().need_bytes(5 * kStep, "the run"), std::nullopt);
  EXPECT_EQ(budget.reserved(), 30 + 5 * kStep);
}

}  // namespace
}  // namespace weft::server
