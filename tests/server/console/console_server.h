// SPDX-License-Identifier: Apache-2.0
// A server with a console on a real socket, and an engine that does what the test says.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/server/console/web_client.h"
#include "tests/server/logged_server.h"

namespace weft::server::testing {

inline ServerOptions with_console() {
  ServerOptions options{.listen = {"127.0.0.1:0"}, .service = {}};
  options.console.address = "127.0.0.1:0";
  return options;
}

inline EngineFn empty_mesh() {
  return [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); };
}

class ConsoleServer {
 public:
  explicit ConsoleServer(EngineFn engine = empty_mesh(),
                         const ServerOptions& options = with_console(),
                         std::unique_ptr<JobStore> store = nullptr) {
    auto started = Server::start(options, std::move(engine), log_.logger(), std::move(store));
    if (!started) throw std::runtime_error(started.error());
    server_ = std::move(*started);
    address_ = server_->console_address();
  }
  Server* operator->() { return server_.get(); }
  const std::string& address() const { return address_; }
  std::string http_address() const { return server_->http_address(); }
  const Log& log() const { return log_; }
  std::shared_ptr<grpc::Channel> channel() const {
    return channel_to(server_->addresses().front(), grpc::InsecureChannelCredentials());
  }

 private:
  Log log_;
  std::unique_ptr<Server> server_;
  std::string address_;
};

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::string reason_of(const WebOutcome& outcome) {
  return details_of(outcome.status()).error_info.reason();
}

}  // namespace weft::server::testing
