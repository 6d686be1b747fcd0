// SPDX-License-Identifier: Apache-2.0
// The laws of a store whose server is killed in the middle of whatever it does.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <random>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

constexpr int kKeys = 12;

// What a server says to its parent of each call that was answered.
struct Answer {
  char id[26];
  JobState state;
};

// A server as its children run it: does what comes to its mind until it is killed.
class Restless {
 public:
  Restless(JobStore& store, unsigned seed, int answers)
      : store_(store), random_(seed), answers_(answers) {}

  [[noreturn]] void run() {
    while (true) {
      const std::string owner(1, static_cast<char>('a' + below(3)));
      const std::string name = std::to_string(below(kKeys));
      switch (below(6)) {
        case 0:
        case 1:
          submit({.owner = owner, .key = key_of(name), .no_cache = below(3) == 0});
          break;
        case 2:
          cancel(owner);
          break;
        case 3:
          (void)store_.reap({.first_delay = milliseconds(0), .error = "lost"});
          break;
        default:
          work(name);
      }
    }
  }

 private:
  int below(int bound) { return std::uniform_int_distribution<>(0, bound - 1)(random_); }

  void say(const JobRecord& job) {
    Answer answer{};
    job.id.copy(answer.id, sizeof answer.id);
    answer.state = job.state;
    if (write(answers_, &answer, sizeof answer) != sizeof answer) _exit(1);
  }

  void submit(const Submission& submission) {
    const auto submitted = store_.submit(submission);
    if (submitted) say(submitted->job);
  }

  void cancel(const std::string& owner) {
    const auto jobs = store_.list({.owner = owner, .states = {JobState::kQueued}, .limit = 1});
    if (!jobs || jobs->empty()) return;
    const auto cancelled = store_.cancel(owner, jobs->front().id);
    if (cancelled && *cancelled) say(**cancelled);
  }

  void work(const std::string& name) {
    const auto claimed = store_.claim("worker", milliseconds(below(2) * 60'000), ~std::uint64_t{0});
    if (!claimed || !*claimed) return;
    const ClaimRef ref = (*claimed)->ref;
    StoredMesh mesh{.summary = name, .brief = {}, .chunks = {}};
    for (int i = 0; i < 3; ++i) {
      const std::string chunk(static_cast<std::size_t>(1 + below(30'000)), name[0]);
      mesh.chunks.push_back({sha256_of(chunk), chunk.size()});
      if (!store_.put_chunk(mesh.chunks.back().sha256, chunk)) return;
    }
    if (below(5) == 0) {
      (void)store_.release(ref, milliseconds(0), below(2) == 0);
      return;
    }
    const bool fails = below(5) == 0;
    const auto held = fails ? store_.fail(ref, "no") : store_.finish(ref, mesh);
    if (!held || *held == Held::kLost) return;
    const auto job = store_.get((*claimed)->owner, (*claimed)->job_id);
    if (job && *job) say(**job);
  }

  JobStore& store_;
  std::mt19937 random_;
  const int answers_;
};

class CrashTest : public StoreTest {
 protected:
  void TearDown() override {
    if (child_ > 0) kill_child();
  }

  // Runs a server in a process of its own, kills it after so many answers, and remembers them.
  void run_and_kill(unsigned seed, int answers) {
    store_.reset();
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    child_ = fork();
    ASSERT_GE(child_, 0);
    if (child_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      close(ends[0]);
      const auto store = backend_->open();
      if (!store) _exit(1);
      Restless(**store, seed, ends[1]).run();
    }
    close(ends[1]);
    Answer answer{};
    for (int i = 0; i < answers; ++i) {
      ASSERT_EQ(read(ends[0], &answer, sizeof answer), static_cast<ssize_t>(sizeof answer));
      heard(answer);
    }
    kill_child();
    // What was on its way when it died was answered too.
    while (read(ends[0], &answer, sizeof answer) == static_cast<ssize_t>(sizeof answer)) {
      heard(answer);
    }
    close(ends[0]);
    reopen();
  }

  // Law 1 as far as it can be seen from outside: nothing that was answered is lost, and what had
  // ended stays as it was.
  void expect_all_that_was_answered() {
    std::map<std::string, JobState> stored;
    for (const char* owner : {"a", "b", "c"}) {
      const auto jobs = store_->list({.owner = owner, .limit = 1'000'000});
      ASSERT_TRUE(jobs) << jobs.error().message;
      for (const JobRecord& job : *jobs) stored[job.id] = job.state;
    }
    for (const auto& [id, state] : answered_) {
      ASSERT_TRUE(stored.count(id)) << id << " is lost";
      if (is_final(state)) {
        EXPECT_EQ(stored[id], state) << id;
      }
    }
  }

  // Every job ends, and every mesh is whole.
  void expect_that_all_can_end() {
    backend_->pass(hours(1));
    reap(1000);
    while (const auto found = try_claim()) {
      ASSERT_EQ(store_->finish(found->ref, put({"last"})), Held::kHeld);
    }
    for (const char* owner : {"a", "b", "c"}) {
      const auto jobs = store_->list({.owner = owner, .limit = 1'000'000});
      ASSERT_TRUE(jobs) << jobs.error().message;
      for (const JobRecord& job : *jobs) {
        EXPECT_TRUE(is_final(job.state)) << job.id;
        if (job.state == JobState::kSucceeded) {
          EXPECT_TRUE(*store_->mesh(job.key)) << job.id;
        }
      }
    }
    for (int i = 0; i < kKeys; ++i) {
      const auto found = mesh(std::to_string(i));
      if (!found) continue;
      for (const StoredChunk& chunk : found->chunks) {
        const auto bytes = store_->chunk(chunk.sha256);
        ASSERT_TRUE(bytes && *bytes) << "a chunk is lost";
        EXPECT_EQ(sha256_of(**bytes), chunk.sha256);
      }
    }
  }

 private:
  void heard(const Answer& answer) {
    answered_[std::string(answer.id, sizeof answer.id)] = answer.state;
  }

  void kill_child() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = -1;
  }

  pid_t child_ = -1;
  std::map<std::string, JobState> answered_;  // id, and the state that was told last
};

TEST_P(CrashTest, NothingThatWasAnsweredIsLostWhenTheServerIsKilled) {
  for (unsigned round = 0; round < 6; ++round) {
    run_and_kill(round, 10 + 17 * static_cast<int>(round));
    if (HasFatalFailure()) return;
    expect_all_that_was_answered();
  }
  expect_that_all_can_end();
  expect_all_that_was_answered();
}

INSTANTIATE_TEST_SUITE_P(, CrashTest, kinds_of_store(), kind_name);

}  // namespace
}  // namespace weft::server
