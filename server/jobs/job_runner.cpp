// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "server/admission/memory_estimate.h"

namespace weft::server {
namespace {

// How often a run that waits for another slot asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};

}  // namespace

// A run is among those at work for as long as this lives.
class JobRunner::Listed {
 public:
  Listed(JobRunner& runner, std::shared_ptr<Attempt> run) : runner_(runner), run_(std::move(run)) {
    std::lock_guard lock(runner_.mutex_);
    runner_.runs_.insert(run_);
    if (runner_.stopping_) run_->stop();
  }
  ~Listed() {
    std::lock_guard lock(runner_.mutex_);
    runner_.runs_.erase(run_);
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;

 private:
  JobRunner& runner_;
  const std::shared_ptr<Attempt> run_;
};

// A run has a slot of a lane for as long as this lives.
class JobRunner::Placed {
 public:
  Placed(JobRunner& runner, Lane lane) : runner_(runner), light_(lane == Lane::kLight) {
    std::lock_guard lock(runner_.mutex_);
    ++slots().running;
  }
  ~Placed() {
    {
      std::lock_guard lock(runner_.mutex_);
      --slots().running;
      if (lent_) --runner_.lent_;
      if (runner_.moving_ == 0) return;
    }
    runner_.changed_.notify_all();
  }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  // Waits until there is a slot in the main lane, or the run is to end.
  void leave_light_lane(const ExecutionContext& run) {
    std::unique_lock lock(runner_.mutex_);
    if (!light_) return;
    --runner_.light_.running;
    ++runner_.moving_;
    ++runner_.lent_;
    ++runner_.wakes_;
    lent_ = true;
    runner_.add_light_worker_if_short();
    runner_.changed_.notify_all();
    while (runner_.main_.running >= runner_.main_.places && !runner_.stopping_) {
      runner_.changed_.wait_for(lock, kAsk);
      lock.unlock();
      const bool stopped = run.poll().has_value();
      lock.lock();
      if (stopped) break;
    }
    --runner_.moving_;
    light_ = false;
    ++runner_.main_.running;
  }

 private:
  Slots& slots() { return light_ ? runner_.light_ : runner_.main_; }

  JobRunner& runner_;
  bool light_;
  bool lent_ = false;
};

JobRunner::JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunnerOptions options)
    : environment_(environment),
      gate_(gate),
      options_(std::move(options)),
      main_{.places = options_.slots},
      light_{.places = options_.light_slots} {
  std::lock_guard lock(mutex_);
  for (std::uint32_t i = 0; i < options_.slots; ++i) add_worker(Lane::kMain);
  for (std::uint32_t i = 0; i < options_.light_slots; ++i) add_worker(Lane::kLight);
  threads_.emplace_back([this] { renew_and_reap(); });
  threads_.emplace_back([this] { collect(); });
}

JobRunner::~JobRunner() {
  stop();
}

void JobRunner::wake() {
  {
    std::lock_guard lock(mutex_);
    ++wakes_;
  }
  changed_.notify_all();
}

void JobRunner::stop() {
  std::vector<std::thread> threads;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;  // so that there are no more threads
    threads.swap(threads_);
    for (const auto& run : runs_) run->stop();
  }
  changed_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

// REQUIRES: mutex_ is held.
void JobRunner::add_worker(Lane lane) {
  threads_.emplace_back([this, lane] { work(lane); });
  if (lane == Lane::kLight) ++light_threads_;
}

// REQUIRES: mutex_ is held.
void JobRunner::add_light_worker_if_short() {
  try {
    if (light_threads_ < light_.places + lent_ && !stopping_) add_worker(Lane::kLight);
  } catch (const std::exception&) {
    // No thread or no memory for one: the slot stays empty until a run ends.
  }
}

QueueFigures JobRunner::figures() const {
  QueueFigures figures;
  std::lock_guard lock(mutex_);
  figures.running = static_cast<double>(runs_.size());
  for (const auto& run : runs_) figures.admitted_bytes += static_cast<double>(run->share_bytes());
  return figures;
}

// What is thrown here, for want of memory, must not end the server: it is tried again.
template <class F>
bool JobRunner::guarded(F&& step) {
  try {
    return step();
  } catch (const std::exception& error) {
    environment_.log->error("event=worker_failed message={}", log_value(error.what()));
    return false;
  }
}

void JobRunner::work(Lane lane) {
  std::uint64_t seen = 0;
  do {
    while (guarded([&] { return work_once(lane); })) continue;
  } while (wait_for_wake(seen));
}

// True if there may be more to do.
bool JobRunner::work_once(Lane lane) {
  std::unique_lock claiming(claiming_);
  {
    std::lock_guard lock(mutex_);
    const Slots& slots = lane == Lane::kLight ? light_ : main_;
    const std::size_t moving = lane == Lane::kLight ? 0 : moving_;  // these come first
    if (stopping_ || slots.running + moving >= slots.places) return false;
  }
  const std::uint64_t room = lane == Lane::kLight
                                 ? std::min(gate_.room(true), most_light(environment_.limits))
                                 : gate_.room(false);
  auto claim = environment_.store.claim(options_.worker, options_.lease, room);
  if (!claim) {
    environment_.log->warn("event=claim_failed message={}", log_value(claim.error().message));
    return false;
  }
  if (!*claim) return false;
  const bool light =
      options_.light_slots > 0 && (*claim)->estimate <= most_light(environment_.limits);
  auto share =
      gate_.take({.estimate = (*claim)->estimate, .client = (*claim)->owner, .light = light});
  Placed placed(*this, lane);
  claiming.unlock();
  if (!share) {  // calls took the room meanwhile
    (void)environment_.store.release((*claim)->ref, options_.poll, false);
    return false;
  }
  const Claim name{.ref = (*claim)->ref, .job_id = (*claim)->job_id, .tries = (*claim)->tries};
  try {
    Attempt::LeaveLightLane leave;
    if (light)
      leave = [&placed](MemoryGate::Share& share, const ExecutionContext& run) {
        share.turn_heavy();
        placed.leave_light_lane(run);
      };
    const auto run = std::make_shared<Attempt>(environment_, std::move(**claim), std::move(*share),
                                               std::move(leave));
    const Listed listed(*this, run);
    run->run();
  } catch (const std::bad_alloc&) {  // none for the request, or for what came of it
    give_up(name, {Reason::kOutOfMemory, "", "the server is out of memory"});
  } catch (const std::exception& error) {
    give_up(name, {Reason::kInternal, "", error.what()});
  }
  return true;
}

void JobRunner::give_up(const Claim& claim, const Failure& failure) {
  environment_.log->error("event=attempt_broken_off task={} job={} attempt={} message={}",
                          claim.ref.task, claim.job_id, claim.ref.attempt,
                          log_value(failure.message));
  const RetryPolicy& retry = environment_.retry;
  if (claim.tries < retry.max_attempts) {
    (void)environment_.store.release(claim.ref, delay_after(retry, claim.tries), true);
  } else {
    (void)environment_.store.fail(claim.ref, to_status(failure, "").error_details());
    environment_.metrics.job_became("failed");
  }
}

void JobRunner::renew_and_reap() {
  while (wait(options_.renewal)) {
    guarded([this] { return renew(); });
    guarded([this] { return reap(); });
  }
}

bool JobRunner::renew() {
  std::vector<std::shared_ptr<Attempt>> runs;
  {
    std::lock_guard lock(mutex_);
    runs.assign(runs_.begin(), runs_.end());
  }
  for (const auto& run : runs) run->renew(options_.lease);
  return true;
}

bool JobRunner::reap() {
  const auto reaped = environment_.store.reap(environment_.retry);
  if (!reaped || reaped->requeued + reaped->failed == 0) return false;
  environment_.metrics.leases_lost(reaped->requeued + reaped->failed);
  for (std::uint64_t i = 0; i < reaped->failed; ++i) environment_.metrics.job_became("failed");
  environment_.log->warn("event=leases_lost requeued={} failed={}", reaped->requeued,
                         reaped->failed);
  return true;
}

void JobRunner::collect() {
  while (wait(options_.between_collections)) guarded([this] { return collect_once(); });
}

bool JobRunner::collect_once() {
  const auto collected = environment_.store.collect(options_.keep);
  if (!collected) {
    environment_.log->warn("event=collect_failed message={}", log_value(collected.error().message));
    return false;
  }
  if (collected->jobs + collected->meshes + collected->chunks > 0)
    environment_.log->info("event=collected jobs={} meshes={} chunks={} bytes={}", collected->jobs,
                           collected->meshes, collected->chunks, collected->bytes);
  return true;
}

bool JobRunner::wait_for_wake(std::uint64_t& seen) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, options_.poll, [&] { return stopping_ || wakes_ != seen; });
  seen = wakes_;
  return !stopping_;
}

bool JobRunner::wait(std::chrono::milliseconds span) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, span, [this] { return stopping_; });
}

}  // namespace weft::server
