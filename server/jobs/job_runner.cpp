// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_runner.h"

#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace weft::server {

// Lists a run among those at work while this lives.
class JobRunner::Listed {
 public:
  Listed(JobRunner& runner, std::shared_ptr<Attempt> run) : runner_(runner), run_(std::move(run)) {
    MutexLock lock(runner_.mutex_);
    runner_.runs_.insert(run_);
    if (runner_.stopping_) run_->stop();
  }
  ~Listed() {
    MutexLock lock(runner_.mutex_);
    runner_.runs_.erase(run_);
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;

 private:
  JobRunner& runner_;
  const std::shared_ptr<Attempt> run_;
};

JobRunner::JobRunner(const RunEnvironment& environment, RunQueue& queue, RunnerOptions options)
    : environment_(environment),
      queue_(queue),
      options_(std::move(options)),
      renewer_([this] { renew_until_stopped(); }),
      collector_([this] { collect_until_stopped(); }) {
  queue_.attach(*this);
  queue_.wake();
}

void JobRunner::stop() {
  {
    MutexLock lock(mutex_);
    if (std::exchange(stopping_, true)) return;
    for (const auto& run : runs_) run->stop();
  }
  stopped_.notify_all();
  queue_.detach();
  renewer_.join();
  collector_.join();
}

QueueStats JobRunner::stats() const {
  QueueStats stats;
  MutexLock lock(mutex_);
  stats.running = static_cast<double>(runs_.size());
  for (const auto& run : runs_) stats.admitted_bytes += static_cast<double>(run->reserved_bytes());
  return stats;
}

// An exception here, such as for lack of memory, must not end the server: the step is tried again.
template <class F>
void JobRunner::guarded(F&& step) const noexcept try {
  step();
} catch (const std::exception& error) {
  environment_.log->error("event=worker_failed message={}", log_value(error.what()));
}

void JobRunner::run_next(RunQueue::Slot& slot) noexcept {
  guarded([&] {
    auto claim = environment_.store.claim(options_.worker, options_.lease, slot.max_estimate(),
                                          slot.full_clients());
    if (!claim)
      environment_.log->warn("event=claim_failed message={}", log_value(claim.error().message));
    if (!claim || !*claim) return;
    if (slot.admit({(*claim)->owner, (*claim)->estimate}))
      run(std::move(**claim), slot);
    else
      (void)environment_.store.release((*claim)->ref, options_.renewal, false);
  });
}

void JobRunner::run(Claim claim, RunQueue::Slot& slot) {
  const Claim name{.ref = claim.ref, .job_id = claim.job_id, .tries = claim.tries};
  try {
    const auto run = std::make_shared<Attempt>(environment_, std::move(claim), slot);
    const Listed listed(*this, run);
    run->run();
  } catch (const std::bad_alloc&) {  // no memory for the request, or for its result
    give_up(name, {Reason::kOutOfMemory, "", "the server is out of memory"});
  } catch (const std::exception& error) {
    give_up(name, {Reason::kInternal, "", error.what()});
  }
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

void JobRunner::renew_until_stopped() {
  while (wait(options_.renewal)) {
    guarded([this] { renew(); });
    guarded([this] { reap(); });
    queue_.wake();
  }
}

void JobRunner::renew() {
  std::vector<std::shared_ptr<Attempt>> runs;
  {
    MutexLock lock(mutex_);
    runs.assign(runs_.begin(), runs_.end());
  }
  for (const auto& run : runs) run->renew(options_.lease);
}

void JobRunner::reap() {
  const auto reaped = environment_.store.reap(environment_.retry);
  if (!reaped) return;
  if (reaped->clock_was_set_back && !clock_was_set_back_)
    environment_.log->warn("event=clock_set_back message={}",
                           log_value("jobs were submitted later than the clock of the store shows; "
                                     "they keep their order"));
  clock_was_set_back_ = reaped->clock_was_set_back;
  if (reaped->requeued + reaped->failed == 0) return;
  environment_.metrics.leases_lost(reaped->requeued + reaped->failed);
  for (std::uint64_t i = 0; i < reaped->failed; ++i) environment_.metrics.job_became("failed");
  environment_.log->warn("event=leases_lost requeued={} failed={}", reaped->requeued,
                         reaped->failed);
}

void JobRunner::collect_until_stopped() {
  while (wait(options_.between_collections)) guarded([this] { collect(); });
}

void JobRunner::collect() {
  const auto collected = environment_.store.collect(options_.keep);
  if (!collected) {
    environment_.log->warn("event=collect_failed message={}", log_value(collected.error().message));
    return;
  }
  if (collected->jobs + collected->meshes + collected->chunks > 0)
    environment_.log->info("event=collected jobs={} meshes={} chunks={} bytes={}", collected->jobs,
                           collected->meshes, collected->chunks, collected->bytes);
}

bool JobRunner::wait(std::chrono::milliseconds span) {
  const auto end = std::chrono::steady_clock::now() + span;
  MutexLock lock(mutex_);
  while (!stopping_)
    if (stopped_.wait_until(lock.native(), end) == std::cv_status::timeout) return true;
  return false;
}

}  // namespace weft::server
