// SPDX-License-Identifier: Apache-2.0
// JobService as its contract says, in memory, for tests of its clients. It checks what it is sent:
// what the contract forbids fails the test.
//
// Jobs are made by submissions, or by `put`. They change as the test says: `plan` is what a job
// goes through while it is watched, one step per message. Every mesh is square_mesh(4) in 3 chunks.
//
// `fail` makes calls go wrong: the next call of that name, then the one after it, ...
// Thread-safe.
#pragma once

#include <grpcpp/server.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tests/client/support/fake_service.h"
#include "weft/v1/job_service.grpc.pb.h"

namespace weft::client {

// A call of a fake that goes wrong.
struct Fault {
  grpc::Status status{grpc::StatusCode::UNAVAILABLE, "gone"};
  // Where the call has an answer: whether what was asked for is done, and only the answer lost.
  bool done = false;
  // Where it is a stream: messages that are sent before.
  std::size_t messages = 0;
};

class FakeJobs final : public v1::JobService::Service {
 public:
  FakeJobs();

  void put(const v1::Job& job);
  std::optional<v1::Job> find(const std::string& id) const;
  std::size_t count() const;
  // Of every job that is submitted from now on.
  void plan(std::vector<v1::Job> steps);
  // The next calls of "SubmitJob" and so on, one fault each.
  void fail(const std::string& call, std::vector<Fault> faults);
  // How often it was called.
  std::size_t calls(const std::string& call) const;
  // What came, in order.
  std::vector<v1::SubmitJobRequest> submissions() const;
  std::vector<std::uint32_t> first_chunks() const;
  std::vector<std::uint32_t> page_sizes() const;
  void set_page_limit(std::size_t jobs);  // at most so many in a page, whatever is asked for

  grpc::Status SubmitJob(grpc::ServerContext* context, const v1::SubmitJobRequest* request,
                         v1::SubmitJobResponse* response) override;
  grpc::Status GetJob(grpc::ServerContext* context, const v1::GetJobRequest* request,
                      v1::GetJobResponse* response) override;
  grpc::Status ListJobs(grpc::ServerContext* context, const v1::ListJobsRequest* request,
                        v1::ListJobsResponse* response) override;
  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override;
  grpc::Status CancelJob(grpc::ServerContext* context, const v1::CancelJobRequest* request,
                         v1::CancelJobResponse* response) override;
  grpc::Status DeleteJob(grpc::ServerContext* context, const v1::DeleteJobRequest* request,
                         v1::DeleteJobResponse* response) override;
  grpc::Status FetchMesh(grpc::ServerContext* context, const v1::FetchMeshRequest* request,
                         grpc::ServerWriter<v1::FetchMeshResponse>* writer) override;

  // The stream of FetchMesh; may be changed before calls are made.
  std::vector<v1::FetchMeshResponse> mesh;

 private:
  struct Kept {
    v1::Job job;
    std::deque<v1::Job> steps;
    std::string key;  // the mesh that was asked for
  };
  // Counts the call; the fault that it meets.
  std::optional<Fault> enter(const std::string& call);
  Kept* look_up(const std::string& id);
  grpc::Status submit(const v1::SubmitJobRequest& request, v1::Job& out);

  mutable std::mutex mutex_;
  std::map<std::string, Kept> jobs_;  // ids sort by age
  std::vector<v1::Job> plan_;
  std::map<std::string, std::deque<Fault>> faults_;
  std::map<std::string, std::size_t> calls_;
  std::vector<v1::SubmitJobRequest> submissions_;
  std::vector<std::uint32_t> first_chunks_;
  std::vector<std::uint32_t> page_sizes_;
  std::size_t page_limit_ = 1000;
};

// Serves it, with a MeshService beside it. Starts and stops as often as the test likes, on one
// address.
class JobsServer {
 public:
  explicit JobsServer(std::string address);
  ~JobsServer() { stop(); }
  void start();
  void stop();
  FakeJobs& jobs() { return jobs_; }
  const std::string& address() const { return address_; }

 private:
  std::string address_;
  FakeJobs jobs_;
  FakeService meshes_;
  std::unique_ptr<grpc::Server> server_;
};

// A job in this state as the contract has it: times, progress, error, summary where they belong.
v1::Job sample_job(const std::string& id, v1::JobState state);

// RESOURCE_EXHAUSTED (BUDGET_EXCEEDED), as Job.error has it.
google::rpc::Status sample_error();

// The status of a full queue, which asks to wait for so long.
grpc::Status queue_full(std::int64_t milliseconds);

}  // namespace weft::client
