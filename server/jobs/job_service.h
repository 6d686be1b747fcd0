// SPDX-License-Identifier: Apache-2.0
// weft.v1.JobService on gRPC's callback API. gRPC's threads only hand over: all that asks the store
// runs on threads of the service's own, and what is streamed is pulled by those who read it.
//
// SubmitJob, WatchJob and FetchMesh are raw methods: what they carry is checked before it is
// parsed, and stored chunks go out as they were stored.
//
// Outlives the gRPC server that it is registered with; the store outlives it.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/caller.h"
#include "server/drain.h"
#include "server/job_queue.h"
#include "server/jobs/job_stream.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/store/job_store.h"
#include "weft/v1/job_service.grpc.pb.h"

namespace weft::server {

struct JobServiceOptions {
  Limits limits{};
  // Tasks that wait, of all clients and of one.
  std::uint64_t max_queued = 10'000;
  std::uint64_t max_queued_of_owner = 1'000;
  // A client that takes nothing for so long is cut off.
  std::chrono::steady_clock::duration stall_timeout = std::chrono::seconds(60);
  // Between two looks at jobs that are watched, where nothing says that they changed.
  std::chrono::steady_clock::duration tick = std::chrono::milliseconds(250);
};

// Each With... takes one method over: raw where it says so.
using JobServiceBase = v1::JobService::WithRawCallbackMethod_SubmitJob<
    v1::JobService::WithCallbackMethod_GetJob<v1::JobService::WithCallbackMethod_ListJobs<
        v1::JobService::WithRawCallbackMethod_WatchJob<v1::JobService::WithCallbackMethod_CancelJob<
            v1::JobService::WithCallbackMethod_DeleteJob<
                v1::JobService::WithRawCallbackMethod_FetchMesh<v1::JobService::Service>>>>>>>;

class JobService final : public JobServiceBase {
 public:
  // The authenticator and the metrics outlive the service, too.
  JobService(JobServiceOptions options, const Authenticator& authenticator, Metrics& metrics,
             JobStore& store, Logger log);
  // REQUIRES: no call is open.
  ~JobService() override;

  // Jobs may have changed: those who watch are told soon.
  void wake();

  // Refuses new calls from now on, and ends the watches; `gate().wait_empty` tells when all calls
  // have ended.
  void close();
  DrainGate& gate() { return gate_; }

  // Ends every open call with UNAVAILABLE.
  void stop_all();

 private:
  using Unary = grpc::ServerUnaryReactor;
  using Stream = grpc::ServerWriteReactor<grpc::ByteBuffer>;
  using Context = grpc::CallbackServerContext;
  using Answer = std::optional<Failure>;

  Unary* SubmitJob(Context* context, const grpc::ByteBuffer* request,
                   grpc::ByteBuffer* response) override;
  Unary* GetJob(Context* context, const v1::GetJobRequest* request,
                v1::GetJobResponse* response) override;
  Unary* ListJobs(Context* context, const v1::ListJobsRequest* request,
                  v1::ListJobsResponse* response) override;
  Unary* CancelJob(Context* context, const v1::CancelJobRequest* request,
                   v1::CancelJobResponse* response) override;
  Unary* DeleteJob(Context* context, const v1::DeleteJobRequest* request,
                   v1::DeleteJobResponse* response) override;
  Stream* WatchJob(Context* context, const grpc::ByteBuffer* request) override;
  Stream* FetchMesh(Context* context, const grpc::ByteBuffer* request) override;

  // Runs the handler on a thread of the service, and finishes the call with what it answers.
  Unary* answer(Context* context, const char* method, std::function<Answer(const Caller&)> handler);
  Answer submit(const Caller& caller, const grpc::ByteBuffer& bytes, grpc::ByteBuffer& response);
  tl::expected<v1::SubmitJobRequest, Failure> read_submission(const grpc::ByteBuffer& bytes) const;
  // A job as the store has it, or why there is none.
  static Answer tell(const StoreResult<std::optional<JobRecord>>& record, const std::string& id,
                     v1::Job& out);
  // Opens the stream that `make` makes of a StreamedJob, the request and a pass through the gate.
  template <class Request, class Make>
  Stream* open(Context* context, const grpc::ByteBuffer& bytes, const char* method,
               const char* type, Make&& make);
  void refused(const Caller& caller, const char* method, const Failure& failure);

  void forget(MessageStream& stream);
  std::vector<std::shared_ptr<JobStream>> open_streams();
  void tick_until_stopped();

  const JobServiceOptions options_;
  const Authenticator& authenticator_;
  Metrics& metrics_;
  JobStore& store_;
  const Logger log_;
  DrainGate gate_;
  const StreamEnvironment environment_;
  JobQueue threads_;  // destroyed early: it waits for handlers, who use all of the above

  std::mutex mutex_;  // guards the three below
  // Every stream whose call is open: gRPC holds them by plain pointers.
  std::map<MessageStream*, std::shared_ptr<JobStream>> streams_;
  bool woken_ = false;
  bool stopping_ = false;
  std::condition_variable changed_;
  std::thread ticker_;
};

}  // namespace weft::server
