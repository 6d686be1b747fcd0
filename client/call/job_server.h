// SPDX-License-Identifier: Apache-2.0
// The calls of JobService, made again while the server is away (see retry.h). Each of them may be
// repeated without harm: a submission carries a request id.
//
// Errors: kUsage if no server is named, because a private one keeps no jobs; otherwise 64 + gRPC
// status. A requested stop cancels a call. Not thread-safe.
//
//   auto server = JobServer::connect({.server = {.server = "unix:/run/weftd"}}, stop);
//   if (!server) return tl::unexpected(server.error());
//   const Result<v1::Job> job = server->get("01J...");
#pragma once

#include <grpcpp/client_context.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "client/call/connect_options.h"
#include "client/call/connection.h"
#include "client/call/connection_retry.h"
#include "client/call/server_error.h"
#include "files/base/error.h"
#include "weft/v1/job_service.grpc.pb.h"

namespace weft::client {

class JobServer {
 public:
  static Result<JobServer> connect(const CallOptions& options, std::stop_token stop);
  // The time-out counts from now.
  void set_limits(std::uint32_t retries, std::optional<double> timeout_seconds);

  // `origin` is for errors. REQUIRES: a request_id.
  Result<v1::Job> submit(const v1::SubmitJobRequest& request, const RequestOrigin& origin = {});
  Result<v1::Job> get(const std::string& id);
  // Returns the job as it is afterwards.
  Result<v1::Job> cancel(const std::string& id);
  Result<void> remove(const std::string& id);
  // Jobs in one of the states, or all if none is named; the youngest first, at most `limit`.
  Result<std::vector<v1::Job>> list(const std::vector<v1::JobState>& states,
                                    std::optional<std::uint64_t> limit);
  // GetServerInfo of the same server's MeshService.
  Result<v1::GetServerInfoResponse> info();

  // One streaming call, which lives as long as this.
  class Attempt {
   public:
    explicit Attempt(const JobServer& server);
    grpc::ClientContext& context() { return context_; }

   private:
    struct Cancel {
      grpc::ClientContext* context;
      void operator()() const { context->TryCancel(); }
    };
    grpc::ClientContext context_;
    std::stop_callback<Cancel> cancel_;
  };
  v1::JobService::Stub& stub() { return *stub_; }
  Retry retry() const { return retry_on(connection_, retry_, stop_); }
  std::optional<Deadline> deadline() const { return retry_.deadline; }
  const std::stop_token& stop() const { return stop_; }
  Error error_of(const grpc::Status& status, const RequestOrigin& origin = {}) const;

  const Connection& connection() const { return connection_; }
  // Sets what is called with the first of several failures in a row. DEFAULT: a line on stderr.
  void on_away(std::function<void(const std::string&)> listener) {
    retry_.on_away = std::move(listener);
  }

 private:
  JobServer(Connection connection, std::stop_token stop);
  // `repeated` is whether the call was made more than once.
  template <class Stub, class Request, class Response>
  grpc::Status call(Stub& stub,
                    grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                    const Request& request, Response& response, bool* repeated = nullptr);

  Connection connection_;
  std::unique_ptr<v1::JobService::Stub> stub_;
  ConnectionRetryOptions retry_;
  std::stop_token stop_;
};

}  // namespace weft::client
