// SPDX-License-Identifier: Apache-2.0
// A MeshService that streams what it is told to, less the chunks that the client has, and then ends
// as it is told to.
#pragma once

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::client {

struct Script {
  std::vector<v1::GenerateMeshResponse> messages;
  // Called after the messages; its status ends the call.
  std::function<grpc::Status(grpc::ServerContext&)> end = [](grpc::ServerContext&) {
    return grpc::Status::OK;
  };
};

class FakeService final : public v1::MeshService::Service {
 public:
  // One script a call; the last one serves all that follow.
  explicit FakeService(std::vector<Script> scripts) : scripts_(std::move(scripts)) {}

  grpc::Status GenerateMesh(grpc::ServerContext* context, const v1::GenerateMeshRequest* request,
                            grpc::ServerWriter<v1::GenerateMeshResponse>* writer) override {
    const Script& script = script_for(*request);
    for (const auto& message : script.messages) {
      if (message.has_chunk() && message.chunk().index() < request->first_chunk()) continue;
      if (!writer->Write(message)) return grpc::Status::CANCELLED;
    }
    return script.end(*context);
  }
  grpc::Status GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*,
                             v1::GetServerInfoResponse* response) override {
    response->set_version("9.9.9");
    response->set_threads(2);
    response->mutable_limits()->set_max_points(1234567);
    return grpc::Status::OK;
  }
  // One a call.
  std::vector<v1::GenerateMeshRequest> requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

 private:
  const Script& script_for(const v1::GenerateMeshRequest& request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    return scripts_[std::min(requests_.size(), scripts_.size()) - 1];
  }

  const std::vector<Script> scripts_;
  mutable std::mutex mutex_;
  std::vector<v1::GenerateMeshRequest> requests_;  // guarded by mutex_
};

class FakeServer {
 public:
  FakeServer(Script script, const std::string& address)
      : FakeServer(std::vector<Script>{std::move(script)}, address) {}
  FakeServer(std::vector<Script> scripts, const std::string& address)
      : service_(std::move(scripts)) {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
  }
  ~FakeServer() {
    if (server_) server_->Shutdown(std::chrono::system_clock::now());
  }
  bool listens() const { return server_ != nullptr; }
  FakeService& service() { return service_; }

 private:
  FakeService service_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace weft::client
