// SPDX-License-Identifier: Apache-2.0
// Servers that are killed, frozen and replaced at any moment while they make meshes: every job that
// was accepted succeeds, once, with the mesh that an undisturbed server makes.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "client/call/mesh_call.h"
#include "files/formats/domain_formats.h"
#include "tests/e2e/fleet.h"
#include "tests/e2e/programs.h"
#include "tests/support/postgres.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;

#ifdef WEFT_SANITIZED  // everything is ten times slower
constexpr int kRounds = 2;
#else
constexpr int kRounds = 8;
#endif
constexpr int kJobsARound = 4;
constexpr int kStrikes = 4;  // at one moment, on purpose

// Another process that looks into a store's file.
class SqliteFile {
 public:
  explicit SqliteFile(const std::filesystem::path& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &connection_), SQLITE_OK);
    sqlite3_busy_timeout(connection_, 60'000);
  }
  ~SqliteFile() { sqlite3_close(connection_); }
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  // The result of a statement; 0 if there is none.
  std::int64_t number(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(connection_, sql, -1, &statement, nullptr), SQLITE_OK) << sql;
    const int status = sqlite3_step(statement);
    EXPECT_TRUE(status == SQLITE_ROW || status == SQLITE_DONE) << sqlite3_errmsg(connection_);
    const std::int64_t value = status == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
    sqlite3_finalize(statement);
    return value;
  }

 private:
  sqlite3* connection_ = nullptr;
};

// Short, so that a test need not wait for long. There are as many attempts as there may be kills.
std::vector<std::string> with_store(const std::string& flag, const std::string& where) {
  return {flag, where, "--lease", "1", "--max-attempts", "100"};
}

// The moment at which the server is struck: anywhere in the life of the current jobs.
void let_work(std::mt19937_64& random) {
  std::this_thread::sleep_for(milliseconds(random() % 120));
}

TEST(JobCrash, AServerKilledAtAnyMomentLosesNoJob) {
  const Folder folder;
  const auto arguments = with_store("--data", folder / "data");
  std::mt19937_64 random(11);
  Jobs jobs(repeated_request);
  for (int round = 0; round < kRounds; ++round) {
    Server server(arguments);
    for (int i = 0; i < kJobsARound; ++i) ASSERT_TRUE(jobs.submit(server.address()));
    let_work(random);
    server.kill();
  }
  Server server(arguments);
  Reference reference;
  expect_all_well(jobs.settle(server.address(), reference), kRounds * kJobsARound);
}

TEST(JobCrash, ReplicasKilledAtAnyMomentLoseNoJob) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(12);
  std::vector<std::unique_ptr<Server>> replicas;
  for (int i = 0; i < 2; ++i) replicas.push_back(std::make_unique<Server>(arguments));
  Jobs jobs(repeated_request);
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i)
      ASSERT_TRUE(jobs.submit(replicas[random() % 2]->address()));
    let_work(random);
    auto& struck = replicas[random() % 2];
    struck->kill();
    struck = std::make_unique<Server>(arguments);
  }
  Reference reference;
  expect_all_well(jobs.settle(replicas[0]->address(), reference), kRounds * kJobsARound);
}

TEST(JobCrash, AFrozenReplicaIsFencedOffWhenItComesBack) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(13);
  Server frozen(arguments);
  Server other(arguments);
  Jobs jobs(repeated_request);
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i) ASSERT_TRUE(jobs.submit(other.address()));
    let_work(random);
    frozen.freeze();
    // Past its lease: what it held is another's then.
    std::this_thread::sleep_for(milliseconds(round % 4 == 0 ? 1500 : 50));
    frozen.thaw();
  }
  Reference reference;
  expect_all_well(jobs.settle(frozen.address(), reference), kRounds * kJobsARound);
}

TEST(JobCrash, ADatabaseThatRestartsLosesNoJob) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(14);
  Server server(arguments);
  Jobs jobs(repeated_request);
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i)
      while (!jobs.submit(server.address())) continue;
    let_work(random);
    if (round % 2 == 0) {
      postgres.kill();
      postgres.start();
    } else {
      postgres.restart();
    }
  }
  Reference reference;
  expect_all_well(jobs.settle(server.address(), reference), kRounds * kJobsARound);
}

TEST(JobCrash, EitherReplicaMayDieAtAnyTimeUntilAQueueIsDone) {
  const int count = few_or_many(24, 200);
  constexpr milliseconds kLongest{450};  // between two kills
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::vector<std::unique_ptr<Server>> replicas;
  for (int i = 0; i < 2; ++i) replicas.push_back(std::make_unique<Server>(arguments));
  Jobs jobs(mixed_request);
  std::atomic<bool> done{false};
  int kills = 0;
  std::thread killer([&] {
    std::mt19937_64 random(15);
    int ended = 0;
    for (milliseconds longest = kLongest; !done;) {
      std::this_thread::sleep_for(longest * (random() % 100) / 100);
      Server& struck = *replicas[random() % 2];
      struck.kill();
      struck.start();
      ++kills;
      // As long as no job ends between two kills, the pauses grow: a slow machine makes some, too.
      const int before = std::exchange(ended, jobs.ended(struck.address()).value_or(ended));
      longest = ended > before ? kLongest : 2 * longest;
    }
  });
  for (int i = 0; i < count; ++i)
    while (!jobs.submit(replicas[static_cast<std::size_t>(i) % 2]->address())) continue;
  while (jobs.ended(replicas[0]->address()) != count) std::this_thread::sleep_for(milliseconds(20));
  done = true;
  killer.join();
  std::printf("%d kills\n", kills);
  EXPECT_GT(kills, 0);
  Reference reference;
  expect_all_well(jobs.settle(replicas[1]->address(), reference), count);
}

// The database holds the last transaction back when all of it is done except the commit.
TEST(JobCrash, AReplicaKilledBetweenTheLastChunkAndTheCommitLosesNoJob) {
  PostgresServer postgres;
  const std::string uri = postgres.new_database();
  const auto arguments = with_store("--store", uri);
  const std::string waiting =
      "SELECT count(*) FROM pg_locks WHERE NOT granted AND relation = 'weft_settled'::regclass";
  Jobs jobs(mixed_request);
  for (int round = 0; round < kStrikes; ++round) {
    Server server(arguments);
    PostgresSession lock(uri);
    lock.run("BEGIN");
    lock.run("LOCK TABLE weft_settled IN SHARE ROW EXCLUSIVE MODE");
    ASSERT_TRUE(jobs.submit(server.address()));
    PostgresSession look(uri);
    while (look.run(waiting) == "0") std::this_thread::sleep_for(milliseconds(2));
    EXPECT_NE(look.run("SELECT count(*) FROM weft_chunk"), "0");
    server.kill();
    lock.run("ROLLBACK");
  }
  Server server(arguments);
  Reference reference;
  const Tally tally = jobs.settle(server.address(), reference);
  expect_all_well(tally, kStrikes);
  EXPECT_GE(tally.attempts, 2 * kStrikes) << "each was struck in its first attempt";
}

// Of 1 M triangles, or of 94 M.
v1::GenerateMeshRequest large_request(int /*number*/) {
  static const auto domain = files::read_domain(model("cylinder.poly")).value();
  const std::string triangles = std::to_string(few_or_many(1'600'000, 150'000'000));
  client::RequestOptions options;
  options.size = "((x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1200 : 1e4) / " + triangles;
  return client::make_request(domain, options);
}

TEST(JobCrash, AReplicaKilledInTheMiddleOfALargeMeshIsReplacedByAnother) {
  PostgresServer postgres;
  const std::string uri = postgres.new_database();
  const auto arguments = with_store("--store", uri);
  Reference reference;
  const v1::Summary expected = reference.summary(large_request(0));
  Jobs jobs(large_request);
  PostgresSession look(uri);
  Server killed(arguments);
  ASSERT_TRUE(jobs.submit(killed.address()));
  const auto chunks = [&] { return std::stoul(look.run("SELECT count(*) FROM weft_chunk")); };
  while (chunks() < expected.chunks() / 2) std::this_thread::sleep_for(milliseconds(2));
  killed.kill();
  const std::size_t stored = chunks();
  Server other(arguments);
  expect_all_well(jobs.settle(other.address(), reference), 1);
  std::printf("%lu triangles: killed at chunk %zu of %u; the other took %.0f MiB\n",
              expected.triangles(), stored, expected.chunks(),
              static_cast<double>(other.peak_bytes()) / (1 << 20));
}

// The test holds the file's lock for writing from the moment when the last chunk is there.
TEST(JobCrash, AServerKilledBetweenTheLastChunkAndTheCommitLosesNoJob) {
  const Folder folder;
  const auto arguments = with_store("--data", folder / "data");
  Reference reference;
  Jobs jobs(mixed_request);
  constexpr const char* kLastTask =
      "SELECT count(*) FROM task WHERE id = (SELECT seq FROM sqlite_sequence WHERE name = 'task')";
  constexpr const char* kChunks = "SELECT count(*) FROM chunk";
  int struck = 0;
  int submitted = 0;
  for (; struck < kStrikes && submitted < 50 * kStrikes; ++submitted) {
    Server server(arguments);
    const SqliteFile file(folder / "data/weft.db");
    const v1::GenerateMeshRequest request = mixed_request(submitted);
    const std::int64_t all = file.number(kChunks) + reference.summary(request).chunks();
    ASSERT_TRUE(jobs.submit(server.address()));
    // A mesh that shares a chunk with another one ends before all of them are new.
    while (file.number(kChunks) < all && file.number(kLastTask) != 0) std::this_thread::yield();
    file.number("BEGIN IMMEDIATE");
    struck += file.number(kLastTask) != 0;
    server.kill();
  }
  std::printf("%d of %d were struck before the commit\n", struck, submitted);
  EXPECT_EQ(struck, kStrikes);
  Server server(arguments);
  const Tally tally = jobs.settle(server.address(), reference);
  expect_all_well(tally, submitted);
  EXPECT_GE(tally.attempts, submitted + struck);
}

}  // namespace
}  // namespace weft::e2e
