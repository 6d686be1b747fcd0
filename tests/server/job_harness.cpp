// SPDX-License-Identifier: Apache-2.0
#include "tests/server/job_harness.h"

#include <stdexcept>

#include "tests/support/connected.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

std::unique_ptr<JobStore> open_store(const std::string& folder) {
  auto store = SqliteStore::open({.folder = folder});
  if (!store) throw std::runtime_error(store.error().message);
  return std::move(*store);
}

std::unique_ptr<Server> start(EngineFn engine, const JobOptions& jobs,
                              const ServiceOptions& service, const Log& log,
                              std::unique_ptr<JobStore> store) {
  auto started = Server::start(
      {.listen = {"127.0.0.1:0"}, .service = service, .jobs = jobs, .metrics = "127.0.0.1:0"},
      std::move(engine), log.logger(), std::move(store));
  if (!started) throw std::runtime_error(started.error());
  return std::move(*started);
}

}  // namespace

std::vector<std::uint32_t> Fetched::chunk_indices() const {
  std::vector<std::uint32_t> indices;
  for (const auto& message : messages)
    if (message.has_chunk()) indices.push_back(message.chunk().index());
  return indices;
}

Answer<v1::SubmitJobResponse> JobClient::submit(const v1::SubmitJobRequest& request) {
  grpc::ClientContext context;
  Answer<v1::SubmitJobResponse> answer;
  answer.status = stub_->SubmitJob(&context, request, &answer.message);
  return answer;
}

std::string JobClient::submit(const v1::GenerateMeshRequest& mesh) {
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = mesh;
  const auto answer = submit(request);
  if (!answer.status.ok()) throw std::runtime_error(answer.status.error_message());
  return answer.message.job().id();
}

Answer<v1::GetJobResponse> JobClient::get(const std::string& id) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_id(id);
  Answer<v1::GetJobResponse> answer;
  answer.status = stub_->GetJob(&context, request, &answer.message);
  return answer;
}

Answer<v1::CancelJobResponse> JobClient::cancel(const std::string& id) {
  grpc::ClientContext context;
  v1::CancelJobRequest request;
  request.set_id(id);
  Answer<v1::CancelJobResponse> answer;
  answer.status = stub_->CancelJob(&context, request, &answer.message);
  return answer;
}

Answer<v1::DeleteJobResponse> JobClient::remove(const std::string& id) {
  grpc::ClientContext context;
  v1::DeleteJobRequest request;
  request.set_id(id);
  Answer<v1::DeleteJobResponse> answer;
  answer.status = stub_->DeleteJob(&context, request, &answer.message);
  return answer;
}

Answer<v1::ListJobsResponse> JobClient::list(const v1::ListJobsRequest& request) {
  grpc::ClientContext context;
  Answer<v1::ListJobsResponse> answer;
  answer.status = stub_->ListJobs(&context, request, &answer.message);
  return answer;
}

std::pair<grpc::Status, std::vector<v1::Job>> JobClient::watch(const std::string& id) {
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_id(id);
  const auto reader = stub_->WatchJob(&context, request);
  std::vector<v1::Job> told;
  v1::WatchJobResponse message;
  while (reader->Read(&message)) told.push_back(message.job());
  return {reader->Finish(), std::move(told)};
}

v1::Job JobClient::wait(const std::string& id) {
  const auto [status, told] = watch(id);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return told.empty() ? v1::Job() : told.back();
}

Fetched JobClient::fetch(const std::string& id, std::uint32_t first_chunk) {
  grpc::ClientContext context;
  v1::FetchMeshRequest request;
  request.set_id(id);
  request.set_first_chunk(first_chunk);
  const auto reader = stub_->FetchMesh(&context, request);
  Fetched fetched;
  v1::FetchMeshResponse message;
  while (reader->Read(&message)) fetched.messages.push_back(std::move(message));
  fetched.status = reader->Finish();
  return fetched;
}

v1::GenerateMeshRequest numbered_request(int number) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(1 + number);
  return request;
}

JobOptions quick_jobs() {
  JobOptions jobs;
  jobs.runner.lease = kPatience;
  jobs.runner.renewal = std::chrono::milliseconds(20);
  jobs.retry.first_delay = std::chrono::milliseconds(1);
  jobs.service.tick = std::chrono::milliseconds(20);
  return jobs;
}

JobServer::JobServer(EngineFn engine, const JobOptions& jobs, const std::string& folder,
                     const ServiceOptions& service)
    : server_(start(std::move(engine), jobs, service, log_,
                    open_store(folder.empty() ? own_folder_.path().string() : folder))) {}

JobServer::JobServer(EngineFn engine, const JobOptions& jobs, const Wrap& wrap)
    : JobServer(std::move(engine), jobs, ServiceOptions{.jobs = 2}, wrap) {}

JobServer::JobServer(EngineFn engine, const JobOptions& jobs, const ServiceOptions& service,
                     const Wrap& wrap)
    : server_(start(std::move(engine), jobs, service, log_,
                    wrap(open_store(own_folder_.path().string())))) {}

double JobServer::metric(const std::string& series) const {
  return weft::testing::value_of(weft::testing::http(server_->metrics_address(), "GET", "/metrics"),
                                 series);
}

std::shared_ptr<grpc::Channel> JobServer::channel() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);  // a connection of its own
  arguments.SetMaxReceiveMessageSize(-1);
  return connected(grpc::CreateCustomChannel(server_->addresses().front(),
                                             grpc::InsecureChannelCredentials(), arguments));
}

}  // namespace weft::server::testing
