// SPDX-License-Identifier: Apache-2.0
// A MeshService that streams what it is told to, and then ends as it is told to.
#pragma once

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <functional>
#include <memory>
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
  explicit FakeService(Script script) : script_(std::move(script)) {}

  grpc::Status GenerateMesh(grpc::ServerContext* context, const v1::GenerateMeshRequest* request,
                            grpc::ServerWriter<v1::GenerateMeshResponse>* writer) override {
    request_ = *request;
    for (const auto& message : script_.messages)
      if (!writer->Write(message)) return grpc::Status::CANCELLED;
    return script_.end(*context);
  }
  grpc::Status GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*,
                             v1::GetServerInfoResponse* response) override {
    response->set_version("9.9.9");
    response->set_threads(2);
    response->mutable_limits()->set_max_points(1234567);
    return grpc::Status::OK;
  }
  // The last one. REQUIRES: its call has ended.
  const v1::GenerateMeshRequest& request() const { return request_; }

 private:
  Script script_;
  v1::GenerateMeshRequest request_;
};

class FakeServer {
 public:
  FakeServer(Script script, const std::string& address) : service_(std::move(script)) {
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
