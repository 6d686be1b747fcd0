// SPDX-License-Identifier: Apache-2.0
// The laws of a store: what is kept, for how long, and what it comes to.
#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

constexpr std::uint64_t kAnyBytes = std::uint64_t{1} << 60;

TEST_P(StoreTest, JobsThatEndedLongAgoAreCollected) {
  const JobRecord old = made("old", {"a"});
  const JobRecord running = submit("ann", "running");
  claim();
  backend_->pass(hours(2));
  const JobRecord young = made("young", {"b"});
  const auto collected = store_->collect({.age = hours(1), .bytes = kAnyBytes});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->jobs, 1U);
  EXPECT_EQ(list({.owner = "ann"}), (std::vector<std::string>{young.id, running.id}));
}

TEST_P(StoreTest, OfAnOwnersJobsThatEndedTheOldestAreCollected) {
  made("k", {"a"});  // ann's, and those that follow find it
  std::vector<std::string> young;
  const JobRecord open = submit("ann", "open");
  for (int i = 0; i < 1100; ++i) young.push_back(submit("ann", "k").id);
  const JobRecord other = submit("bob", "k");
  const auto collected = store_->collect({.age = hours(1), .bytes = kAnyBytes, .jobs_of_owner = 3});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->jobs, 1098U);
  EXPECT_EQ(list({.owner = "ann"}),
            (std::vector<std::string>{young[1099], young[1098], young[1097], open.id}));
  EXPECT_EQ(list({.owner = "bob"}), std::vector<std::string>{other.id});
}

TEST_P(StoreTest, AnOwnersMeshesTakeTheirShareAtMost) {
  const auto of = [&](const char* owner, const char* key, char chunk) {
    submit(owner, key);
    ASSERT_EQ(store_->finish(claim().ref, put({std::string(1000, chunk)})), Held::kHeld);
    backend_->pass(seconds(1));
  };
  of("bob", "oldest", 'o');
  for (const char* key : {"a", "b", "c", "d"}) of("ann", key, *key);
  ASSERT_TRUE(mesh("a"));
  const KeepPolicy policy{.age = hours(1), .bytes = 4000, .share_of_owner = 0.5};
  const auto collected = store_->collect(policy);
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->meshes, 2U);
  EXPECT_TRUE(mesh("oldest") && mesh("a") && mesh("d"));
  EXPECT_FALSE(mesh("b") || mesh("c"));
  EXPECT_EQ(store_->collect(policy)->meshes, 0U);
}

TEST_P(StoreTest, MeshesThatNobodyAskedForAreCollectedWithTheirChunks) {
  made("old", {"a", "shared"});
  made("asked", {"b"});
  backend_->pass(hours(2));
  made("young", {"c", "shared"});
  ASSERT_TRUE(mesh("asked"));
  const auto collected =
      store_->collect({.age = hours(1), .bytes = kAnyBytes, .loose_age = hours(1)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->meshes, 1U);
  EXPECT_EQ(collected->chunks, 1U);
  EXPECT_EQ(collected->bytes, 1U);
  EXPECT_FALSE(mesh("old"));
  EXPECT_TRUE(mesh("asked") && mesh("young"));
  EXPECT_FALSE(has_chunk("a"));
  EXPECT_TRUE(has_chunk("b") && has_chunk("c") && has_chunk("shared"));
}

TEST_P(StoreTest, ASubmissionAsksForItsMesh) {
  made("k", {"a"});
  backend_->pass(hours(2));
  submit("bob", "k");
  EXPECT_EQ(store_->collect({.age = hours(1), .bytes = kAnyBytes})->meshes, 0U);
}

TEST_P(StoreTest, OverTheBytesTheMeshesGoThatWereLongestNotAskedFor) {
  for (int i = 0; i < 4; ++i) {
    made(std::to_string(i), {std::string(1000, static_cast<char>('a' + i))});
    backend_->pass(seconds(1));
  }
  ASSERT_TRUE(mesh("0"));
  const KeepPolicy policy{.age = hours(1), .bytes = 2500, .loose_age = seconds(0)};
  const auto collected = store_->collect(policy);
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->meshes, 2U);
  EXPECT_EQ(collected->bytes, 2000U);
  EXPECT_TRUE(mesh("0") && mesh("3"));
  EXPECT_FALSE(mesh("1") || mesh("2"));
  EXPECT_EQ(stats().chunk_bytes, 2000U);
  EXPECT_EQ(store_->collect(policy)->meshes, 0U);
}

TEST_P(StoreTest, ManyMeshesAreCollectedInOneCall) {
  for (int i = 0; i < 120; ++i) made(std::to_string(i), {"chunk " + std::to_string(i)});
  const auto collected = store_->collect({.age = seconds(0), .loose_age = seconds(0)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->jobs, 120U);
  EXPECT_EQ(collected->meshes, 120U);
  EXPECT_EQ(collected->chunks, 120U);
  EXPECT_EQ(stats().chunk_bytes, 0U);
}

TEST_P(StoreTest, ChunksOfAMeshThatIsBeingMadeStayForTheirLooseAge) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  const StoredMesh mesh_of_job = put({"a", "b"});
  backend_->pass(minutes(50));
  put({"b"});  // it counts as put anew
  backend_->pass(minutes(20));
  const auto collected = store_->collect({.age = hours(9), .bytes = 0, .loose_age = hours(1)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->chunks, 1U);
  EXPECT_FALSE(has_chunk("a"));
  EXPECT_TRUE(has_chunk("b"));
  EXPECT_EQ(store_->finish(claimed.ref, mesh_of_job).error().kind, StoreErrorKind::kUnavailable);
  put({"a"});
  EXPECT_EQ(store_->finish(claimed.ref, mesh_of_job), Held::kHeld);
}

TEST_P(StoreTest, TheChunksThatAReplacedMeshLeavesAreCollected) {
  made("k", {"a", "shared"});
  made("k", {"b", "shared"});
  EXPECT_EQ(stats().meshes, 1U);
  const auto collected =
      store_->collect({.age = hours(1), .bytes = kAnyBytes, .loose_age = seconds(0)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->chunks, 1U);
  EXPECT_FALSE(has_chunk("a"));
  EXPECT_TRUE(has_chunk("b") && has_chunk("shared"));
}

TEST_P(StoreTest, AJobOutlivesItsMesh) {
  const JobRecord job = made("k", {"a"});
  EXPECT_EQ(store_->collect({.age = hours(1), .bytes = 0, .loose_age = seconds(0)})->meshes, 1U);
  EXPECT_EQ(get(job).state, JobState::kSucceeded);
  EXPECT_FALSE(mesh("k"));
  submit("ann", "k");
  EXPECT_EQ(stats().queued, 1U) << "it is made anew";
}

TEST_P(StoreTest, CollectingTouchesNoTask) {
  const JobRecord queued = submit("ann", "queued");
  const JobRecord running = submit("bob", "running");
  claim();
  backend_->pass(hours(100));
  const auto collected = store_->collect({.age = seconds(0), .loose_age = seconds(0)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(stats().queued, 1U);
  EXPECT_EQ(stats().running, 1U);
  get(queued);
  get(running);
}

TEST_P(StoreTest, StatsCountWhatIsThere) {
  EXPECT_EQ(stats().oldest_queued_seconds, 0);
  made("made", {"0123456789", "abc"});
  submit({.owner = "ann", .key = key_of("1"), .estimate = 5});
  backend_->pass(seconds(100));
  submit({.owner = "bob", .key = key_of("2"), .estimate = 6});
  submit({.owner = "cid", .key = key_of("3"), .estimate = 9});
  StoreStats found = stats();
  EXPECT_EQ(found.queued, 3U);
  EXPECT_EQ(found.running, 0U);
  EXPECT_EQ(found.queued_estimate, 20U);
  EXPECT_GE(found.oldest_queued_seconds, 100);
  EXPECT_LT(found.oldest_queued_seconds, 1000);
  EXPECT_EQ(found.meshes, 1U);
  EXPECT_EQ(found.chunk_bytes, 13U);
  claim();
  found = stats();
  EXPECT_EQ(found.queued, 2U);
  EXPECT_EQ(found.running, 1U);
}

TEST_P(StoreTest, WhatWasAnsweredIsThereAfterTheStoreIsOpenedAgain) {
  const JobRecord ended = made("made", {"a"});
  const JobRecord running = submit("ann", "running");
  const Claim claimed = claim();
  const JobRecord queued = submit("ann", "queued");
  reopen();
  EXPECT_EQ(get(ended).state, JobState::kSucceeded);
  EXPECT_EQ(get(running).state, JobState::kRunning);
  EXPECT_EQ(get(queued).state, JobState::kQueued);
  EXPECT_EQ(mesh("made")->chunks.size(), 1U);
  EXPECT_TRUE(has_chunk("a"));
  EXPECT_EQ(store_->renew(claimed.ref, hours(1), ""), Held::kHeld);
}

}  // namespace
}  // namespace weft::server
