// SPDX-License-Identifier: Apache-2.0
// The worker half of a server: claims tasks from the store as the queue of runs has slots for them,
// renews their leases and settles them. It also maintains the store: it queues tasks again whose
// workers were lost, and collects expired jobs and meshes. Every server of a store does all of
// this.
//
//   JobRunner runner(environment, queue, {.worker = "weftd-1"});
//   store.on_change([&] { runner.wake(); });
//   ... runner.stop();
//
// Thread-safety: `wake`, `stop` and `stats` may be called from any thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "server/jobs/attempt.h"
#include "server/run/mutex.h"
#include "server/run/run_queue.h"

namespace weft::server {

struct RunnerOptions {
  std::string worker{};  // its name in its tasks' records; unique among the servers of a store
  std::chrono::milliseconds lease{30'000};
  // The time between two renewals, which carry the progress. As often it looks for tasks of which
  // there was no notification.
  std::chrono::milliseconds renewal{1'000};
  KeepPolicy keep{};
  std::chrono::milliseconds between_collections{60'000};
};

class JobRunner final : private RunQueue::Source {
 public:
  // The queue outlives the runner.
  JobRunner(const RunEnvironment& environment, RunQueue& queue, RunnerOptions options);
  // Stops.
  ~JobRunner() override { stop(); }
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  // Call when there may be a task.
  void wake() { queue_.wake(); }

  // Takes no more tasks, puts the running ones back into the store, and waits until that is done.
  void stop();

  // The number of tasks that run here, and the memory that they have.
  QueueStats stats() const;

 private:
  class Listed;

  void run_next(RunQueue::Slot& slot) noexcept override;
  void run(Claim claim, RunQueue::Slot& slot);
  // Ends a claim whose run has thrown.
  void give_up(const Claim& claim, const Failure& failure);
  void renew_until_stopped();
  void renew();
  void reap();
  void collect_until_stopped();
  void collect();
  // Takes a step; what it throws is logged.
  template <class F>
  void guarded(F&& step) const noexcept;
  // Returns false once the runner stops.
  bool wait(std::chrono::milliseconds span);

  const RunEnvironment environment_;
  RunQueue& queue_;
  const RunnerOptions options_;

  mutable Mutex mutex_;
  std::set<std::shared_ptr<Attempt>> runs_ ABSL_GUARDED_BY(mutex_);
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::condition_variable stopped_;
  bool clock_was_set_back_ = false;  // at the last look; used only by the renewer
  std::thread renewer_;
  std::thread collector_;
};

}  // namespace weft::server
