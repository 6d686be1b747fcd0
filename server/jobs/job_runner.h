// SPDX-License-Identifier: Apache-2.0
// The worker half of a server: takes tasks from the store while there is room for them, runs them,
// renews their leases, and keeps the store in order: tasks whose workers were lost are queued
// again, and what is kept too long is collected. Every server of a store does all of it.
//
//   JobRunner runner(environment, gate, {.worker = "weftd-1", .slots = 4});
//   store.on_change([&] { runner.wake(); });
//   ... runner.stop();
//
// Thread-safety: `wake`, `stop` and `figures` may be called from any thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/admission/memory_gate.h"
#include "server/jobs/attempt.h"

namespace weft::server {

struct RunnerOptions {
  std::string worker{};     // of its tasks' records; tells the servers of a store apart
  std::uint32_t slots = 1;  // tasks at once. REQUIRES: >= 1
  // Tasks on top of these that are light (memory_estimate.h). One that turns out heavy leaves its
  // slot to another, and goes on when one of the others is free.
  std::uint32_t light_slots = 0;
  std::chrono::milliseconds lease{30'000};
  // Between two renewals, which carry the progress.
  std::chrono::milliseconds renewal{1'000};
  // Between two looks for a task where nothing says that there is one.
  std::chrono::milliseconds poll{1'000};
  KeepPolicy keep{};
  std::chrono::milliseconds between_collections{60'000};
};

class JobRunner {
 public:
  JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunnerOptions options);
  // Stops.
  ~JobRunner();
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  // There may be a task.
  void wake();

  // Takes no more, puts back what runs, and waits for that.
  void stop();

  // What runs here, and the memory that it was admitted with.
  QueueFigures figures() const;

 private:
  enum class Lane { kMain, kLight };
  class Listed;
  class Placed;
  struct Slots {
    std::size_t places;
    std::size_t running = 0;
  };

  // What the threads do again and again; false if there was nothing to do, or it failed.
  void work(Lane lane);
  bool work_once(Lane lane);
  void renew_and_reap();
  bool renew();
  bool reap();
  void collect();
  bool collect_once();
  // The step's answer; false where it throws.
  template <class F>
  bool guarded(F&& step);
  void add_worker(Lane lane);
  void add_light_worker_if_short();
  // Ends a claim whose run has thrown.
  void give_up(const Claim& claim, const Failure& failure);
  // Returns at the next `wake`; `seen` counts those that the caller knows of. False once the runner
  // stops.
  bool wait_for_wake(std::uint64_t& seen);
  // False once the runner stops.
  bool wait(std::chrono::milliseconds span);

  const RunEnvironment environment_;
  MemoryGate& gate_;
  const RunnerOptions options_;

  mutable std::mutex mutex_;  // guards all below but claiming_
  Slots main_;
  Slots light_;
  std::size_t moving_ = 0;  // from the light lane to the main one
  std::size_t lent_ = 0;    // threads of the light lane that run in the main one, or are about to
  std::set<std::shared_ptr<Attempt>> runs_;
  std::uint64_t wakes_ = 0;
  bool stopping_ = false;
  std::size_t light_threads_ = 0;
  std::vector<std::thread> threads_;
  std::condition_variable changed_;
  std::mutex claiming_;  // from asking how much room there is to taking it
};

}  // namespace weft::server
