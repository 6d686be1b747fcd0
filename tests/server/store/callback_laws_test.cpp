// SPDX-License-Identifier: Apache-2.0
// The laws of a store about callbacks: none is lost, and one claim at a time is valid.
#include <set>
#include <thread>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

constexpr milliseconds kNoDelay{0};

Submission with_callback(const std::string& owner, const std::string& key_name,
                         const std::string& place = "a:80") {
  return {.owner = owner,
          .key = key_of(key_name),
          .callback = {.url = "http://" + place + "/hook", .place = place}};
}

std::optional<JobRecord> claim_callback(JobStore& store,
                                        const std::vector<std::string>& except_owners = {},
                                        const std::vector<std::string>& except_places = {}) {
  const auto claimed = store.claim_callback(minutes(1), except_owners, except_places);
  if (!claimed) {
    ADD_FAILURE() << claimed.error().message;
    return std::nullopt;
  }
  return *claimed;
}

TEST_P(StoreTest, ACallbackIsClaimedOnceItsJobHasEnded) {
  const JobRecord job = submit(with_callback("ann", "k"));
  EXPECT_EQ(job.callback.url, "http://a:80/hook");
  EXPECT_EQ(job.callback.state, CallbackState::kPending);
  EXPECT_FALSE(claim_callback(*store_));
  const Claim work = claim();
  EXPECT_FALSE(claim_callback(*store_));
  ASSERT_EQ(store_->finish(work.ref, put({"a"})), Held::kHeld);
  const auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  EXPECT_EQ(claimed->id, job.id);
  EXPECT_EQ(claimed->owner, "ann");
  EXPECT_EQ(claimed->state, JobState::kSucceeded);
  EXPECT_EQ(claimed->brief, "brief");
  EXPECT_EQ(claimed->callback.attempts, 1U);
  EXPECT_FALSE(claim_callback(*store_));
}

TEST_P(StoreTest, EveryEndOfAJobHasItsCallback) {
  made("kept", {"a"});
  std::set<std::string> ended{submit(with_callback("ann", "kept")).id};
  const JobRecord failed = submit(with_callback("ann", "failed"));
  ASSERT_EQ(store_->fail(claim().ref, "error"), Held::kHeld);
  ended.insert(failed.id);
  const JobRecord cancelled = submit(with_callback("ann", "cancelled"));
  ASSERT_TRUE(*store_->cancel("ann", cancelled.id));
  ended.insert(cancelled.id);
  const JobRecord lost = submit(with_callback("ann", "lost"));
  claim(milliseconds(1));
  backend_->pass(minutes(1));
  ASSERT_EQ(reap(1).failed, 1U);
  ended.insert(lost.id);
  submit("ann", "kept");  // without one
  std::set<std::string> told;
  while (const auto claimed = claim_callback(*store_)) told.insert(claimed->id);
  EXPECT_EQ(told, ended);
}

TEST_P(StoreTest, ASettledCallbackIsClaimedNoMore) {
  made("k", {"a"});
  const JobRecord delivered = submit(with_callback("ann", "k"));
  auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  EXPECT_EQ(store_->settle_callback(*claimed, CallbackState::kDelivered, "", kNoDelay),
            Held::kHeld);
  EXPECT_EQ(get(delivered).callback.state, CallbackState::kDelivered);
  const JobRecord failed = submit(with_callback("ann", "k"));
  claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  EXPECT_EQ(claimed->id, failed.id);
  EXPECT_EQ(store_->settle_callback(*claimed, CallbackState::kFailed, "no", kNoDelay), Held::kHeld);
  EXPECT_EQ(get(failed).callback.error, "no");
  backend_->pass(hours(48));
  EXPECT_FALSE(claim_callback(*store_));
}

TEST_P(StoreTest, ACallbackThatFailedIsDueAfterItsDelay) {
  made("k", {"a"});
  const JobRecord job = submit(with_callback("ann", "k"));
  auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  ASSERT_EQ(store_->settle_callback(*claimed, CallbackState::kPending, "status 500", minutes(10)),
            Held::kHeld);
  EXPECT_EQ(get(job).callback.error, "status 500");
  EXPECT_FALSE(claim_callback(*store_));
  reopen();
  EXPECT_FALSE(claim_callback(*store_));
  backend_->pass(minutes(11));
  claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  EXPECT_EQ(claimed->callback.attempts, 2U);
}

TEST_P(StoreTest, ACallbackWhoseLeaseRanOutIsClaimedAgain) {
  made("k", {"a"});
  const JobRecord job = submit(with_callback("ann", "k"));
  const auto first = claim_callback(*store_);
  ASSERT_TRUE(first);
  backend_->pass(minutes(2));
  const auto second = claim_callback(*store_);
  ASSERT_TRUE(second);
  EXPECT_EQ(store_->settle_callback(*first, CallbackState::kDelivered, "", kNoDelay), Held::kLost);
  EXPECT_EQ(get(job).callback.state, CallbackState::kClaimed);
  EXPECT_EQ(store_->settle_callback(*second, CallbackState::kDelivered, "", kNoDelay), Held::kHeld);
  EXPECT_EQ(store_->settle_callback(*second, CallbackState::kFailed, "", kNoDelay), Held::kLost);
}

TEST_P(StoreTest, TheCallbackThatIsDueForLongestIsClaimedFirst) {
  made("k", {"a"});
  std::vector<std::string> ids;
  for (int i = 0; i < 5; ++i) {
    ids.push_back(submit(with_callback("ann", "k")).id);
    backend_->pass(seconds(1));
  }
  for (const std::string& id : ids) EXPECT_EQ(claim_callback(*store_)->id, id);
}

TEST_P(StoreTest, ACallbackIsDueWithinTheLongestDelayWhateverIsAskedFor) {
  made("k", {"a"});
  submit(with_callback("ann", "k"));
  ASSERT_TRUE((*store_->claim_callback(hours(100), {}, {})).has_value());
  backend_->pass(kLongestCallbackDelay + seconds(1));
  const auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  ASSERT_EQ(store_->settle_callback(*claimed, CallbackState::kPending, "", hours(100)),
            Held::kHeld);
  backend_->pass(kLongestCallbackDelay + seconds(1));
  EXPECT_TRUE(claim_callback(*store_));
}

TEST_P(StoreTest, CallbacksOfSomeOwnersAndToSomePlacesMayBeLeftOut) {
  made("k", {"a"});
  const JobRecord anns = submit(with_callback("ann", "k", "slow:80"));
  const JobRecord bobs = submit(with_callback("bob", "k", "quick:80"));
  EXPECT_FALSE(claim_callback(*store_, {"ann", "bob"}));
  EXPECT_FALSE(claim_callback(*store_, {"bob"}, {"slow:80"}));
  EXPECT_EQ(claim_callback(*store_, {}, {"slow:80"})->id, bobs.id);
  EXPECT_EQ(claim_callback(*store_, {"bob"}, {"quick:80"})->id, anns.id);
}

TEST_P(StoreTest, AnOwnersCallbacksAreBounded) {
  made("k", {"a"});
  Submission one = with_callback("ann", "k");
  one.max_callbacks_of_owner = 2;
  submit(one);
  submit(one);
  EXPECT_EQ(store_->submit(one)->outcome, SubmitOutcome::kCallbacksFull);
  Submission others = one;
  others.owner = "bob";
  submit(others);
  submit("ann", "k");  // without one
  const auto claimed = claim_callback(*store_, {"bob"});
  ASSERT_TRUE(claimed);
  EXPECT_EQ(store_->submit(one)->outcome, SubmitOutcome::kCallbacksFull);
  ASSERT_EQ(store_->settle_callback(*claimed, CallbackState::kDelivered, "", kNoDelay),
            Held::kHeld);
  submit(one);
}

TEST_P(StoreTest, JobsAreNotCollectedBeforeTheirCallbacks) {
  made("k", {"a"});
  const JobRecord job = submit(with_callback("ann", "k"));
  backend_->pass(hours(2));
  const KeepPolicy nothing{.age = seconds(1), .bytes = 0, .jobs_of_owner = 0};
  ASSERT_TRUE(store_->collect(nothing));
  EXPECT_EQ(list({.owner = "ann"}), std::vector<std::string>{job.id});
  const auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  ASSERT_TRUE(store_->collect(nothing));
  EXPECT_EQ(list({.owner = "ann"}), std::vector<std::string>{job.id});
  ASSERT_EQ(store_->settle_callback(*claimed, CallbackState::kFailed, "no", kNoDelay), Held::kHeld);
  ASSERT_TRUE(store_->collect(nothing));
  EXPECT_TRUE(list({.owner = "ann"}).empty());
}

TEST_P(StoreTest, ARemovedJobHasNoCallback) {
  made("k", {"a"});
  const JobRecord job = submit(with_callback("ann", "k"));
  const auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  ASSERT_TRUE(*store_->remove("ann", job.id));
  EXPECT_EQ(store_->settle_callback(*claimed, CallbackState::kPending, "", kNoDelay), Held::kLost);
  backend_->pass(hours(2));
  EXPECT_FALSE(claim_callback(*store_));
}

TEST_P(StoreTest, ACallbackOfAClockThatWasSetBackIsDueWithinTheLongestDelay) {
  made("k", {"a"});
  submit(with_callback("ann", "k"));
  const auto claimed = claim_callback(*store_);
  ASSERT_TRUE(claimed);
  ASSERT_EQ(store_->settle_callback(*claimed, CallbackState::kPending, "", minutes(1)),
            Held::kHeld);
  backend_->pass(-hours(1000));
  reap();
  backend_->pass(kLongestCallbackDelay + seconds(1));
  EXPECT_TRUE(claim_callback(*store_));
}

TEST_P(StoreTest, SeveralThatClaimAtOnceNeverGetTheSame) {
  constexpr std::size_t kJobs = 40;
  made("k", {"a"});
  for (std::size_t i = 0; i < kJobs; ++i) submit(with_callback("ann", "k"));
  std::vector<std::vector<std::string>> claimed(4);
  std::vector<std::thread> threads;
  for (auto& mine : claimed)
    threads.emplace_back([&] {
      while (const auto job = claim_callback(*store_)) mine.push_back(job->id);
    });
  for (std::thread& thread : threads) thread.join();
  std::multiset<std::string> all;
  for (const auto& mine : claimed) all.insert(mine.begin(), mine.end());
  EXPECT_EQ(all.size(), kJobs);
  EXPECT_EQ(std::set(all.begin(), all.end()).size(), kJobs);
}

}  // namespace
}  // namespace weft::server
