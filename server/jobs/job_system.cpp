// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_system.h"

#include <fmt/format.h>

#include <utility>

namespace weft::server {
namespace {

std::string lost_workers(const RetryPolicy& policy) {
  return to_status({Reason::kWorkersLost, "",
                    fmt::format("{} workers took the job, and all were lost", policy.max_attempts)},
                   "")
      .error_details();
}

}  // namespace

JobSystem::JobSystem(std::unique_ptr<JobStore> store, JobOptions options, Admission& admission,
                     Metrics& metrics, const EngineFn& engine, ThreadPool& pool,
                     MemoryBudget& memory, RunQueue& queue, const Logger& log)
    : store_(std::move(store)) {
  options.retry.error = lost_workers(options.retry);
  options.retry.longest_lease = options.runner.lease;
  const RunEnvironment environment{engine,        pool,    *store_, options.service.limits,
                                   options.retry, metrics, log};
  options.service.works = options.works;
  store_->on_change([this] { notify(); });
  if (options.serves) service_.emplace(options.service, admission, metrics, memory, *store_, log);
  if (options.works) runner_.emplace(environment, queue, options.runner);
  if (options.service.callbacks != nullptr)
    sender_.emplace(
        CallbackSender::Parts{*options.service.callbacks, *store_, log,
                              [&metrics](const char* outcome) { metrics.callback_sent(outcome); }},
        options.callbacks);
  MutexLock lock(mutex_);
  listening_ = true;
}

// The store, and threads of its own, live longer than those that listen to it.
JobSystem::~JobSystem() {
  MutexLock lock(mutex_);
  listening_ = false;
}

void JobSystem::notify() {
  MutexLock lock(mutex_);
  if (!listening_) return;
  if (service_) service_->wake();
  if (runner_) runner_->wake();
  if (sender_) sender_->wake();
}

QueueStats JobSystem::stats() {
  QueueStats stats;
  if (runner_) stats = runner_->stats();
  if (const auto stored = store_->stats()) stats.waiting = static_cast<double>(stored->queued);
  return stats;
}

void JobSystem::close() {
  if (service_) service_->close();
  if (runner_) runner_->stop();
  if (sender_) sender_->stop();
}

}  // namespace weft::server
