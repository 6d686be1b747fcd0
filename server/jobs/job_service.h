// SPDX-License-Identifier: Apache-2.0
// weft.v1.JobService on gRPC's callback API. gRPC's threads only hand calls over: all calls of the
// store run on the service's own threads, and streams read from it as fast as their clients read.
//
// All methods pass the Admission: their messages are checked before they are parsed. Stored chunks
// are sent as they were stored.
//
// Must outlive the gRPC server that it is registered with; the store must outlive it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "server/admission/admission.h"
#include "server/callbacks/callbacks.h"
#include "server/jobs/job_stream.h"
#include "server/net/open_streams.h"
#include "server/observe/log.h"
#include "server/run/mutex.h"
#include "server/run/run_queue.h"
#include "server/store/job_store.h"
#include "server/wire/limits.h"
#include "weft/v1/job_service.pb.h"

namespace weft::server {

struct JobServiceOptions {
  Limits limits{};
  // Whether this server's own workers take the jobs, so that its memory tells what can never begin.
  bool works = true;
  // Whether a client's job may share work or a mesh with another client's.
  bool share_across_clients = true;
  // Maximum of waiting tasks of all clients; of jobs of one client that have not ended, and of its
  // callbacks that are neither delivered nor failed.
  std::uint64_t max_queued = 10'000;
  std::uint64_t max_open_of_client = 1'000;
  // Who may have callbacks; outlives the service. Null: nobody.
  const Callbacks* callbacks = nullptr;
  // The fraction of the calls that wait for the store, and of the threads that use it, that one
  // client may have.
  double client_share = 1;
  // Clients that read more slowly are cut off.
  ReaderPatience patience{};
  // The time between two polls of watched jobs if there is no notification.
  std::chrono::steady_clock::duration tick = std::chrono::milliseconds(250);
};

class JobService final : public RawService {
 public:
  // All of these must outlive the service.
  JobService(JobServiceOptions options, Admission& admission, Metrics& metrics,
             MemoryBudget& memory, JobStore& store, Logger log);
  // REQUIRES: no call is open.
  ~JobService() override;

  // Call when jobs may have changed: watching clients are notified soon.
  void wake();

  // Refuses new calls from now on, and ends the watches.
  void close();

  // Ends every open call with UNAVAILABLE.
  void stop_all();
  // Ends the streams of callers whose token is no longer known.
  void revoke_unknown(const Authenticator& authenticator) {
    streams_.revoke_unknown(authenticator);
  }

 private:
  template <class Response>
  using Answer = tl::expected<Response, Failure>;

  // For a job that names this URL.
  Answer<Callback> callback_of(const Caller& caller, const std::string& url) const;

  // Adds a method with one reply, which a thread of the service computes.
  template <class Request, class Response>
  void add_unary(const char* method,
                 Answer<Response> (JobService::*handler)(const Caller&, const Request&));
  // Adds a method whose stream is a Stream.
  template <class Request, class Stream>
  void add_stream(const char* method);

  void submit_job(const std::shared_ptr<AdmittedCall>& call);
  Answer<v1::SubmitJobResponse> submit(const Caller& caller, v1::SubmitJobRequest request,
                                       std::size_t bytes);
  Answer<v1::GetJobResponse> get(const Caller& caller, const v1::GetJobRequest& request);
  Answer<v1::CancelJobResponse> cancel(const Caller& caller, const v1::CancelJobRequest& request);
  Answer<v1::DeleteJobResponse> remove(const Caller& caller, const v1::DeleteJobRequest& request);
  Answer<v1::ListJobsResponse> list(const Caller& caller, const v1::ListJobsRequest& request);

  // Runs the handler on a thread of the service, and ends the call with its result.
  template <class Response>
  void answer_soon(std::shared_ptr<AdmittedCall> call, std::function<Answer<Response>()> handler);

  void tick_until_stopped();

  const JobServiceOptions options_;
  Metrics& metrics_;
  JobStore& store_;
  const Logger log_;
  const StreamEnvironment environment_;
  RunQueue threads_;  // destroyed early: it waits for handlers, which use all of the above

  OpenStreams<JobStream> streams_;
  Mutex mutex_;
  bool woken_ ABSL_GUARDED_BY(mutex_) = false;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::condition_variable changed_;
  std::thread ticker_;
};

}  // namespace weft::server
