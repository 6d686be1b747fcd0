// SPDX-License-Identifier: Apache-2.0
#include "client/call/job_server.h"

#include <algorithm>
#include <utility>

#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::client {
Result<JobServer> JobServer::connect(const CallOptions& options, std::stop_token stop) {
  if (options.server.server.empty())
    return fail(ExitCode::kUsage,
                "no server is named: give --server ADDR, or WEFT_SERVER. Jobs are kept by a server "
                "that stays; a private weftd ends with this command");
  auto connection = weft::client::connect(options.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  JobServer server(std::move(*connection), std::move(stop));
  server.set_limits(options.retries, options.timeout_seconds);
  return server;
}

JobServer::JobServer(Connection connection, std::stop_token stop)
    : connection_(std::move(connection)),
      stub_(v1::JobService::NewStub(connection_.channel)),
      stop_(std::move(stop)) {}

void JobServer::set_limits(std::uint32_t retries, std::optional<double> timeout_seconds) {
  retry_.attempts = retries;
  retry_.deadline = deadline_after(timeout_seconds);
}

Error JobServer::error_of(const grpc::Status& status, const RequestOrigin& origin) const {
  return weft::client::error_of(status, connection_.address, origin);
}

JobServer::Attempt::Attempt(const JobServer& server) : cancel_(server.stop_, Cancel{&context_}) {
  if (server.retry_.deadline) context_.set_deadline(*server.retry_.deadline);
}

template <class Stub, class Request, class Response>
grpc::Status JobServer::call(Stub& stub,
                             grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                          Response*),
                             const Request& request, Response& response, bool* repeated) {
  Retry retry = this->retry();
  for (bool first = true;; first = false) {
    if (repeated != nullptr) *repeated = !first;
    Attempt attempt(*this);
    const grpc::Status status = (stub.*method)(&attempt.context(), request, &response);
    if (status.ok() || !retry.again(status)) return status;
  }
}

Result<v1::Job> JobServer::submit(const v1::SubmitJobRequest& request,
                                  const RequestOrigin& origin) {
  v1::SubmitJobResponse response;
  if (const auto status = call(*stub_, &v1::JobService::Stub::SubmitJob, request, response);
      !status.ok())
    return tl::unexpected(error_of(status, origin));
  return std::move(*response.mutable_job());
}

Result<v1::Job> JobServer::get(const std::string& id) {
  v1::GetJobRequest request;
  request.set_id(id);
  v1::GetJobResponse response;
  if (const auto status = call(*stub_, &v1::JobService::Stub::GetJob, request, response);
      !status.ok())
    return tl::unexpected(error_of(status));
  return std::move(*response.mutable_job());
}

Result<v1::Job> JobServer::cancel(const std::string& id) {
  v1::CancelJobRequest request;
  request.set_id(id);
  v1::CancelJobResponse response;
  if (const auto status = call(*stub_, &v1::JobService::Stub::CancelJob, request, response);
      !status.ok())
    return tl::unexpected(error_of(status));
  return std::move(*response.mutable_job());
}

Result<void> JobServer::remove(const std::string& id) {
  v1::DeleteJobRequest request;
  request.set_id(id);
  v1::DeleteJobResponse response;
  bool repeated = false;
  const auto status = call(*stub_, &v1::JobService::Stub::DeleteJob, request, response, &repeated);
  // If the answer to an earlier try was lost, the job may be gone already.
  const bool gone = repeated && status.error_code() == grpc::StatusCode::NOT_FOUND;
  if (!status.ok() && !gone) return tl::unexpected(error_of(status));
  return {};
}

Result<std::vector<v1::Job>> JobServer::list(const std::vector<v1::JobState>& states,
                                             std::optional<std::uint64_t> limit) {
  // A page of so many jobs, with the longest errors, stays below gRPC's limit for a message.
  constexpr std::uint64_t kLargestPage = 500;
  std::vector<v1::Job> jobs;
  v1::ListJobsRequest request;
  for (const v1::JobState state : states) request.add_states(state);
  while (!limit || jobs.size() < *limit) {
    const std::uint64_t wanted = limit ? *limit - jobs.size() : kLargestPage;
    request.set_page_size(static_cast<std::uint32_t>(std::min(wanted, kLargestPage)));
    v1::ListJobsResponse page;
    if (const auto status = call(*stub_, &v1::JobService::Stub::ListJobs, request, page);
        !status.ok())
      return tl::unexpected(error_of(status));
    for (v1::Job& job : *page.mutable_jobs())
      if (!limit || jobs.size() < *limit) jobs.push_back(std::move(job));
    if (page.next_page_token().empty()) break;
    if (page.next_page_token() == request.page_token())
      return fail(ExitCode::kDataLoss,
                  "the server " + connection_.address + " sends one page of jobs again and again");
    request.set_page_token(page.next_page_token());
  }
  return jobs;
}

Result<v1::GetServerInfoResponse> JobServer::info() {
  v1::MeshService::Stub stub(connection_.channel);
  v1::GetServerInfoResponse response;
  if (const auto status =
          call(stub, &v1::MeshService::Stub::GetServerInfo, v1::GetServerInfoRequest(), response);
      !status.ok())
    return tl::unexpected(error_of(status));
  return response;
}

}  // namespace weft::client
