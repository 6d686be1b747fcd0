// SPDX-License-Identifier: Apache-2.0
// What only the store in a database does: several servers on it, and connections that break.
#include "server/store/postgres/postgres_store.h"

#include <atomic>
#include <thread>

#include "server/store/postgres/postgres.h"
#include "tests/server/store/cutting_proxy.h"
#include "tests/server/store/store_test.h"
#include "tests/support/event.h"
#include "tests/support/postgres.h"

namespace weft::server {
namespace {

class PostgresTest : public testing::Test {
 protected:
  PostgresTest() : uri_(postgres_server().new_database()) {}
  ~PostgresTest() override { postgres_server().drop_database(uri_); }

  static std::unique_ptr<JobStore> open(PostgresStore::Options options) {
    auto opened = PostgresStore::open(std::move(options));
    if (opened) return std::move(*opened);
    ADD_FAILURE() << opened.error().message;
    return nullptr;
  }
  std::unique_ptr<JobStore> open() const { return open({.uri = uri_}); }

  static std::size_t count_jobs(JobStore& store) {
    return store.list({.owner = "ann", .limit = 1000})->size();
  }

  const std::string uri_;
};

TEST_F(PostgresTest, ADatabaseOfANewerVersionIsRefused) {
  open();
  postgres_server().execute(uri_, "INSERT INTO weft_schema (version) VALUES (99)");
  const auto opened = PostgresStore::open({.uri = uri_});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, StoreErrorKind::kBroken);
  EXPECT_EQ(opened.error().message, "the database is of version 99; this weftd knows none after 5");
}

TEST_F(PostgresTest, ADatabaseOfVersion1KeepsItsJobsAndMeshes) {
  std::string id;
  {
    const auto store = open();
    id = store->submit({.owner = "ann", .key = key_of("k")})->job.id;
    const Claim claim = store->claim("worker", hours(1), 1)->value();
    ASSERT_EQ(store->finish(claim.ref, {.summary = "all of it", .brief = "", .chunks = {}}),
              Held::kHeld);
    store->submit({.owner = "ann", .key = key_of("other"), .request = "make it"});
  }
  postgres_server().execute(uri_,
                            "DROP VIEW weft_job_now; DROP INDEX weft_job_open;"
                            "ALTER TABLE weft_job DROP COLUMN callback_url, "
                            "DROP COLUMN callback_place, DROP COLUMN callback_state, "
                            "DROP COLUMN callback_attempts, DROP COLUMN callback_error, "
                            "DROP COLUMN callback_due;"
                            "ALTER TABLE weft_mesh DROP COLUMN brief, DROP COLUMN owner;"
                            "ALTER TABLE weft_task DROP COLUMN trace, DROP COLUMN max_bytes, "
                            "DROP COLUMN max_micros;"
                            "DELETE FROM weft_schema WHERE version > 1");
  const auto store = open();
  ASSERT_TRUE(store);
  EXPECT_EQ(store->mesh(key_of("k")).value()->summary, "all of it");
  EXPECT_EQ(store->get("ann", id).value()->brief, "all of it");
  EXPECT_EQ(store->claim("worker", hours(1), 1).value()->request, "make it");
}

TEST_F(PostgresTest, ADatabaseThatIsNotThereIsUnavailable) {
  const auto opened = PostgresStore::open({.uri = "postgres:///weft?host=/nowhere"});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_NE(opened.error().message.find("/nowhere"), std::string::npos);
}

TEST_F(PostgresTest, SeveralServersMayBeginOnAnEmptyDatabase) {
  std::vector<std::thread> threads;
  std::vector<std::unique_ptr<JobStore>> stores(6);
  for (auto& store : stores) threads.emplace_back([&] { store = open(); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& store : stores) {
    ASSERT_TRUE(store);
    EXPECT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
  }
  EXPECT_EQ(stores[0]->stats()->queued, 1U);
}

TEST_F(PostgresTest, WhatOneServerAcceptsAnotherMakesAndAThirdReads) {
  const auto accepting = open();
  const auto working = open();
  const auto reading = open();
  const auto job = accepting->submit({.owner = "ann", .key = key_of("k"), .request = "r"});
  const auto claimed = working->claim("worker", hours(1), 1);
  ASSERT_TRUE(claimed && *claimed);
  ASSERT_TRUE(working->put_chunk(sha256_of("a"), "a"));
  ASSERT_EQ(working->finish((*claimed)->ref,
                            {.summary = "s", .brief = {}, .chunks = {{sha256_of("a"), 1}}}),
            Held::kHeld);
  EXPECT_EQ((*reading->get("ann", job->job.id))->state, JobState::kSucceeded);
  EXPECT_EQ((*reading->mesh(key_of("k")))->summary, "s");
  EXPECT_EQ(*reading->chunk(sha256_of("a")), "a");
}

TEST_F(PostgresTest, AChangeIsHeardByTheOtherServers) {
  const auto here = open();
  const auto there = open();
  Event heard;
  there->on_change([&] { heard.set(); });
  ASSERT_TRUE(here->submit({.owner = "ann", .key = key_of("k")}));
  EXPECT_TRUE(heard.wait());
}

TEST_F(PostgresTest, ChangesAreHeardAgainAfterTheDatabaseWasRestarted) {
  const auto here = open();
  const auto there = open();
  std::atomic<int> heard = 0;
  there->on_change([&] { ++heard; });
  postgres_server().restart();
  const auto end = std::chrono::steady_clock::now() + kPatience;
  // One more than the call that says that it listens again.
  for (int i = 0; heard < 2 && std::chrono::steady_clock::now() < end; ++i) {
    (void)here->submit({.owner = "ann", .key = key_of(std::to_string(i))});
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_GE(heard, 2);
}

TEST_F(PostgresTest, AnIdleConnectionThatWasCutIsReplacedUnnoticed) {
  const auto store = open();
  ASSERT_TRUE(store->submit({.owner = "ann", .key = key_of("1")}));
  postgres_server().restart();
  const auto submitted = store->submit({.owner = "ann", .key = key_of("2")});
  ASSERT_TRUE(submitted) << submitted.error().message;
  const auto claimed = store->claim("worker", hours(1), 1);
  ASSERT_TRUE(claimed) << claimed.error().message;
  EXPECT_EQ((*claimed)->key, key_of("1"));
}

TEST_F(PostgresTest, NoAnswerIsForgottenWhenTheDatabaseIsKilled) {
  const auto store = open();
  const auto kill = [] {
    postgres_server().kill();
    postgres_server().start();
  };
  const auto job = store->submit({.owner = "ann", .key = key_of("k")});
  kill();
  const auto claimed = store->claim("worker", hours(1), 1);
  ASSERT_TRUE(claimed && *claimed) << "the submission is forgotten";
  kill();
  EXPECT_EQ(store->renew((*claimed)->ref, hours(1), ""), Held::kHeld) << "it would be given twice";
  ASSERT_EQ(store->finish((*claimed)->ref, {.summary = "s", .brief = {}, .chunks = {}}),
            Held::kHeld);
  kill();
  EXPECT_EQ((*store->get("ann", job->job.id))->state, JobState::kSucceeded);
}

TEST_F(PostgresTest, CallsAreUnavailableWhileTheDatabaseIsDown) {
  const auto store = open();
  const auto job = store->submit({.owner = "ann", .key = key_of("k")});
  postgres_server().stop();
  const auto found = store->get("ann", job->job.id);
  const auto submitted = store->submit({.owner = "ann", .key = key_of("k")});
  postgres_server().start();
  ASSERT_FALSE(found || submitted);
  EXPECT_EQ(found.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_EQ(submitted.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_TRUE(*store->get("ann", job->job.id));
  EXPECT_EQ(count_jobs(*store), 1U);
}

TEST_F(PostgresTest, OneConnectionServesManyThreads) {
  const auto store = open({.uri = uri_, .connections = 1});
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 10; ++k) {
        const auto submitted =
            store->submit({.owner = "ann", .key = key_of(std::to_string(10 * i + k))});
        EXPECT_TRUE(submitted) << submitted.error().message;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(count_jobs(*store), 80U);
}

TEST_F(PostgresTest, AStatementThatWaitsTooLongIsGivenUp) {
  const auto store = open({.uri = uri_, .statement_timeout = seconds(1)});
  auto blocking = postgres::Connection::open({.uri = uri_});
  ASSERT_TRUE((*blocking)->execute("BEGIN; LOCK TABLE weft_task"));
  const auto submitted = store->submit({.owner = "ann", .key = key_of("k")});
  ASSERT_FALSE(submitted);
  EXPECT_EQ(submitted.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_NE(submitted.error().message.find("57014"), std::string::npos)
      << "it is the database that gives it up: " << submitted.error().message;
  ASSERT_TRUE((*blocking)->execute("ROLLBACK"));
  EXPECT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
}

TEST_F(PostgresTest, ADatabaseThatDoesNotAnswerIsGivenUp) {
  const auto store =
      open({.uri = uri_, .connect_timeout = seconds(2), .statement_timeout = milliseconds(200)});
  postgres_server().freeze();
  const auto stats = store->stats();
  postgres_server().thaw();
  ASSERT_FALSE(stats);
  EXPECT_EQ(stats.error().kind, StoreErrorKind::kUnavailable);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!store->stats() && std::chrono::steady_clock::now() < end) {
  }
  EXPECT_TRUE(store->stats());
}

TEST_F(PostgresTest, ASubmissionWhoseAnswerWasLostIsAcceptedOnce) {
  CuttingProxy proxy(uri_);
  const auto store = open({.uri = proxy.uri()});
  proxy.cut(1);
  const auto submitted = store->submit({.owner = "ann", .key = key_of("k"), .no_cache = true});
  ASSERT_TRUE(submitted) << submitted.error().message;
  EXPECT_EQ(submitted->outcome, SubmitOutcome::kAccepted);
  EXPECT_EQ(count_jobs(*store), 1U);
  EXPECT_EQ(store->stats()->queued, 1U);
  EXPECT_TRUE(*store->get("ann", submitted->job.id));
}

TEST_F(PostgresTest, ASubmissionThatFailedTwiceIsFoundByItsRequestId) {
  CuttingProxy proxy(uri_);
  const auto store = open({.uri = proxy.uri()});
  const Submission submission{.owner = "ann", .request_id = "r", .key = key_of("k")};
  proxy.cut(2);
  const auto unclear = store->submit(submission);
  ASSERT_FALSE(unclear);
  EXPECT_EQ(unclear.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_EQ(store->submit(submission)->outcome, SubmitOutcome::kFound);
  EXPECT_EQ(count_jobs(*store), 1U);
}

TEST_F(PostgresTest, AFinishWhoseAnswerWasLostIsHeld) {
  CuttingProxy proxy(uri_);
  const auto store = open({.uri = proxy.uri()});
  const auto job = store->submit({.owner = "ann", .key = key_of("k")});
  const ClaimRef claimed = (*store->claim("worker", hours(1), 1))->ref;
  proxy.cut(1);
  EXPECT_EQ(store->finish(claimed, {.summary = "s", .brief = {}, .chunks = {}}), Held::kHeld);
  EXPECT_EQ((*store->get("ann", job->job.id))->state, JobState::kSucceeded);
}

TEST_F(PostgresTest, AFinishThatFailedTwiceIsHeldTheNextTime) {
  CuttingProxy proxy(uri_);
  const auto store = open({.uri = proxy.uri()});
  ASSERT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
  const ClaimRef claimed = (*store->claim("worker", hours(1), 1))->ref;
  proxy.cut(2);
  EXPECT_EQ(store->finish(claimed, {.summary = "s", .brief = {}, .chunks = {}}).error().kind,
            StoreErrorKind::kUnavailable);
  EXPECT_EQ(store->finish(claimed, {.summary = "s", .brief = {}, .chunks = {}}), Held::kHeld);
}

TEST_F(PostgresTest, AClaimWhoseAnswerWasLostComesBackByItsLease) {
  CuttingProxy proxy(uri_);
  const auto store = open({.uri = proxy.uri()});
  ASSERT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
  ASSERT_TRUE(store->submit({.owner = "ann", .key = key_of("other")}));
  proxy.cut(1);
  const auto unclear = store->claim("worker", milliseconds(0), 1);
  ASSERT_FALSE(unclear) << "a second one would have been taken as well";
  EXPECT_EQ(unclear.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_EQ(store->reap({.first_delay = milliseconds(0), .error = ""})->requeued, 1U);
  const auto claimed = store->claim("worker", hours(1), 1);
  EXPECT_EQ((*claimed)->key, key_of("k"));
  EXPECT_EQ((*claimed)->ref.attempt, 2U);
}

}  // namespace
}  // namespace weft::server
