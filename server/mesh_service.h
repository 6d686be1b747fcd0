// SPDX-License-Identifier: Apache-2.0
// weft.v1.MeshService on gRPC's callback API. A call is parsed, checked against the limits and
// admitted on gRPC's thread; all the rest happens on workers (job_queue.h). One more thread ticks
// the jobs a few times a second, for progress, deadlines and stalled clients.
//
// GenerateMesh is registered as a raw method: messages are made and unmade on our threads and with
// our checks, and gRPC carries bytes.
//
// Outlives the gRPC server that it is registered with.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/arena.h"
#include "server/caller.h"
#include "server/drain.h"
#include "server/job_queue.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/memory_gate.h"
#include "server/mesh_cache.h"
#include "server/mesh_job.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::server {

struct ServiceOptions {
  // Threads that compute, in one arena for all jobs. REQUIRES: >= 1.
  std::uint32_t threads = 1;
  // Jobs that run at once, and that wait for their turn. REQUIRES: jobs >= 1.
  std::uint32_t jobs = 1;
  std::uint32_t queue = 64;
  // Jobs on top of these that are light (weight.h), so that they do not wait for the others. Each
  // computes on a thread of its own.
  std::uint32_t light_jobs = 0;
  Limits limits{};
  // Finished meshes that are kept in memory to answer the same request again (mesh_cache.h).
  std::uint64_t cache_bytes = 0;
  // A client that takes nothing for so long is cut off.
  std::chrono::steady_clock::duration stall_timeout = std::chrono::seconds(60);
  // Between progress messages.
  std::chrono::steady_clock::duration tick = std::chrono::milliseconds(250);
  // Tells this process's jobs from another's: job ids are INSTANCE-NUMBER.
  std::string instance = "0";
  v1::GetServerInfoResponse info{};  // what GetServerInfo answers
};

class MeshService final
    : public v1::MeshService::WithRawCallbackMethod_GenerateMesh<
          v1::MeshService::WithCallbackMethod_GetServerInfo<v1::MeshService::Service>> {
 public:
  // The authenticator, the metrics, the arena and the gate outlive the service.
  MeshService(const ServiceOptions& options, const Authenticator& authenticator, Metrics& metrics,
              EngineFn engine, Arena& arena, MemoryGate& gate, Logger log);
  // REQUIRES: no call is open.
  ~MeshService() override;

  // Refuses new calls from now on; `gate().wait_empty` tells when the old ones have ended.
  DrainGate& gate() { return gate_; }

  // The gate has room again.
  void notify() { queue_.notify(); }

  // Ends every open call with UNAVAILABLE.
  void stop_all();

  QueueFigures figures() const;

 private:
  grpc::ServerWriteReactor<grpc::ByteBuffer>* GenerateMesh(
      grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::GetServerInfoResponse* response) override;

  tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> read(grpc::ByteBuffer& bytes);
  grpc::ServerWriteReactor<grpc::ByteBuffer>* admit(grpc::CallbackServerContext* context,
                                                    grpc::ByteBuffer& bytes, Caller caller,
                                                    DrainGate::Pass pass);
  grpc::ServerWriteReactor<grpc::ByteBuffer>* refuse(const Caller& caller, const Failure& failure);
  Origin origin_of(const v1::GenerateMeshRequest& request, std::size_t bytes);
  void forget(MessageStream& stream);
  std::vector<std::shared_ptr<MeshJob>> open_jobs();
  void tick_until_stopped();

  const ServiceOptions options_;
  const Authenticator& authenticator_;
  Metrics& metrics_;
  const Logger log_;
  DrainGate gate_;
  MeshCache cache_;
  const JobEnvironment environment_;
  JobQueue queue_;  // destroyed first: it waits for the workers, who use all of the above

  std::mutex mutex_;  // guards the three below
  // Every job whose call is open: gRPC holds them by plain pointers.
  std::map<MessageStream*, std::shared_ptr<MeshJob>> jobs_;
  std::uint64_t last_number_ = 0;
  bool stopping_ = false;
  std::condition_variable changed_;
  std::thread ticker_;
};

}  // namespace weft::server
