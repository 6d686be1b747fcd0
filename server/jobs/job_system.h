// SPDX-License-Identifier: Apache-2.0
// The part of a server that handles stored jobs: the store, the service that accepts and shows
// jobs, the workers that run them, and what tells of their ends. A server may have the service, the
// workers, or both; any number of servers may share a PostgreSQL store.
//
// The gRPC server that `service()` is registered with must be shut down before this is destroyed.
#pragma once

#include <memory>
#include <optional>

#include "server/callbacks/callback_sender.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/job_service.h"
#include "server/observe/log.h"
#include "server/run/engine_call.h"
#include "server/run/memory_budget.h"
#include "server/store/job_store.h"
#include "weft/run.h"

namespace weft::server {

struct JobOptions {
  JobServiceOptions service{};
  RunnerOptions runner{};
  RetryPolicy retry{};  // its error is filled in
  bool serves = true;
  bool works = true;
  SenderOptions callbacks{};  // if the service has any
};

class JobSystem {
 public:
  JobSystem(std::unique_ptr<JobStore> store, JobOptions options, Admission& admission,
            Metrics& metrics, const EngineFn& engine, ThreadPool& pool, MemoryBudget& memory,
            RunQueue& queue, const Logger& log);
  ~JobSystem();

  // Null if this server does not serve.
  JobService* service() { return service_ ? &*service_ : nullptr; }

  // Calls the store.
  QueueStats stats();

  // Refuses new calls, puts running tasks back into the queue, and sends no more callbacks. Open
  // calls go on.
  void close();

 private:
  void notify();

  std::unique_ptr<JobStore> store_;
  std::optional<JobService> service_;
  std::optional<JobRunner> runner_;
  std::optional<CallbackSender> sender_;
  Mutex mutex_;
  bool listening_ ABSL_GUARDED_BY(mutex_) = false;  // whether the three above exist
};

}  // namespace weft::server
