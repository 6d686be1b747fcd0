// SPDX-License-Identifier: Apache-2.0
#include "tests/client/support/fake_jobs.h"

#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "client/report/job_text.h"
#include "google/rpc/error_details.pb.h"
#include "tests/client/support/sample_stream.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

constexpr std::int64_t kBirth = 1'795'190'400;  // 2026-11-20T16:00:00Z

google::protobuf::Timestamp at(std::int64_t seconds) {
  google::protobuf::Timestamp time;
  time.set_seconds(kBirth + seconds);
  time.set_nanos(250'000'000);
  return time;
}

grpc::Status not_found(const std::string& id) {
  return {grpc::StatusCode::NOT_FOUND, "there is no job '" + id + "'"};
}

std::vector<v1::FetchMeshResponse> fetched(const std::vector<v1::GenerateMeshResponse>& stream) {
  std::vector<v1::FetchMeshResponse> out;
  for (const auto& message : stream)
    if (!message.has_progress()) {
      EXPECT_TRUE(out.emplace_back().ParseFromString(message.SerializeAsString()));
    }
  return out;
}

}  // namespace

FakeJobs::FakeJobs() : mesh(fetched(stream_of(square_mesh(4), 3))) {}

void FakeJobs::put(const v1::Job& job) {
  const std::lock_guard lock(mutex_);
  jobs_[job.id()] = {job, {}, ""};
}

std::optional<v1::Job> FakeJobs::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  return found == jobs_.end() ? std::nullopt : std::optional(found->second.job);
}

std::size_t FakeJobs::count() const {
  const std::lock_guard lock(mutex_);
  return jobs_.size();
}

void FakeJobs::plan(std::vector<v1::Job> steps) {
  const std::lock_guard lock(mutex_);
  plan_ = std::move(steps);
}

void FakeJobs::fail(const std::string& call, std::vector<Fault> faults) {
  const std::lock_guard lock(mutex_);
  faults_[call].assign(faults.begin(), faults.end());
}

std::size_t FakeJobs::calls(const std::string& call) const {
  const std::lock_guard lock(mutex_);
  const auto found = calls_.find(call);
  return found == calls_.end() ? 0 : found->second;
}

std::vector<v1::SubmitJobRequest> FakeJobs::submissions() const {
  const std::lock_guard lock(mutex_);
  return submissions_;
}

std::vector<std::uint32_t> FakeJobs::first_chunks() const {
  const std::lock_guard lock(mutex_);
  return first_chunks_;
}

std::vector<std::uint32_t> FakeJobs::page_sizes() const {
  const std::lock_guard lock(mutex_);
  return page_sizes_;
}

void FakeJobs::set_page_limit(std::size_t jobs) {
  const std::lock_guard lock(mutex_);
  page_limit_ = jobs;
}

std::optional<Fault> FakeJobs::enter(const std::string& call) {
  ++calls_[call];
  auto& faults = faults_[call];
  if (faults.empty()) return std::nullopt;
  const Fault fault = faults.front();
  faults.pop_front();
  return fault;
}

FakeJobs::Kept* FakeJobs::look_up(const std::string& id) {
  const auto found = jobs_.find(id);
  return found == jobs_.end() ? nullptr : &found->second;
}

grpc::Status FakeJobs::submit(const v1::SubmitJobRequest& request, v1::Job& out) {
  submissions_.push_back(request);
  EXPECT_TRUE(request.has_mesh());
  EXPECT_GT(request.mesh().domain().points_size(), 0);
  EXPECT_EQ(request.mesh().first_chunk(), 0u);
  EXPECT_LE(request.request_id().size(), 128u);
  EXPECT_TRUE(
      std::ranges::all_of(request.request_id(), [](char c) { return c >= 0x20 && c < 0x7f; }));
  const std::string key = request.mesh().SerializeAsString();
  for (const auto& [id, kept] : jobs_) {
    if (request.request_id().empty() || kept.job.request_id() != request.request_id()) continue;
    if (kept.key != key)
      return {grpc::StatusCode::ALREADY_EXISTS, "request_id was used for another mesh"};
    out = kept.job;
    return grpc::Status::OK;
  }
  const std::string id = "job-" + std::to_string(jobs_.size() + 1);
  Kept& kept = jobs_[id];
  kept.key = key;
  kept.steps.assign(plan_.begin(), plan_.end());
  if (kept.steps.empty()) kept.steps.push_back(sample_job(id, v1::JOB_STATE_QUEUED));
  for (v1::Job& step : kept.steps) {
    step.set_id(id);
    step.set_request_id(request.request_id());
  }
  out = kept.job = kept.steps.front();
  kept.steps.pop_front();
  return grpc::Status::OK;
}

grpc::Status FakeJobs::SubmitJob(grpc::ServerContext*, const v1::SubmitJobRequest* request,
                                 v1::SubmitJobResponse* response) {
  const std::lock_guard lock(mutex_);
  const auto fault = enter("SubmitJob");
  if (fault && !fault->done) return fault->status;
  const grpc::Status status = submit(*request, *response->mutable_job());
  return fault ? fault->status : status;
}

grpc::Status FakeJobs::GetJob(grpc::ServerContext*, const v1::GetJobRequest* request,
                              v1::GetJobResponse* response) {
  const std::lock_guard lock(mutex_);
  if (const auto fault = enter("GetJob")) return fault->status;
  const Kept* kept = look_up(request->id());
  if (kept == nullptr) return not_found(request->id());
  *response->mutable_job() = kept->job;
  return grpc::Status::OK;
}

// A token names the job before the page, and the states that were asked for.
grpc::Status FakeJobs::ListJobs(grpc::ServerContext*, const v1::ListJobsRequest* request,
                                v1::ListJobsResponse* response) {
  const std::lock_guard lock(mutex_);
  if (const auto fault = enter("ListJobs")) return fault->status;
  page_sizes_.push_back(request->page_size());
  EXPECT_LE(request->page_size(), 1000u);
  std::string states = "|";
  for (const int state : request->states()) {
    EXPECT_NE(state, v1::JOB_STATE_UNSPECIFIED);
    states += std::to_string(state);
  }
  std::string before;
  if (const std::string& token = request->page_token(); !token.empty()) {
    EXPECT_TRUE(token.ends_with(states)) << "the states of the page before were others";
    before = token.substr(0, token.rfind('|'));
  }
  const std::size_t size =
      std::min<std::size_t>(request->page_size() == 0 ? 100 : request->page_size(), page_limit_);
  for (auto at = jobs_.rbegin(); at != jobs_.rend(); ++at) {
    const v1::Job& job = at->second.job;
    if (!before.empty() && job.id() >= before) continue;
    if (!request->states().empty() && std::ranges::count(request->states(), job.state()) == 0)
      continue;
    if (static_cast<std::size_t>(response->jobs_size()) == size) {
      response->set_next_page_token(response->jobs(response->jobs_size() - 1).id() + states);
      break;
    }
    *response->add_jobs() = job;
    response->mutable_jobs(response->jobs_size() - 1)->clear_summary();
  }
  return grpc::Status::OK;
}

grpc::Status FakeJobs::WatchJob(grpc::ServerContext*, const v1::WatchJobRequest* request,
                                grpc::ServerWriter<v1::WatchJobResponse>* writer) {
  std::optional<Fault> fault;
  {
    const std::lock_guard lock(mutex_);
    fault = enter("WatchJob");
  }
  for (std::size_t sent = 0;; ++sent) {
    v1::WatchJobResponse message;
    {
      const std::lock_guard lock(mutex_);
      if (fault && sent == fault->messages) return fault->status;
      Kept* kept = look_up(request->id());
      if (kept == nullptr) return not_found(request->id());
      if (sent > 0 && is_final(kept->job.state())) return grpc::Status::OK;
      if (sent > 0 && kept->steps.empty()) {
        ADD_FAILURE() << "a job is watched that never ends";
        return grpc::Status::OK;
      }
      if (sent > 0) {
        kept->job = kept->steps.front();
        kept->steps.pop_front();
      }
      *message.mutable_job() = kept->job;
    }
    if (!writer->Write(message)) return grpc::Status::CANCELLED;
  }
}

grpc::Status FakeJobs::CancelJob(grpc::ServerContext*, const v1::CancelJobRequest* request,
                                 v1::CancelJobResponse* response) {
  const std::lock_guard lock(mutex_);
  const auto fault = enter("CancelJob");
  if (fault && !fault->done) return fault->status;
  Kept* kept = look_up(request->id());
  if (kept == nullptr) return not_found(request->id());
  if (!is_final(kept->job.state())) kept->job = sample_job(request->id(), v1::JOB_STATE_CANCELLED);
  *response->mutable_job() = kept->job;
  return fault ? fault->status : grpc::Status::OK;
}

grpc::Status FakeJobs::DeleteJob(grpc::ServerContext*, const v1::DeleteJobRequest* request,
                                 v1::DeleteJobResponse*) {
  const std::lock_guard lock(mutex_);
  const auto fault = enter("DeleteJob");
  if (fault && !fault->done) return fault->status;
  const Kept* kept = look_up(request->id());
  if (kept == nullptr) return not_found(request->id());
  if (!is_final(kept->job.state()))
    return {grpc::StatusCode::FAILED_PRECONDITION, "the job has not ended"};
  jobs_.erase(request->id());
  return fault ? fault->status : grpc::Status::OK;
}

grpc::Status FakeJobs::FetchMesh(grpc::ServerContext*, const v1::FetchMeshRequest* request,
                                 grpc::ServerWriter<v1::FetchMeshResponse>* writer) {
  std::optional<Fault> fault;
  {
    const std::lock_guard lock(mutex_);
    fault = enter("FetchMesh");
    first_chunks_.push_back(request->first_chunk());
    const Kept* kept = look_up(request->id());
    if (kept == nullptr) return not_found(request->id());
    if (kept->job.state() != v1::JOB_STATE_SUCCEEDED)
      return {grpc::StatusCode::FAILED_PRECONDITION, "the job has not succeeded"};
  }
  const auto chunks = static_cast<std::uint32_t>(std::ranges::count_if(
      mesh, [](const v1::FetchMeshResponse& message) { return message.has_chunk(); }));
  if (request->first_chunk() > chunks)
    return {grpc::StatusCode::OUT_OF_RANGE, "the mesh has fewer chunks"};
  std::size_t sent = 0;
  for (const auto& message : mesh) {
    if (fault && sent == fault->messages) return fault->status;
    if (message.has_chunk() && message.chunk().index() < request->first_chunk()) continue;
    if (!writer->Write(message)) return grpc::Status::CANCELLED;
    ++sent;
  }
  return fault ? fault->status : grpc::Status::OK;
}

JobsServer::JobsServer(std::string address) : address_(std::move(address)), meshes_({Script{}}) {
  start();
}

void JobsServer::start() {
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address_, grpc::InsecureServerCredentials());
  builder.RegisterService(&jobs_);
  builder.RegisterService(&meshes_);
  server_ = builder.BuildAndStart();
  EXPECT_NE(server_, nullptr);
}

void JobsServer::stop() {
  if (server_) server_->Shutdown(std::chrono::system_clock::now());
  server_.reset();
}

v1::Job sample_job(const std::string& id, v1::JobState state) {
  v1::Job job;
  job.set_id(id);
  job.set_state(state);
  *job.mutable_create_time() = at(0);
  if (state != v1::JOB_STATE_QUEUED) {
    *job.mutable_start_time() = at(1);
    job.set_attempts(1);
    job.set_worker("mill-1");
  }
  if (is_final(state)) *job.mutable_end_time() = at(5);
  if (state == v1::JOB_STATE_RUNNING) {
    job.mutable_progress()->set_stage(v1::STAGE_REFINE);
    job.mutable_progress()->set_triangles(1000);
    job.mutable_progress()->set_expected_triangles(4000);
    job.mutable_progress()->set_elapsed_seconds(1.5);
    job.mutable_progress()->set_fraction(0.25);
  }
  if (state == v1::JOB_STATE_SUCCEEDED)
    *job.mutable_summary() = stream_of(square_mesh(4), 3).back().summary();
  if (state == v1::JOB_STATE_FAILED) *job.mutable_error() = sample_error();
  return job;
}

google::rpc::Status sample_error() {
  google::rpc::Status error;
  error.set_code(static_cast<int>(grpc::StatusCode::RESOURCE_EXHAUSTED));
  error.set_message("the mesh needs more than 1000 bytes");
  google::rpc::ErrorInfo info;
  info.set_reason("BUDGET_EXCEEDED");
  error.add_details()->PackFrom(info);
  return error;
}

grpc::Status queue_full(std::int64_t milliseconds) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason("QUEUE_FULL");
  details.add_details()->PackFrom(info);
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(milliseconds / 1000);
  retry.mutable_retry_delay()->set_nanos(
      static_cast<std::int32_t>(milliseconds % 1000 * 1'000'000));
  details.add_details()->PackFrom(retry);
  return {grpc::StatusCode::RESOURCE_EXHAUSTED, "64 calls wait already",
          details.SerializeAsString()};
}

}  // namespace weft::client
