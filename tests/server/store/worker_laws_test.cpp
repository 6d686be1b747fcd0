// SPDX-License-Identifier: Apache-2.0
// The laws of a store, as those who work for it see them.
#include <atomic>
#include <map>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

TEST_P(StoreTest, AClaimHoldsWhatWasSubmitted) {
  const JobRecord job = submit(
      {.owner = "ann", .key = key_of("k"), .request = "make it", .estimate = 7, .trace = "t"});
  const auto claimed = store_->claim("w-1", hours(1), 7);
  ASSERT_TRUE(claimed && *claimed);
  EXPECT_EQ((*claimed)->ref.attempt, 1U);
  EXPECT_EQ((*claimed)->key, key_of("k"));
  EXPECT_EQ((*claimed)->owner, "ann");
  EXPECT_EQ((*claimed)->request, "make it");
  EXPECT_EQ((*claimed)->estimate, 7U);
  EXPECT_EQ((*claimed)->job_id, job.id);
  EXPECT_EQ((*claimed)->trace, "t");
  EXPECT_EQ((*claimed)->tries, 1U);
  EXPECT_EQ((*claimed)->ref.task, job.task);
  const JobRecord running = get(job);
  EXPECT_EQ(running.state, JobState::kRunning);
  EXPECT_EQ(running.worker, "w-1");
  EXPECT_EQ(running.attempts, 1U);
  EXPECT_TRUE(running.started);
  EXPECT_FALSE(running.ended);
}

TEST_P(StoreTest, OnlyTriesThatCountAreTold) {
  submit("ann", "k");
  ASSERT_EQ(store_->release(claim().ref, milliseconds(0), false), Held::kHeld);
  const Claim second = claim();
  EXPECT_EQ(second.ref.attempt, 2U);
  EXPECT_EQ(second.tries, 1U);
  ASSERT_EQ(store_->release(second.ref, milliseconds(0), true), Held::kHeld);
  EXPECT_EQ(claim().tries, 2U);
}

TEST_P(StoreTest, ATaskIsClaimedOnce) {
  submit("ann", "k");
  claim();
  EXPECT_FALSE(try_claim());
}

TEST_P(StoreTest, TheOldestTaskOfAnOwnerComesFirst) {
  for (const char* key : {"1", "2", "3"}) submit("ann", key);
  for (const char* key : {"1", "2", "3"}) EXPECT_EQ(claim().key, key_of(key));
}

TEST_P(StoreTest, TasksKeepTheirOrderThoughTheClockIsSetBack) {
  submit("ann", "older");
  EXPECT_FALSE(store_->reap({})->clock_was_set_back);
  backend_->pass(-hours(1));
  submit("ann", "younger");
  EXPECT_TRUE(store_->reap({})->clock_was_set_back);
  EXPECT_EQ(claim().key, key_of("older")) << "it waits until the clock has caught up";
  EXPECT_EQ(claim().key, key_of("younger"));
}

TEST_P(StoreTest, WhatIsGivenBackIsDueThoughTheClockIsSetBack) {
  submit("ann", "k");
  ASSERT_EQ(store_->release(claim().ref, hours(5), true), Held::kHeld);
  EXPECT_FALSE(try_claim());
  backend_->pass(kLongestDelay);
  ASSERT_EQ(store_->release(claim().ref, kLongestDelay, true), Held::kHeld);
  reap();
  EXPECT_FALSE(try_claim()) << "it was made due though it need not be";
  backend_->pass(-hours(1));
  reap();
  EXPECT_TRUE(try_claim());
}

TEST_P(StoreTest, ALeaseEndsInTimeThoughTheClockIsSetBack) {
  submit("ann", "k");
  const Claim claimed = claim(seconds(30));
  const RetryPolicy policy{.first_delay = milliseconds(0), .longest_lease = seconds(30)};
  backend_->pass(-hours(1));
  EXPECT_EQ(store_->reap(policy)->requeued, 0U) << "its holder may be at work";
  EXPECT_EQ(store_->renew(claimed.ref, seconds(30), ""), Held::kHeld);
  backend_->pass(seconds(31));
  EXPECT_EQ(store_->reap(policy)->requeued, 1U);
}

TEST_P(StoreTest, TheOwnerWithTheFewestClaimsComesFirst) {
  for (int i = 0; i < 6; ++i) submit("ann", "a" + std::to_string(i));
  for (int i = 0; i < 3; ++i) submit("bob", "b" + std::to_string(i));
  submit("cid", "c");
  std::map<std::string, int> claims;
  for (int i = 0; i < 3; ++i) ++claims[claim().owner];
  EXPECT_EQ(claims, (std::map<std::string, int>{{"ann", 1}, {"bob", 1}, {"cid", 1}}));
  for (int i = 0; i < 4; ++i) ++claims[claim().owner];
  EXPECT_EQ(claims, (std::map<std::string, int>{{"ann", 3}, {"bob", 3}, {"cid", 1}}));
}

TEST_P(StoreTest, OwnersThatAreExceptedGetNoClaim) {
  const std::string strange = "o'hara, \xc3\xa9\"%_";
  for (const std::string& owner : {std::string("ann"), std::string("an"), strange, std::string()})
    submit(owner, "of " + owner);
  const auto next = [&](const std::vector<std::string>& except) {
    const auto claimed = store_->claim("worker", hours(1), kAnyEstimate, except);
    EXPECT_TRUE(claimed) << claimed.error().message;
    return *claimed ? (*claimed)->owner : "none";
  };
  EXPECT_EQ(next({"ann", "an", strange, ""}), "none");
  EXPECT_EQ(next({"ann", "an", ""}), strange);
  EXPECT_EQ(next({"an", "", "bob"}), "ann");
  EXPECT_EQ(next({"", "ann"}), "an");
  EXPECT_EQ(next({"ann"}), "");
}

TEST_P(StoreTest, OwnersWithTheSameNumberOfClaimsTakeTurns) {
  for (const char* owner : {"ann", "bob", "cid"}) {
    for (int i = 0; i < 3; ++i) submit(owner, owner + std::to_string(i));
  }
  std::string served;
  for (int i = 0; i < 9; ++i) {
    const Claim claimed = claim();
    served += claimed.owner[0];
    ASSERT_EQ(store_->fail(claimed.ref, "done"), Held::kHeld);
  }
  EXPECT_EQ(served, "abcabcabc");
}

TEST_P(StoreTest, AClaimTakesNoMoreThanItsWeight) {
  submit({.owner = "ann", .key = key_of("heavy"), .estimate = 100});
  submit({.owner = "ann", .key = key_of("light"), .estimate = 10});
  EXPECT_FALSE(try_claim(hours(1), 9));
  EXPECT_EQ(try_claim(hours(1), 10)->key, key_of("light"));
  EXPECT_FALSE(try_claim(hours(1), 99));
  EXPECT_EQ(try_claim(hours(1), 100)->key, key_of("heavy"));
}

TEST_P(StoreTest, TheGreatestWeightsAreTakenToo) {
  submit({.owner = "ann", .key = key_of("1"), .estimate = kAnyEstimate});
  submit({.owner = "ann", .key = key_of("2"), .estimate = kAnyEstimate});
  EXPECT_GT(stats().queued_estimate, std::uint64_t{1} << 62);
  EXPECT_FALSE(try_claim(hours(1), std::uint64_t{1} << 62));
  claim();
  claim();
}

TEST_P(StoreTest, ProgressIsSeenUntilTheWorkEnds) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  ASSERT_EQ(store_->renew(claimed.ref, hours(1), std::string("\0half", 5)), Held::kHeld);
  EXPECT_EQ(get(job).progress, std::string("\0half", 5));
  ASSERT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kHeld);
  EXPECT_EQ(get(job).progress, "");
}

TEST_P(StoreTest, ALeaseThatIsRenewedIsNotReaped) {
  submit("ann", "k");
  const Claim claimed = claim(minutes(1));
  backend_->pass(seconds(50));
  ASSERT_EQ(store_->renew(claimed.ref, minutes(1), ""), Held::kHeld);
  backend_->pass(seconds(50));
  EXPECT_EQ(reap().requeued, 0U);
  backend_->pass(seconds(20));
  EXPECT_EQ(reap().requeued, 1U);
}

TEST_P(StoreTest, WhoeverHoldsAnOlderClaimChangesNothing) {
  const JobRecord job = submit("ann", "k");
  const Claim old = claim(milliseconds(0));
  ASSERT_EQ(reap().requeued, 1U);
  const StoredMesh mesh_of_old = put({"old"});
  const auto changes_nothing = [&] {
    EXPECT_EQ(store_->renew(old.ref, hours(1), "old"), Held::kLost);
    EXPECT_EQ(store_->finish(old.ref, mesh_of_old), Held::kLost);
    EXPECT_EQ(store_->fail(old.ref, "old"), Held::kLost);
    EXPECT_EQ(store_->release(old.ref, milliseconds(0), true), Held::kLost);
  };
  changes_nothing();  // while the task waits
  const Claim young = claim();
  EXPECT_EQ(young.ref.task, old.ref.task);
  EXPECT_GT(young.ref.attempt, old.ref.attempt);
  changes_nothing();  // while another has it
  EXPECT_EQ(get(job).state, JobState::kRunning);
  EXPECT_EQ(get(job).attempts, 2U);
  ASSERT_EQ(store_->finish(young.ref, put({"young"})), Held::kHeld);
  changes_nothing();  // once it is settled
  EXPECT_EQ(get(job).state, JobState::kSucceeded);
  EXPECT_EQ(mesh("k")->chunks.at(0).sha256, sha256_of("young"));
}

TEST_P(StoreTest, ATaskThatIsLostTooOftenFailsWithTheErrorOfThePolicy) {
  const JobRecord job = submit("ann", "k");
  for (int i = 0; i < 2; ++i) {
    claim(milliseconds(0));
    EXPECT_EQ(reap(3).requeued, 1U);
    EXPECT_EQ(get(job).state, JobState::kQueued);
  }
  claim(milliseconds(0));
  EXPECT_EQ(reap(3).failed, 1U);
  const JobRecord failed = get(job);
  EXPECT_EQ(failed.state, JobState::kFailed);
  EXPECT_EQ(failed.error, "tried too often");
  EXPECT_EQ(failed.attempts, 3U);
  EXPECT_FALSE(try_claim());
  EXPECT_EQ(reap(3).failed, 0U);
}

TEST_P(StoreTest, ATaskThatIsGivenBackTooOftenFailsToo) {
  const JobRecord job = submit("ann", "k");
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(store_->release(claim().ref, milliseconds(0), true), Held::kHeld);
  }
  EXPECT_EQ(reap(3).failed, 0U);
  EXPECT_EQ(reap(2).failed, 1U);
  EXPECT_EQ(get(job).state, JobState::kFailed);
}

TEST_P(StoreTest, TheDelayDoublesWithEveryAttemptUpToAMinute) {
  submit("ann", "k");
  const RetryPolicy policy{.max_attempts = 100, .first_delay = seconds(10), .error = ""};
  for (const int delay : {10, 20, 40, 60, 60}) {
    claim(milliseconds(0));
    ASSERT_EQ(store_->reap(policy)->requeued, 1U);
    backend_->pass(seconds(delay - 5));
    EXPECT_FALSE(try_claim()) << "before " << delay << " s";
    backend_->pass(seconds(5));
  }
  EXPECT_TRUE(try_claim());
}

TEST_P(StoreTest, WhatIsGivenBackIsDueAfterTheDelay) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  ASSERT_EQ(store_->renew(claimed.ref, hours(1), "half"), Held::kHeld);
  ASSERT_EQ(store_->release(claimed.ref, seconds(30), true), Held::kHeld);
  EXPECT_EQ(get(job).state, JobState::kQueued);
  EXPECT_EQ(get(job).progress, "");
  EXPECT_FALSE(try_claim());
  backend_->pass(seconds(31));
  EXPECT_EQ(claim().ref.attempt, 2U);
  EXPECT_EQ(get(job).attempts, 2U);
}

TEST_P(StoreTest, WhatIsGivenBackBecauseTheServerStopsIsNoAttempt) {
  const JobRecord job = submit("ann", "k");
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Claim claimed = claim();
    EXPECT_EQ(claimed.ref.attempt, i + 1) << "it is a fence all the same";
    ASSERT_EQ(store_->release(claimed.ref, milliseconds(0), false), Held::kHeld);
    EXPECT_EQ(get(job).attempts, 0U);
    EXPECT_FALSE(get(job).started);
  }
  EXPECT_EQ(reap(1).failed, 0U);
}

TEST_P(StoreTest, AJobStartedWithItsFirstAttempt) {
  const JobRecord job = submit("ann", "k");
  claim(milliseconds(0));
  const auto started = get(job).started;
  reap();
  EXPECT_EQ(get(job).started, started);
  claim();
  EXPECT_EQ(get(job).started, started);
}

TEST_P(StoreTest, AMeshIsReadAsItWasFinished) {
  submit("ann", "k");
  const std::string large(std::size_t{1} << 20, 'x');
  const std::string zeros(1000, '\0');
  StoredMesh finished = put({large, zeros, "", large});  // a chunk may come twice
  finished.summary = std::string("\0summary\xff", 9);
  ASSERT_EQ(store_->finish(claim().ref, finished), Held::kHeld);
  const auto found = mesh("k");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->summary, finished.summary);
  ASSERT_EQ(found->chunks.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found->chunks[i].sha256, finished.chunks[i].sha256);
    EXPECT_EQ(found->chunks[i].bytes, finished.chunks[i].bytes);
  }
  EXPECT_TRUE(has_chunk(large) && has_chunk(zeros) && has_chunk(""));
}

TEST_P(StoreTest, AMeshOfNoChunksIsAMesh) {
  submit("ann", "k");
  ASSERT_EQ(store_->finish(claim().ref, {.summary = "empty", .brief = {}, .chunks = {}}),
            Held::kHeld);
  EXPECT_EQ(mesh("k")->summary, "empty");
}

TEST_P(StoreTest, AMeshWithAMissingChunkIsRefusedAndTheClaimIsStillHeld) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  StoredMesh whole = put({"a"});
  StoredMesh torn = whole;
  torn.chunks.push_back({sha256_of("b"), 1});
  const auto refused = store_->finish(claimed.ref, torn);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_EQ(get(job).state, JobState::kRunning);
  EXPECT_FALSE(mesh("k"));
  EXPECT_EQ(store_->finish(claimed.ref, whole), Held::kHeld);
}

TEST_P(StoreTest, AChunkThatIsThereIsPutAgainInVain) {
  put({"a"});
  put({"a"});
  EXPECT_EQ(stats().chunk_bytes, 1U);
  EXPECT_TRUE(has_chunk("a"));
}

TEST_P(StoreTest, FinishingAgainWithTheSameClaimIsHeldAndChangesNothing) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  ASSERT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kHeld);
  const JobRecord ended = get(job);
  EXPECT_EQ(store_->finish(claimed.ref, put({"b"})), Held::kHeld);
  EXPECT_EQ(get(job).ended, ended.ended);
  EXPECT_EQ(mesh("k")->chunks.at(0).sha256, sha256_of("a"));
  EXPECT_EQ(store_->fail(claimed.ref, "no"), Held::kLost);
  EXPECT_EQ(store_->renew(claimed.ref, hours(1), ""), Held::kLost);
}

TEST_P(StoreTest, FailingAgainWithTheSameClaimIsHeldAndChangesNothing) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  ASSERT_EQ(store_->fail(claimed.ref, "first"), Held::kHeld);
  EXPECT_EQ(store_->fail(claimed.ref, "second"), Held::kHeld);
  EXPECT_EQ(get(job).error, "first");
  EXPECT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kLost);
}

TEST_P(StoreTest, AllJobsOfAFailedTaskFail) {
  const JobRecord one = submit("ann", "k");
  const JobRecord two = submit("bob", "k");
  ASSERT_EQ(store_->fail(claim().ref, "it cannot be"), Held::kHeld);
  for (const JobRecord& job : {one, two}) {
    EXPECT_EQ(get(job).state, JobState::kFailed);
    EXPECT_EQ(get(job).error, "it cannot be");
    EXPECT_TRUE(get(job).ended);
  }
  EXPECT_FALSE(mesh("k"));
  submit("ann", "k");
  EXPECT_EQ(stats().queued, 1U) << "a failure is not kept as an answer";
}

TEST_P(StoreTest, ChangesAreAnnounced) {
  std::atomic<int> heard = 0;
  store_->on_change([&] { ++heard; });
  const auto announces = [&](const char* what, const auto& call) {
    const int before = heard;
    call();
    EXPECT_GT(heard, before) << what;
  };
  JobRecord job;
  Claim claimed;
  announces("submit", [&] { job = submit("ann", "k"); });
  announces("claim", [&] { claimed = claim(); });
  announces("renew", [&] { ASSERT_EQ(store_->renew(claimed.ref, hours(1), "half"), Held::kHeld); });
  announces("release", [&] { (void)store_->release(claimed.ref, milliseconds(0), true); });
  announces("claim", [&] { claimed = claim(milliseconds(0)); });
  announces("reap", [&] { reap(); });
  announces("claim", [&] { claimed = claim(); });
  announces("finish", [&] { ASSERT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kHeld); });
  announces("submit",
            [&] { job = submit({.owner = "ann", .key = key_of("k"), .no_cache = true}); });
  announces("cancel", [&] { ASSERT_TRUE(*store_->cancel("ann", job.id)); });
}

TEST_P(StoreTest, ACallThatChangesNothingIsNotAnnounced) {
  submit("ann", "k");
  const Claim claimed = claim();
  std::atomic<int> heard = 0;
  store_->on_change([&] { ++heard; });
  EXPECT_FALSE(try_claim());
  reap();
  EXPECT_EQ(store_->renew({claimed.ref.task, claimed.ref.attempt + 1}, hours(1), ""), Held::kLost);
  put({"a"});
  EXPECT_EQ(heard, 0) << "whoever claims when told of a change would never stop";
}

}  // namespace
}  // namespace weft::server
