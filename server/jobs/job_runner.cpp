// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "server/admission/client_share.h"
#include "server/admission/memory_estimate.h"

namespace weft::server {
namespace {

constexpr RunPlaces::Kind kKind = RunPlaces::Kind::kJob;
// How often a run that waits for another place asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};

}  // namespace

// Lists a run among those at work while this lives.
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

// Holds a place of a lane for a run while this lives. REQUIRES: it has begun.
class JobRunner::Placed {
 public:
  Placed(JobRunner& runner, Lane lane, std::string owner)
      : runner_(runner), owner_(std::move(owner)), lane_(lane) {}
  ~Placed() {
    {
      std::lock_guard lock(runner_.mutex_);
      if (lane_) runner_.places_.end(*lane_, kKind, owner_);
      if (lent_) {  // the place is not this thread's to fill
        --runner_.lent_;
        ++runner_.wakes_;
      }
      if (!lent_ && runner_.moving_.empty()) return;
    }
    runner_.changed_.notify_all();
  }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  // Waits for a place in the main lane, or until the run is to end.
  void leave_light_lane(const Run& run) {
    std::unique_lock lock(runner_.mutex_);
    if (lane_ != Lane::kLight) return;
    const auto self = runner_.moving_.insert(runner_.moving_.end(), this);
    lane_.reset();
    runner_.places_.end(Lane::kLight, kKind, owner_);
    ++runner_.lent_;
    ++runner_.wakes_;
    lent_ = true;
    runner_.add_light_worker_if_short();
    runner_.changed_.notify_all();
    while (runner_.next_moving() != this && !runner_.stopping_) {
      runner_.changed_.wait_for(lock, kAsk);
      lock.unlock();
      const bool stopped = run.poll().has_value();
      lock.lock();
      if (stopped) break;
    }
    runner_.moving_.erase(self);
    runner_.places_.begin(Lane::kMain, kKind, owner_);
    lane_ = Lane::kMain;
    ++runner_.wakes_;  // another place may be free, which nobody looked at because of this one
    runner_.changed_.notify_all();
  }

  const std::string& owner() const { return owner_; }

 private:
  JobRunner& runner_;
  const std::string owner_;
  std::optional<Lane> lane_;  // none yet
  bool lent_ = false;
};

JobRunner::JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunPlaces& places,
                     RunnerOptions options)
    : environment_(environment),
      gate_(gate),
      options_(std::move(options)),
      places_(places),
      mutex_(places.mutex) {
  std::lock_guard lock(mutex_);
  for (const Lane lane : {Lane::kMain, Lane::kLight})
    for (std::size_t i = 0; i < places_.places(lane); ++i) add_worker(lane);
  threads_.emplace_back([this] { renew_and_reap(); });
  threads_.emplace_back([this] { collect(); });
  places_.on_free(kKind, [this] {
    if (!waits_[0] && !waits_[1]) return;
    ++wakes_;
    changed_.notify_all();
  });
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
    places_.on_free(kKind, {});
    for (const Lane lane : {Lane::kMain, Lane::kLight}) places_.set_waits(lane, kKind, false);
    threads.swap(threads_);
    for (const auto& run : runs_) run->stop();
  }
  changed_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

bool JobRunner::may_begin(Lane lane) {
  if (places_.is_free(lane, kKind)) return true;
  places_.set_waits(lane, kKind, true);
  waits_[static_cast<std::size_t>(lane)] = true;
  return false;
}

const JobRunner::Placed* JobRunner::next_moving() {
  const auto next = std::ranges::find_if(moving_, [this](const Placed* placed) {
    return places_.has_share(Lane::kMain, placed->owner());
  });
  return next != moving_.end() && may_begin(Lane::kMain) ? *next : nullptr;
}

// REQUIRES: mutex_ is held.
void JobRunner::add_worker(Lane lane) {
  threads_.emplace_back([this, lane] { work(lane); });
  if (lane == Lane::kLight) ++light_threads_;
}

// REQUIRES: mutex_ is held.
void JobRunner::add_light_worker_if_short() {
  try {
    if (light_threads_ < places_.places(Lane::kLight) + lent_ && !stopping_)
      add_worker(Lane::kLight);
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

// An exception here, such as for lack of memory, must not end the server: the step is tried again.
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

bool JobRunner::take_place(Lane lane, const std::string& owner) {
  std::lock_guard lock(mutex_);
  if (!places_.has_place(lane)) return may_begin(lane);
  places_.begin(lane, kKind, owner);
  return true;
}

// True if there may be more to do.
bool JobRunner::work_once(Lane lane) {
  std::unique_lock claiming(claiming_);
  std::vector<std::string> full;
  {
    std::lock_guard lock(mutex_);
    if (stopping_ || (lane == Lane::kMain && next_moving() != nullptr) || !may_begin(lane))
      return false;
    full = places_.full_clients(lane);
  }
  const std::uint64_t room = lane == Lane::kLight
                                 ? std::min(gate_.room(true), most_light(environment_.limits))
                                 : gate_.room(false);
  auto claim = environment_.store.claim(options_.worker, options_.lease, room, full);
  if (!claim) {
    environment_.log->warn("event=claim_failed message={}", log_value(claim.error().message));
  }
  if (!claim || !*claim) {
    std::lock_guard lock(mutex_);
    waits_[static_cast<std::size_t>(lane)] = !full.empty();
    places_.set_waits(lane, kKind, false);
    return false;
  }
  const bool light =
      places_.places(Lane::kLight) > 0 && (*claim)->estimate <= most_light(environment_.limits);
  auto share =
      gate_.take({.estimate = (*claim)->estimate, .client = (*claim)->owner, .light = light});
  const bool has_place = share && take_place(lane, (*claim)->owner);
  claiming.unlock();
  if (!has_place) {  // calls took the room or the place meanwhile
    const auto delay = share ? std::chrono::milliseconds(0) : options_.poll;
    (void)environment_.store.release((*claim)->ref, delay, false);
    return false;
  }
  Placed placed(*this, lane, (*claim)->owner);
  const Claim name{.ref = (*claim)->ref, .job_id = (*claim)->job_id, .tries = (*claim)->tries};
  try {
    Attempt::LeaveLightLane leave;
    if (light)
      leave = [&placed](MemoryGate::Share& share, const Run& run) {
        share.turn_heavy();
        share.set_parked(true);  // those in the slots may wait for the memory of this one
        placed.leave_light_lane(run);
        share.set_parked(false);
      };
    const auto run = std::make_shared<Attempt>(environment_, std::move(**claim), std::move(*share),
                                               std::move(leave));
    const Listed listed(*this, run);
    run->run();
  } catch (const std::bad_alloc&) {  // no memory for the request, or for its result
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
