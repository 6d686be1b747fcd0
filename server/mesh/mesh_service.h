// SPDX-License-Identifier: Apache-2.0
// weft.v1.MeshService on gRPC's callback API. A call is parsed, checked against the limits and
// admitted on gRPC's thread; all the rest happens on workers (run_queue.h). One more thread ticks
// the calls a few times a second, for progress, deadlines and stalled clients.
//
// Both methods pass the Admission: messages are checked before they are parsed.
//
// Outlives the gRPC server that it is registered with. Thread-safety: every function may be called
// from any thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "server/admission/admission.h"
#include "server/mesh/mesh_cache.h"
#include "server/mesh/mesh_call.h"
#include "server/net/open_streams.h"
#include "server/observe/log.h"
#include "server/run/run_queue.h"
#include "server/wire/limits.h"
#include "weft/run.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

struct ServiceOptions {
  // Threads that compute, in one pool for all runs. REQUIRES: >= 1.
  std::uint32_t threads = 1;
  // Maximum runs at the same time, and maximum calls that wait for a slot. REQUIRES: jobs >= 1.
  std::uint32_t jobs = 1;
  std::uint32_t queue = 64;
  // Runs on top of these that are light (memory_estimate.h), so that they do not wait for the
  // others. Each computes on a thread of its own.
  std::uint32_t light_jobs = 0;
  // The fraction of the queue, the slots and the memory that one client may have (run_queue.h).
  double client_share = 1;
  Limits limits{};
  // Finished meshes that are kept in memory to answer the same request again (mesh_cache.h).
  std::uint64_t cache_bytes = 0;
  // Whether a client may be answered with a mesh that another client's call made.
  bool share_across_clients = true;
  // A client that reads more slowly is cut off.
  ReaderPatience patience{};
  // Between progress messages.
  std::chrono::steady_clock::duration tick = std::chrono::milliseconds(250);
  // Distinguishes this process's calls from another's: their ids are INSTANCE-NUMBER.
  std::string instance = "0";
  v1::GetServerInfoResponse info{};  // what GetServerInfo answers
};

class MeshService final : public RawService {
 public:
  // The admission, the metrics, the pool and the queue outlive the service.
  MeshService(const ServiceOptions& options, Admission& admission, Metrics& metrics,
              EngineFn engine, ThreadPool& pool, RunQueue& queue, Logger log);
  // REQUIRES: no call is open, and the queue has stopped.
  ~MeshService() override;

  // Ends every open call with UNAVAILABLE.
  void stop_all();
  // Ends the calls of callers whose token is no longer known.
  void revoke_unknown(const Authenticator& authenticator) { calls_.revoke_unknown(authenticator); }

  QueueStats stats() const;

 private:
  void generate_mesh(AdmittedCall& call);
  void answer_server_info(AdmittedCall& call);
  CacheLookup look_up(const v1::GenerateMeshRequest& request, std::size_t bytes,
                      const Caller& caller);
  void tick_until_stopped();

  const ServiceOptions options_;
  Metrics& metrics_;
  const Logger log_;
  MeshCache cache_;
  const CallEnvironment environment_;
  RunQueue& queue_;

  OpenStreams<MeshCall> calls_;
  std::mutex mutex_;  // guards the two below
  std::uint64_t last_number_ = 0;
  bool stopping_ = false;
  std::condition_variable changed_;
  std::thread ticker_;
};

}  // namespace weft::server
