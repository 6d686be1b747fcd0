// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/job_runner.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <utility>

namespace weft::server {

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

void JobRunner::work() {
  std::uint64_t seen = 0;
  do {
    while (work_once()) continue;
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
  const ClaimRef ref = (*claim)->ref;
  try {
    run(std::move(**claim));
  } catch (const std::exception& error) {  // no memory for the request itself
    environment_.log->error("event=task_not_begun message={}", log_value(error.what()));
    (void)environment_.store.release(ref, options_.poll, true);
  }
  return true;
}

void JobRunner::run(Claim claim) {
  const auto run = std::make_shared<TaskRun>(environment_, std::move(claim));
  {
    std::lock_guard lock(mutex_);
    runs_.insert(run);
    if (stopping_) run->stop();
  }
  run->run();
  std::lock_guard lock(mutex_);
  runs_.erase(run);
}

void JobRunner::renew_and_reap() {
  while (wait(options_.renewal)) {
    std::vector<std::shared_ptr<TaskRun>> runs;
    {
      std::lock_guard lock(mutex_);
      runs.assign(runs_.begin(), runs_.end());
    }
    for (const auto& run : runs) run->renew(options_.lease);
    const auto reaped = environment_.store.reap(environment_.retry);
    if (reaped && reaped->requeued + reaped->failed > 0)
      environment_.log->warn("event=leases_lost requeued={} failed={}", reaped->requeued,
                             reaped->failed);
  }
}

void JobRunner::collect() {
  while (wait(options_.between_collections)) {
    const auto collected = environment_.store.collect(options_.keep);
    if (!collected)
      environment_.log->warn("event=collect_failed message={}",
                             log_value(collected.error().message));
    else if (collected->jobs + collected->meshes + collected->chunks > 0)
      environment_.log->info("event=collected jobs={} meshes={} chunks={} bytes={}",
                             collected->jobs, collected->meshes, collected->chunks,
                             collected->bytes);
  }
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
