// SPDX-License-Identifier: Apache-2.0
// The laws of a store, as its clients see them.
#include <algorithm>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

TEST_P(StoreTest, AJobIsThereAsItWasSubmitted) {
  const JobRecord job =
      submit({.owner = "ann", .request_id = "r-1", .key = key_of("k"), .request = "make it"});
  EXPECT_EQ(job.id.size(), 26U);
  const JobRecord found = get(job);
  EXPECT_EQ(found.id, job.id);
  EXPECT_EQ(found.owner, "ann");
  EXPECT_EQ(found.request_id, "r-1");
  EXPECT_EQ(found.key, key_of("k"));
  EXPECT_EQ(found.state, JobState::kQueued);
  EXPECT_EQ(found.created, job.created);
  EXPECT_FALSE(found.started || found.ended || found.from_store);
  EXPECT_EQ(found.attempts, 0U);
  EXPECT_EQ(found.worker + found.progress + found.error, "");
}

TEST_P(StoreTest, AKeyIsBytesAndMayHoldZeros) {
  std::string key(32, '\0');
  key[31] = '\xff';
  const JobRecord job = submit({.owner = "ann", .key = key, .request = std::string("\0\xfe", 2)});
  EXPECT_EQ(get(job).key, key);
  const Claim claimed = claim();
  EXPECT_EQ(claimed.key, key);
  EXPECT_EQ(claimed.request, std::string("\0\xfe", 2));
}

TEST_P(StoreTest, AnotherOwnersJobIsNotFound) {
  const JobRecord job = submit("ann", "k");
  EXPECT_FALSE(*store_->get("bob", job.id));
  EXPECT_FALSE(*store_->cancel("bob", job.id));
  EXPECT_FALSE(*store_->remove("bob", job.id));
  EXPECT_EQ(get(job).state, JobState::kQueued);
}

TEST_P(StoreTest, WhatIsNoIdIsNotFound) {
  for (const std::string& id : {std::string(), std::string("x"), std::string("a\0b", 3),
                                std::string("\xff\xfe"), std::string(26, '0')}) {
    const auto found = store_->get("ann", id);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(*found);
    EXPECT_FALSE(*store_->cancel("ann", id));
    EXPECT_FALSE(*store_->remove("ann", id));
  }
}

TEST_P(StoreTest, ARequestIdFindsTheSameJobAgain) {
  const Submission submission{.owner = "ann", .request_id = "r", .key = key_of("k")};
  const JobRecord job = submit(submission);
  const auto again = store_->submit(submission);
  EXPECT_EQ(again->outcome, SubmitOutcome::kFound);
  EXPECT_EQ(again->job.id, job.id);
  EXPECT_EQ(list({.owner = "ann"}).size(), 1U);
  EXPECT_EQ(stats().queued, 1U);
}

TEST_P(StoreTest, ARequestIdFindsAJobThatHasEnded) {
  const Submission submission{.owner = "ann", .request_id = "r", .key = key_of("k")};
  const JobRecord job = submit(submission);
  ASSERT_TRUE(*store_->cancel("ann", job.id));
  const auto again = store_->submit(submission);
  EXPECT_EQ(again->outcome, SubmitOutcome::kFound);
  EXPECT_EQ(again->job.state, JobState::kCancelled);
}

TEST_P(StoreTest, ARequestIdForAnotherKeyIsAConflictAndChangesNothing) {
  const JobRecord job = submit({.owner = "ann", .request_id = "r", .key = key_of("k")});
  const auto other = store_->submit({.owner = "ann", .request_id = "r", .key = key_of("another")});
  EXPECT_EQ(other->outcome, SubmitOutcome::kConflict);
  EXPECT_EQ(other->job.id, job.id);
  EXPECT_EQ(stats().queued, 1U);
  EXPECT_EQ(list({.owner = "ann"}).size(), 1U);
}

TEST_P(StoreTest, OwnersUseTheSameRequestIdForJobsOfTheirOwn) {
  const JobRecord of_ann = submit({.owner = "ann", .request_id = "r", .key = key_of("k")});
  const JobRecord of_bob = submit({.owner = "bob", .request_id = "r", .key = key_of("other")});
  EXPECT_NE(of_ann.id, of_bob.id);
}

TEST_P(StoreTest, JobsOfTheSameKeyShareATask) {
  const JobRecord one = submit("ann", "k");
  const JobRecord two = submit("bob", "k");
  EXPECT_EQ(stats().queued, 1U);
  const Claim claimed = claim();
  EXPECT_EQ(claimed.owner, "ann");
  EXPECT_EQ(claimed.job_id, one.id);
  EXPECT_FALSE(try_claim());
  const JobRecord three = submit("cid", "k");
  EXPECT_EQ(three.state, JobState::kRunning);
  EXPECT_EQ(three.started, three.created);
  ASSERT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kHeld);
  for (const JobRecord& job : {one, two, three}) {
    const JobRecord ended = get(job);
    EXPECT_EQ(ended.state, JobState::kSucceeded);
    EXPECT_EQ(ended.attempts, 1U);
    EXPECT_FALSE(ended.from_store);
    EXPECT_GE(*ended.started, ended.created);
    EXPECT_GE(*ended.ended, *ended.started);
  }
}

TEST_P(StoreTest, AMeshThatIsKeptIsFoundAtOnce) {
  made("k", {"a"});
  const JobRecord job = submit("bob", "k");
  EXPECT_EQ(job.state, JobState::kSucceeded);
  EXPECT_TRUE(job.from_store);
  EXPECT_EQ(job.ended, job.created);
  EXPECT_FALSE(job.started);
  EXPECT_EQ(job.attempts, 0U);
  EXPECT_FALSE(try_claim());
}

TEST_P(StoreTest, NoCacheMakesTheMeshAnew) {
  made("k", {"a"});
  const JobRecord job = submit({.owner = "ann", .key = key_of("k"), .no_cache = true});
  EXPECT_EQ(job.state, JobState::kQueued);
  ASSERT_EQ(store_->finish(claim().ref, put({"b", "c"})), Held::kHeld);
  EXPECT_EQ(mesh("k")->chunks.size(), 2U);
}

TEST_P(StoreTest, NoCacheSharesNoTask) {
  const JobRecord shared = submit("ann", "k");
  const JobRecord own = submit({.owner = "ann", .key = key_of("k"), .no_cache = true});
  const JobRecord another = submit({.owner = "ann", .key = key_of("k"), .no_cache = true});
  submit("ann", "k");
  EXPECT_EQ(stats().queued, 3U);
  ASSERT_EQ(store_->finish(claim().ref, put({"a"})), Held::kHeld);
  EXPECT_EQ(get(shared).state, JobState::kSucceeded);
  EXPECT_EQ(get(own).state, JobState::kQueued);
  EXPECT_EQ(get(another).state, JobState::kQueued);
}

TEST_P(StoreTest, AJobJoinsOnlyATaskThatMayUseAsMuch) {
  const auto of = [](const char* owner, std::uint64_t bytes, seconds time) {
    return Submission{.owner = owner, .key = key_of("k"), .budget = {bytes, time}};
  };
  const JobRecord frugal = submit(of("ann", 100, seconds(1)));
  const JobRecord same = submit(of("bob", 100, seconds(1)));
  EXPECT_EQ(same.task, frugal.task);
  const JobRecord longer = submit(of("bob", 100, seconds(2)));
  EXPECT_NE(longer.task, frugal.task);
  EXPECT_EQ(submit(of("cid", 99, seconds(2))).task, longer.task) << "the larger one is shared";
  const JobRecord larger = submit(of("cid", 101, seconds(2)));
  EXPECT_NE(larger.task, longer.task);
  EXPECT_EQ(submit(of("dan", 100, seconds(1))).task, larger.task);
  ASSERT_EQ(store_->fail(claim().ref, "time is up"), Held::kHeld);
  EXPECT_EQ(get(frugal).state, JobState::kFailed);
  EXPECT_EQ(get(same).state, JobState::kFailed);
  EXPECT_EQ(get(longer).state, JobState::kQueued);
  EXPECT_EQ(get(larger).state, JobState::kQueued);
}

TEST_P(StoreTest, AFullQueueTakesNoFurtherTask) {
  submit({.owner = "ann", .key = key_of("1")});
  submit({.owner = "bob", .key = key_of("2")});
  const auto refused = store_->submit({.owner = "cid", .key = key_of("3"), .max_queued = 2});
  EXPECT_EQ(refused->outcome, SubmitOutcome::kQueueFull);
  EXPECT_TRUE(list({.owner = "cid"}).empty());
  EXPECT_EQ(stats().queued, 2U);
  claim();
  submit({.owner = "cid", .key = key_of("3"), .max_queued = 2});
}

TEST_P(StoreTest, AnOwnerWithTooManyOpenJobsKeepsNobodyElseOut) {
  const JobRecord first = submit({.owner = "ann", .key = key_of("1")});
  const auto outcome_of = [&](const char* key) {
    return store_->submit({.owner = "ann", .key = key_of(key), .max_open_of_owner = 1})->outcome;
  };
  EXPECT_EQ(outcome_of("2"), SubmitOutcome::kOwnerFull);
  EXPECT_EQ(outcome_of("1"), SubmitOutcome::kOwnerFull) << "it would join its own task";
  claim();
  EXPECT_EQ(outcome_of("2"), SubmitOutcome::kOwnerFull) << "one that runs has not ended";
  submit({.owner = "bob", .key = key_of("1"), .max_open_of_owner = 1});
  ASSERT_TRUE(store_->cancel("ann", first.id));
  EXPECT_EQ(outcome_of("2"), SubmitOutcome::kAccepted);
}

TEST_P(StoreTest, WhoeverFindsAMeshNeedsNoRoomNorWhoeverJoinsATaskAPlaceInTheQueue) {
  made("kept", {"a"});
  submit("ann", "waiting");
  submit({.owner = "ann", .key = key_of("kept"), .max_queued = 0, .max_open_of_owner = 0});
  submit({.owner = "ann", .key = key_of("waiting"), .max_queued = 0});
}

TEST_P(StoreTest, CancellingTheLastJobOfATaskTakesTheTaskAlong) {
  const JobRecord job = submit("ann", "k");
  const Claim claimed = claim();
  ASSERT_EQ(store_->renew(claimed.ref, hours(1), "half"), Held::kHeld);
  const auto cancelled = store_->cancel("ann", job.id);
  ASSERT_TRUE(cancelled && *cancelled);
  EXPECT_EQ((*cancelled)->state, JobState::kCancelled);
  EXPECT_EQ((*cancelled)->attempts, 1U);
  EXPECT_EQ((*cancelled)->worker, "worker");
  EXPECT_EQ((*cancelled)->progress, "");
  EXPECT_TRUE((*cancelled)->started && (*cancelled)->ended);
  EXPECT_EQ(store_->renew(claimed.ref, hours(1), "half"), Held::kLost);
  EXPECT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kLost);
  EXPECT_FALSE(mesh("k"));
  EXPECT_EQ(get(job).state, JobState::kCancelled);
}

TEST_P(StoreTest, CancellingOneOfTwoJobsKeepsTheTask) {
  const JobRecord one = submit("ann", "k");
  const JobRecord two = submit("bob", "k");
  const Claim claimed = claim();
  ASSERT_TRUE(*store_->cancel("ann", one.id));
  EXPECT_EQ(store_->renew(claimed.ref, hours(1), ""), Held::kHeld);
  ASSERT_EQ(store_->finish(claimed.ref, put({"a"})), Held::kHeld);
  EXPECT_EQ(get(one).state, JobState::kCancelled);
  EXPECT_EQ(get(two).state, JobState::kSucceeded);
}

TEST_P(StoreTest, CancellingWhatHasEndedChangesNothing) {
  const JobRecord job = made("k", {"a"});
  const auto cancelled = store_->cancel("ann", job.id);
  EXPECT_EQ((*cancelled)->state, JobState::kSucceeded);
  EXPECT_EQ(get(job).ended, job.ended);
}

TEST_P(StoreTest, ACancelledTaskCanBeAskedForAnew) {
  const JobRecord job = submit("ann", "k");
  ASSERT_TRUE(*store_->cancel("ann", job.id));
  submit("ann", "k");
  EXPECT_EQ(claim().key, key_of("k"));
}

TEST_P(StoreTest, OnlyAJobThatHasEndedIsRemoved) {
  const JobRecord job = submit("ann", "k");
  EXPECT_EQ((*store_->remove("ann", job.id))->state, JobState::kQueued);
  claim();
  EXPECT_EQ((*store_->remove("ann", job.id))->state, JobState::kRunning);
  ASSERT_TRUE(*store_->cancel("ann", job.id));
  EXPECT_EQ((*store_->remove("ann", job.id))->state, JobState::kCancelled);
  EXPECT_FALSE(*store_->get("ann", job.id));
  EXPECT_FALSE(*store_->remove("ann", job.id));
}

TEST_P(StoreTest, ARemovedJobFreesItsRequestIdAndKeepsTheMesh) {
  const JobRecord job = submit({.owner = "ann", .request_id = "r", .key = key_of("k")});
  ASSERT_EQ(store_->finish(claim().ref, put({"a"})), Held::kHeld);
  ASSERT_TRUE(*store_->remove("ann", job.id));
  const JobRecord next = submit({.owner = "ann", .request_id = "r", .key = key_of("k")});
  EXPECT_NE(next.id, job.id);
  EXPECT_TRUE(next.from_store);
}

TEST_P(StoreTest, AListBeginsWithTheYoungestAndHoldsTheOwnersOnly) {
  std::vector<std::string> ids;
  for (int i = 0; i < 5; ++i) {
    ids.insert(ids.begin(), submit("ann", "k" + std::to_string(i)).id);
    submit("bob", "k" + std::to_string(i));
  }
  EXPECT_EQ(list({.owner = "ann"}), ids);
  EXPECT_TRUE(list({.owner = ""}).empty());
}

TEST_P(StoreTest, AListComesInPages) {
  std::vector<std::string> ids;
  for (int i = 0; i < 5; ++i) ids.insert(ids.begin(), submit("ann", std::to_string(i)).id);
  std::vector<std::string> paged;
  for (std::vector<std::string> page = list({.owner = "ann", .limit = 2}); !page.empty();
       page = list({.owner = "ann", .limit = 2, .before = page.back()})) {
    EXPECT_LE(page.size(), 2U);
    paged.insert(paged.end(), page.begin(), page.end());
  }
  EXPECT_EQ(paged, ids);
}

TEST_P(StoreTest, AListIsFilteredByState) {
  const JobRecord succeeded = made("made", {"a"});
  const JobRecord failed = submit("ann", "failed");
  ASSERT_EQ(store_->fail(claim().ref, "no"), Held::kHeld);
  const JobRecord running = submit("ann", "running");
  claim();
  const JobRecord queued = submit("ann", "queued");
  const JobRecord cancelled = submit("ann", "cancelled");
  ASSERT_TRUE(*store_->cancel("ann", cancelled.id));
  const auto only = [&](std::vector<JobState> states) {
    return list({.owner = "ann", .states = std::move(states)});
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(only({JobState::kSucceeded}), Ids{succeeded.id});
  EXPECT_EQ(only({JobState::kFailed}), Ids{failed.id});
  EXPECT_EQ(only({JobState::kRunning}), Ids{running.id});
  EXPECT_EQ(only({JobState::kQueued}), Ids{queued.id});
  EXPECT_EQ(only({JobState::kCancelled}), Ids{cancelled.id});
  EXPECT_EQ(only({JobState::kQueued, JobState::kFailed}), (Ids{queued.id, failed.id}));
  EXPECT_EQ(only({}).size(), 5U);
}

TEST_P(StoreTest, AListTellsProgressAndErrors) {
  submit("ann", "failed");
  ASSERT_EQ(store_->fail(claim().ref, "an error"), Held::kHeld);
  submit("ann", "running");
  ASSERT_EQ(store_->renew(claim().ref, hours(1), "half"), Held::kHeld);
  const auto jobs = store_->list({.owner = "ann"});
  ASSERT_EQ(jobs->size(), 2U);
  EXPECT_EQ(jobs->at(0).progress, "half");
  EXPECT_EQ(jobs->at(0).error, "");
  EXPECT_EQ(jobs->at(1).progress, "");
  EXPECT_EQ(jobs->at(1).error, "an error");
  for (const JobRecord& job : *jobs) EXPECT_EQ(job.worker, "worker");
}

TEST_P(StoreTest, AJobShowsTheBriefOfItsMeshForAsLongAsThatIsKept) {
  const JobRecord first = made("k", {"a"});
  const JobRecord found = submit("ann", "k");
  EXPECT_EQ(first.brief, "brief");
  EXPECT_EQ(found.brief, "brief");
  const auto jobs = store_->list({.owner = "ann"});
  ASSERT_EQ(jobs->size(), 2U);
  for (const JobRecord& job : *jobs) EXPECT_EQ(job.brief, "brief");
  EXPECT_EQ(store_->collect({.age = hours(1), .bytes = 0})->meshes, 1U);
  EXPECT_EQ(get(first).brief, "");
}

TEST_P(StoreTest, AJobThatDidNotSucceedShowsNoMesh) {
  const JobRecord cancelled = submit("ann", "k");
  store_->cancel("ann", cancelled.id);
  made("k", {"a"});
  const JobRecord queued = submit({.owner = "ann", .key = key_of("k"), .no_cache = true});
  EXPECT_EQ(get(cancelled).brief, "");
  EXPECT_EQ(get(queued).brief, "");
}

TEST_P(StoreTest, AJobNamesItsTaskWhileItWaitsForIt) {
  const JobRecord first = submit("ann", "k");
  const JobRecord second = submit("bob", "k");
  ASSERT_TRUE(first.task);
  EXPECT_EQ(second.task, first.task);
  ASSERT_EQ(store_->finish(claim().ref, put({"a"})), Held::kHeld);
  EXPECT_FALSE(get(first).task);
}

TEST_P(StoreTest, BeforeWhatIsNoIdThereAreNoJobs) {
  submit("ann", "k");
  EXPECT_TRUE(list({.owner = "ann", .before = std::string("\0\xff", 2)}).empty());
}

TEST_P(StoreTest, NothingIsKeptOfAKeyThatNobodyAskedFor) {
  EXPECT_FALSE(mesh("k"));
  const auto chunk = store_->chunk(sha256_of("nothing"));
  ASSERT_TRUE(chunk) << chunk.error().message;
  EXPECT_FALSE(*chunk);
}

}  // namespace
}  // namespace weft::server
