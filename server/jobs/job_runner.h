// SPDX-License-Identifier: Apache-2.0
// The worker half of a server: takes tasks from the store while there is room for them, runs them,
// and renews their leases. It also maintains the store: it queues tasks again whose workers were
// lost, and collects expired jobs and meshes. Every server of a store does all of this.
//
//   JobRunner runner(environment, gate, places, {.worker = "weftd-1"});
//   store.on_change([&] { runner.wake(); });
//   ... runner.stop();
//
// Thread-safety: `wake`, `stop` and `figures` may be called from any thread.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/admission/memory_gate.h"
#include "server/admission/run_places.h"
#include "server/jobs/attempt.h"

namespace weft::server {

struct RunnerOptions {
  std::string worker{};  // its name in its tasks' records; unique among the servers of a store
  std::chrono::milliseconds lease{30'000};
  // The time between two renewals, which carry the progress.
  std::chrono::milliseconds renewal{1'000};
  // The time between two polls for a task if there is no notification.
  std::chrono::milliseconds poll{1'000};
  KeepPolicy keep{};
  std::chrono::milliseconds between_collections{60'000};
};

class JobRunner {
 public:
  // Tasks share the places with calls; tasks without an owner are nobody's share of them, because
  // their clients are not told apart. A task that turns out to be heavy leaves the light lane, and
  // goes on when there is a main place.
  JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunPlaces& places,
            RunnerOptions options);
  // Stops.
  ~JobRunner();
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  // Call when there may be a task.
  void wake();

  // Takes no more tasks, puts the running ones back into the queue, and waits until that is done.
  void stop();

  // The number of tasks that run here, and the memory with which they were admitted.
  QueueFigures figures() const;

 private:
  using Lane = RunPlaces::Lane;
  class Listed;
  class Placed;

  // The threads' loops; each step returns false if there was nothing to do, or if it failed.
  void work(Lane lane);
  bool work_once(Lane lane);
  void renew_and_reap();
  bool renew();
  bool reap();
  void collect();
  bool collect_once();
  // Returns the step's result; false if it throws.
  template <class F>
  bool guarded(F&& step);
  void add_worker(Lane lane);
  void add_light_worker_if_short();
  // Whether a task may begin in this lane now, for all that is known here. If not, it waits.
  // REQUIRES: mutex_ is held.
  bool may_begin(Lane lane);
  // Begins in a place that another kind of run has not taken since.
  bool take_place(Lane lane, const std::string& owner);
  // The first run that may have a main place now; null: none. REQUIRES: mutex_ is held.
  const Placed* next_moving();
  // Ends a claim whose run has thrown.
  void give_up(const Claim& claim, const Failure& failure);
  // Waits for a `wake` that the caller has not seen; `seen` is the number of those seen. Returns
  // false once the runner stops.
  bool wait_for_wake(std::uint64_t& seen);
  // Returns false once the runner stops.
  bool wait(std::chrono::milliseconds span);

  const RunEnvironment environment_;
  MemoryGate& gate_;
  const RunnerOptions options_;

  RunPlaces& places_;
  std::mutex& mutex_;  // of the places; guards all below but claiming_
  // Per lane, whether a task may wait for a place, or for its owner's share of them.
  std::array<bool, 2> waits_{};
  std::list<const Placed*> moving_;  // from the light lane to the main one, the first first
  std::size_t lent_ = 0;  // threads of the light lane that run in the main one, or are about to
  std::set<std::shared_ptr<Attempt>> runs_;
  std::uint64_t wakes_ = 0;
  bool stopping_ = false;
  std::size_t light_threads_ = 0;
  std::vector<std::thread> threads_;
  std::condition_variable changed_;
  std::mutex claiming_;  // held from asking for room until it is taken
};

}  // namespace weft::server
