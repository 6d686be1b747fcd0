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

// How often a run that waits for another slot asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};

}  // namespace

void JobRunner::Slots::take(const std::string& owner) {
  if (!owner.empty()) ++running_of[owner];  // which may find no memory
  ++running;
}

void JobRunner::Slots::leave(const std::string& owner) {
  --running;
  const auto of_owner = running_of.find(owner);
  if (of_owner != running_of.end() && --of_owner->second == 0) running_of.erase(of_owner);
}

bool JobRunner::Slots::has_place(const std::string& owner) const {
  const auto found = running_of.find(owner);
  return running < places && (found == running_of.end() || found->second < of_owner);
}

std::vector<std::string> JobRunner::Slots::full_owners() const {
  std::vector<std::string> full;
  for (const auto& [owner, count] : running_of)
    if (count >= of_owner) full.push_back(owner);
  return full;
}

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

// Holds a slot of a lane for a run while this lives.
class JobRunner::Placed {
 public:
  Placed(JobRunner& runner, Lane lane, std::string owner)
      : runner_(runner),
        owner_(std::move(owner)),
        slots_(lane == Lane::kLight ? &runner.light_ : &runner.main_) {
    std::lock_guard lock(runner_.mutex_);
    slots_->take(owner_);
  }
  ~Placed() {
    {
      std::lock_guard lock(runner_.mutex_);
      if (slots_ != nullptr) slots_->leave(owner_);
      if (lent_) {  // the slot is not this thread's to fill
        --runner_.lent_;
        ++runner_.wakes_;
      }
      if (!lent_ && runner_.moving_.empty()) return;
    }
    runner_.changed_.notify_all();
  }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  // Waits for a slot in the main lane, or until the run is to end.
  void leave_light_lane(const ExecutionContext& run) {
    std::unique_lock lock(runner_.mutex_);
    if (slots_ != &runner_.light_) return;
    const auto self = runner_.moving_.insert(runner_.moving_.end(), this);
    std::exchange(slots_, nullptr)->leave(owner_);
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
    runner_.main_.take(owner_);
    slots_ = &runner_.main_;
    ++runner_.wakes_;  // another slot may be free, which nobody looked at because of this one
    runner_.changed_.notify_all();
  }

  const std::string& owner() const { return owner_; }

 private:
  JobRunner& runner_;
  const std::string owner_;
  Slots* slots_;  // null: in none yet
  bool lent_ = false;
};

JobRunner::JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunnerOptions options)
    : environment_(environment),
      gate_(gate),
      options_(std::move(options)),
      main_{.places = options_.slots, .of_owner = share_of(options_.slots, options_.client_share)},
      light_{.places = options_.light_slots,
             .of_owner = share_of(options_.light_slots, options_.client_share)} {
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

const JobRunner::Placed* JobRunner::next_moving() const {
  if (main_.running >= main_.places) return nullptr;
  const auto next = std::find_if(moving_.begin(), moving_.end(), [this](const Placed* placed) {
    return main_.has_place(placed->owner());
  });
  return next == moving_.end() ? nullptr : *next;
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

// True if there may be more to do.
bool JobRunner::work_once(Lane lane) {
  std::unique_lock claiming(claiming_);
  std::vector<std::string> full;
  {
    std::lock_guard lock(mutex_);
    const Slots& slots = lane == Lane::kLight ? light_ : main_;
    if (stopping_ || slots.running >= slots.places) return false;
    if (lane == Lane::kMain && next_moving() != nullptr) return false;
    full = slots.full_owners();
  }
  const std::uint64_t room = lane == Lane::kLight
                                 ? std::min(gate_.room(true), most_light(environment_.limits))
                                 : gate_.room(false);
  auto claim = environment_.store.claim(options_.worker, options_.lease, room, full);
  if (!claim) {
    environment_.log->warn("event=claim_failed message={}", log_value(claim.error().message));
    return false;
  }
  if (!*claim) return false;
  const bool light =
      options_.light_slots > 0 && (*claim)->estimate <= most_light(environment_.limits);
  auto share =
      gate_.take({.estimate = (*claim)->estimate, .client = (*claim)->owner, .light = light});
  Placed placed(*this, lane, (*claim)->owner);
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
