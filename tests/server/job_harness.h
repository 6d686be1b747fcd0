// SPDX-License-Identifier: Apache-2.0
// A real server with a real store in a folder, its log and metrics, and the calls of JobService.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/logged_server.h"
#include "weft/v1/job_service.grpc.pb.h"

namespace weft::server::testing {

// An answer, or the status of a call that failed.
template <class T>
struct Answer {
  grpc::Status status;
  T message;
};

struct Fetched {
  grpc::Status status;
  std::vector<v1::FetchMeshResponse> messages;

  std::vector<std::uint32_t> chunk_indices() const;
};

class JobClient {
 public:
  explicit JobClient(const std::shared_ptr<grpc::Channel>& channel)
      : stub_(v1::JobService::NewStub(channel)) {}

  Answer<v1::SubmitJobResponse> submit(const v1::SubmitJobRequest& request);
  // The id of the new job.
  std::string submit(const v1::GenerateMeshRequest& mesh);
  Answer<v1::GetJobResponse> get(const std::string& id);
  Answer<v1::CancelJobResponse> cancel(const std::string& id);
  Answer<v1::DeleteJobResponse> remove(const std::string& id);
  Answer<v1::ListJobsResponse> list(const v1::ListJobsRequest& request);
  // What a watch told, to its end.
  std::pair<grpc::Status, std::vector<v1::Job>> watch(const std::string& id);
  // The job in its final state.
  v1::Job wait(const std::string& id);
  Fetched fetch(const std::string& id, std::uint32_t first_chunk = 0);

  v1::JobService::Stub& stub() { return *stub_; }

 private:
  std::unique_ptr<v1::JobService::Stub> stub_;
};

// A request whose mesh no other number names.
v1::GenerateMeshRequest numbered_request(int number);

// No pauses, so that what takes long elsewhere does not here, and leases that the slowest machine
// renews in time.
JobOptions quick_jobs();

class JobServer {
 public:
  // On a store in this folder; on its own folder without one.
  explicit JobServer(EngineFn engine, const JobOptions& jobs = quick_jobs(),
                     const std::string& folder = {}, const ServiceOptions& service = {.jobs = 2});
  // Puts another store in front of the one in the folder.
  using Wrap = std::function<std::unique_ptr<JobStore>(std::unique_ptr<JobStore>)>;
  JobServer(EngineFn engine, const JobOptions& jobs, const Wrap& wrap);
  JobServer(EngineFn engine, const JobOptions& jobs, const ServiceOptions& service,
            const Wrap& wrap);

  Server& operator*() { return *server_; }
  Server* operator->() { return server_.get(); }
  std::shared_ptr<grpc::Channel> channel() const;
  JobClient client() const { return JobClient(channel()); }
  const Log& log() const { return log_; }
  // The value of a metric, see value_of.
  double metric(const std::string& series) const;
  void stop() { server_.reset(); }

 private:
  files::TempFolder own_folder_;
  Log log_;
  std::unique_ptr<Server> server_;
};

}  // namespace weft::server::testing
