// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_runner.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <new>
#include <utility>

namespace weft::server {

// A run is among those at work for as long as this lives.
class JobRunner::Listed {
 public:
  Listed(JobRunner& runner, std::shared_ptr<TaskRun> run) : runner_(runner), run_(std::move(run)) {
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
  const std::shared_ptr<TaskRun> run_;
};

JobRunner::JobRunner(const RunEnvironment& environment, MemoryGate& gate, RunnerOptions options)
    : environment_(environment), gate_(gate), options_(std::move(options)) {
  threads_.reserve(options_.slots + 2);
  for (std::uint32_t i = 0; i < options_.slots; ++i) threads_.emplace_back([this] { work(); });
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
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& run : runs_) run->stop();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_)
    if (thread.joinable()) thread.join();
}

QueueFigures JobRunner::figures() const {
  QueueFigures figures;
  std::lock_guard lock(mutex_);
  figures.running = static_cast<double>(runs_.size());
  for (const auto& run : runs_) figures.admitted_bytes += static_cast<double>(run->weight());
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

void JobRunner::work() {
  std::uint64_t seen = 0;
  do {
    while (guarded([this] { return work_once(); })) continue;
  } while (wait_for_wake(seen));
}

// True where there may be more to do.
bool JobRunner::work_once() {
  std::unique_lock claiming(claiming_);
  {
    std::lock_guard lock(mutex_);
    if (stopping_) return false;
  }
  auto claim = environment_.store.claim(options_.worker, options_.lease, gate_.room());
  if (!claim) {
    environment_.log->warn("event=claim_failed message={}", log_value(claim.error().message));
    return false;
  }
  if (!*claim) return false;
  const auto share = gate_.take((*claim)->weight);
  claiming.unlock();
  if (!share) {  // calls took the room meanwhile
    (void)environment_.store.release((*claim)->ref, options_.poll, false);
    return false;
  }
  const Claim name{.ref = (*claim)->ref, .job_id = (*claim)->job_id, .tries = (*claim)->tries};
  try {
    const auto run = std::make_shared<TaskRun>(environment_, std::move(**claim));
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
  environment_.log->error("event=task_broken_off task={} job={} attempt={} message={}",
                          claim.ref.task, claim.job_id, claim.ref.attempt,
                          log_value(failure.message));
  const RetryPolicy& retry = environment_.retry;
  if (claim.tries < retry.max_attempts) {
    (void)environment_.store.release(claim.ref, delay_after(retry, claim.tries), true);
  } else {
    (void)environment_.store.fail(claim.ref, to_status(failure, claim.job_id).error_details());
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
  std::vector<std::shared_ptr<TaskRun>> runs;
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
