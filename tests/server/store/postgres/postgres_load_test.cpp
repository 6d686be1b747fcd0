// SPDX-License-Identifier: Apache-2.0
// Several servers at work on one database that is restarted and killed under them.
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "server/store/postgres/postgres_store.h"
#include "tests/server/store/store_test.h"
#include "tests/support/event.h"
#include "tests/support/postgres.h"

namespace weft::server {
namespace {

constexpr int kServers = 2;
constexpr int kJobsPerServer = 60;

// One server: submits, works and keeps house on threads of its own.
class BusyServer {
 public:
  BusyServer(const std::string& uri, int number) : number_(number) {
    auto opened = PostgresStore::open({.uri = uri, .connections = 3});
    if (!opened) throw std::runtime_error(opened.error().message);
    store_ = std::move(*opened);
    threads_.emplace_back([this] { submit_all(); });
    for (int i = 0; i < 2; ++i) threads_.emplace_back([this] { work(); });
    threads_.emplace_back([this] { reap(); });
  }
  ~BusyServer() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BusyServer(const BusyServer&) = delete;
  BusyServer& operator=(const BusyServer&) = delete;

  std::string owner() const { return "owner " + std::to_string(number_); }
  bool all_submitted() const { return submitted_ == kJobsPerServer; }
  int finished() const { return finished_; }
  JobStore& store() { return *store_; }
  // By task: the attempts that were told that they have settled it.
  std::map<std::int64_t, std::set<std::uint32_t>> settled() {
    const std::lock_guard lock(mutex_);
    return settled_;
  }

 private:
  static void breathe() { std::this_thread::sleep_for(milliseconds(5)); }

  void submit_all() {
    while (!stopping_ && submitted_ < kJobsPerServer) {
      const std::string name = std::to_string(submitted_);
      const Submission submission{
          .owner = owner(), .request_id = name, .key = key_of(owner() + name), .request = name};
      const auto done = store_->submit(submission);
      if (done) {
        EXPECT_TRUE(done->outcome == SubmitOutcome::kAccepted ||
                    done->outcome == SubmitOutcome::kFound);
        ++submitted_;
      }
      breathe();
    }
  }

  void work() {
    while (!stopping_) {
      const auto claimed = store_->claim(owner(), milliseconds(500), ~std::uint64_t{0});
      if (claimed && *claimed) {
        make(**claimed);
      } else {
        breathe();
      }
    }
  }

  void make(const Claim& claim) {
    const std::string chunk = "chunk of " + claim.key;
    const StoredMesh mesh{.summary = "", .brief = {}, .chunks = {{sha256_of(chunk), chunk.size()}}};
    while (!stopping_) {
      // A database that was killed may have forgotten a chunk that it had taken: so again and
      // again.
      if (store_->put_chunk(mesh.chunks[0].sha256, chunk)) {
        const auto held = store_->finish(claim.ref, mesh);
        if (held) {
          if (*held == Held::kLost) return;
          const std::lock_guard lock(mutex_);
          settled_[claim.ref.task].insert(claim.ref.attempt);
          ++finished_;
          return;
        }
      }
      breathe();
    }
  }

  void reap() {
    while (!stopping_) {
      (void)store_->reap(
          {.max_attempts = 1'000'000, .first_delay = milliseconds(0), .error = "lost"});
      breathe();
    }
  }

  const int number_;
  std::unique_ptr<JobStore> store_;
  std::atomic<bool> stopping_ = false;
  std::atomic<int> submitted_ = 0;
  std::atomic<int> finished_ = 0;
  std::mutex mutex_;  // guards the one below
  std::map<std::int64_t, std::set<std::uint32_t>> settled_;
  std::vector<std::thread> threads_;
};

bool wait_until(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return true;
}

TEST(PostgresLoad, NothingIsLostOrDoubledWhenTheDatabaseIsRestartedAndKilled) {
  const std::string uri = postgres_server().new_database();
  {
    std::vector<std::unique_ptr<BusyServer>> servers;
    for (int i = 0; i < kServers; ++i) servers.push_back(std::make_unique<BusyServer>(uri, i));
    const auto finished = [&] {
      int all = 0;
      for (const auto& server : servers) all += server->finished();
      return all;
    };
    for (int round = 0; round < 4; ++round) {
      const int before = finished();
      ASSERT_TRUE(wait_until([&] { return finished() >= before + 10; })) << "in round " << round;
      round % 2 == 0 ? postgres_server().stop() : postgres_server().kill();
      postgres_server().start();
    }
    const auto all_succeeded = [](BusyServer& server) {
      const auto jobs = server.store().list(
          {.owner = server.owner(), .states = {JobState::kSucceeded}, .limit = 1000});
      return jobs && jobs->size() == kJobsPerServer;
    };
    std::map<std::int64_t, std::set<std::uint32_t>> settled;
    for (const auto& server : servers) {
      EXPECT_TRUE(wait_until([&] { return server->all_submitted(); }));
      EXPECT_TRUE(wait_until([&] { return all_succeeded(*server); })) << "a job is lost";
      const auto jobs = server->store().list({.owner = server->owner(), .limit = 1000});
      EXPECT_EQ(jobs->size(), kJobsPerServer) << "a job is doubled";
    }
    for (const auto& server : servers) {
      for (const auto& [task, attempts] : server->settled()) {
        settled[task].insert(attempts.begin(), attempts.end());
      }
    }
    for (const auto& [task, attempts] : settled) {
      EXPECT_EQ(attempts.size(), 1U) << "task " << task << " was settled twice";
    }
  }
  postgres_server().drop_database(uri);
}

}  // namespace
}  // namespace weft::server
