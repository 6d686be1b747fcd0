// SPDX-License-Identifier: Apache-2.0
// The laws of a store with many threads at it.
#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <set>
#include <thread>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

constexpr int kThreads = 8;

// Runs `work(thread)` on all threads, and waits for them.
void together(const std::function<void(int)>& work) {
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
}

TEST_P(StoreTest, ManyWhoClaimGetEachTaskOnce) {
  constexpr int kTasks = 500;
  for (int i = 0; i < kTasks; ++i) submit("owner " + std::to_string(i % 7), std::to_string(i));
  std::atomic<int> left = kTasks;
  std::mutex mutex;
  std::multiset<std::string> claimed;
  together([&](int) {
    // Nothing to claim may mean that another is just looking at the last task.
    while (left > 0) {
      const auto found = try_claim();
      if (!found) continue;
      --left;
      const std::lock_guard lock(mutex);
      claimed.insert(found->key);
    }
  });
  EXPECT_EQ(claimed.size(), static_cast<std::size_t>(kTasks));
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), claimed.size());
  EXPECT_FALSE(try_claim());
}

TEST_P(StoreTest, ManyWhoAskForTheSameMeshShareOneTask) {
  std::atomic<int> accepted = 0;
  together([&](int thread) {
    for (int i = 0; i < 20; ++i) {
      accepted += submit("owner " + std::to_string(thread), "k").state == JobState::kQueued;
    }
  });
  EXPECT_EQ(accepted, kThreads * 20);
  EXPECT_EQ(stats().queued, 1U);
  ASSERT_EQ(store_->finish(claim().ref, put({"a"})), Held::kHeld);
  for (int thread = 0; thread < kThreads; ++thread) {
    const ListQuery succeeded{.owner = "owner " + std::to_string(thread),
                              .states = {JobState::kSucceeded}};
    EXPECT_EQ(list(succeeded).size(), 20U);
  }
}

TEST_P(StoreTest, ManyWhoSendTheSameRequestIdFindOneJob) {
  constexpr int kRequests = 30;
  std::mutex mutex;
  std::set<std::string> ids;
  std::atomic<int> accepted = 0;
  together([&](int) {
    for (int i = 0; i < kRequests; ++i) {
      const auto submitted = store_->submit(
          {.owner = "ann", .request_id = std::to_string(i), .key = key_of("k"), .no_cache = true});
      ASSERT_TRUE(submitted) << submitted.error().message;
      accepted += submitted->outcome == SubmitOutcome::kAccepted;
      const std::lock_guard lock(mutex);
      ids.insert(submitted->job.id);
    }
  });
  EXPECT_EQ(accepted, kRequests);
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kRequests));
  EXPECT_EQ(stats().queued, static_cast<std::uint64_t>(kRequests));
}

TEST_P(StoreTest, ManyWhoSubmitAtOnceFillTheQueueExactly) {
  std::atomic<int> accepted = 0;
  together([&](int thread) {
    for (int i = 0; i < 20; ++i) {
      const auto submitted = store_->submit(
          {.owner = "ann", .key = key_of(std::to_string(100 * thread + i)), .max_queued = 50});
      ASSERT_TRUE(submitted) << submitted.error().message;
      accepted += submitted->outcome == SubmitOutcome::kAccepted;
    }
  });
  EXPECT_EQ(accepted, 50);
  EXPECT_EQ(stats().queued, 50U);
}

// Submissions join while their task is settled: whichever comes first, none is left behind.
TEST_P(StoreTest, WhoeverJoinsWhileTheTaskEndsIsServedOrQueuedAnew) {
  std::atomic<int> submitting = kThreads - 2;
  together([&](int thread) {
    if (thread >= 2) {
      for (int i = 0; i < 40; ++i) submit("ann", std::to_string(i % 3));
      --submitting;
      return;
    }
    const StoredMesh made = put({"a"});
    while (submitting > 0 || stats().queued + stats().running > 0) {
      const auto found = try_claim();
      if (!found) continue;
      const auto held =
          thread == 0 ? store_->fail(found->ref, "no") : store_->finish(found->ref, made);
      EXPECT_EQ(held, Held::kHeld);
    }
  });
  const auto jobs = store_->list({.owner = "ann", .limit = 1000});
  ASSERT_EQ(jobs->size(), 40U * (kThreads - 2));
  for (const JobRecord& job : *jobs) EXPECT_TRUE(is_final(job.state)) << job.id;
}

TEST_P(StoreTest, CancellingWhileOthersJoinLeavesNoJobBehind) {
  std::atomic<int> kept = 0;
  together([&](int thread) {
    for (int i = 0; i < 60; ++i) {
      const JobRecord job = submit("ann", "k");
      if (thread % 2 == 0) {
        const auto cancelled = store_->cancel("ann", job.id);
        ASSERT_TRUE(cancelled && *cancelled);
        EXPECT_EQ((*cancelled)->state, JobState::kCancelled);
      } else {
        ++kept;
      }
    }
  });
  EXPECT_EQ(stats().queued, 1U);
  ASSERT_EQ(store_->finish(claim().ref, put({"a"})), Held::kHeld);
  const ListQuery succeeded{.owner = "ann", .states = {JobState::kSucceeded}, .limit = 1000};
  EXPECT_EQ(list(succeeded).size(), static_cast<std::size_t>(kept));
}

TEST_P(StoreTest, ATaskMayLoseItsLastJobWhileAnotherJoins) {
  together([&](int) {
    for (int i = 0; i < 40; ++i) {
      const JobRecord job = submit("ann", "k");
      const auto cancelled = store_->cancel("ann", job.id);
      ASSERT_TRUE(cancelled) << cancelled.error().message;
      EXPECT_EQ((*cancelled)->state, JobState::kCancelled);
    }
  });
  EXPECT_EQ(stats().queued, 0U);
}

TEST_P(StoreTest, ManyWhoPutTheSameChunksStoreThemOnce) {
  together([&](int thread) {
    for (int i = 0; i < 50; ++i) put({"chunk " + std::to_string((i + 7 * thread) % 50)});
  });
  EXPECT_EQ(stats().chunk_bytes, 10U * 7 + 40U * 8);
}

// Law 3 against the house-keeping: what `finish` has accepted is whole, whatever is collected.
TEST_P(StoreTest, WhatIsCollectedMeanwhileIsNeverPartOfAMesh) {
  std::atomic<int> making = kThreads - 2;
  std::atomic<int> accepted = 0;
  together([&](int thread) {
    if (thread < 2) {
      while (making > 0) {
        const auto collected =
            store_->collect({.age = hours(1), .bytes = 60, .loose_age = seconds(0)});
        EXPECT_TRUE(collected) << collected.error().message;
      }
      return;
    }
    for (int i = 0; i < 15; ++i) {
      submit({.owner = "ann", .key = key_of(std::to_string(i % 4)), .no_cache = true});
      const auto found = try_claim();
      if (!found) continue;
      const std::string name = std::to_string(i % 6);
      const auto held = store_->finish(found->ref, put({"first " + name, "second " + name}));
      if (held) {
        EXPECT_EQ(*held, Held::kHeld);
        ++accepted;
      } else {
        EXPECT_EQ(held.error().kind, StoreErrorKind::kUnavailable) << held.error().message;
        EXPECT_NE(held.error().message.find("chunk"), std::string::npos) << held.error().message;
      }
    }
    --making;
  });
  for (int i = 0; i < 4; ++i) {
    const auto found = mesh(std::to_string(i));
    if (!found) continue;
    ASSERT_EQ(found->chunks.size(), 2U);
    for (const StoredChunk& chunk : found->chunks) {
      const auto bytes = store_->chunk(chunk.sha256);
      ASSERT_TRUE(bytes && *bytes);
      EXPECT_EQ(sha256_of(**bytes), chunk.sha256);
    }
  }
}

TEST_P(StoreTest, IdsAreUniqueAndSortByTime) {
  std::mutex mutex;
  std::vector<std::string> ids;
  together([&](int thread) {
    std::string last;
    for (int i = 0; i < 50; ++i) {
      const JobRecord job = submit("ann", std::to_string(thread));
      EXPECT_GT(job.id, last);
      last = job.id;
      const std::lock_guard lock(mutex);
      ids.push_back(job.id);
    }
  });
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

}  // namespace
}  // namespace weft::server
