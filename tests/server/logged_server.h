// SPDX-License-Identifier: Apache-2.0
// A server with any options, whose log the test can read.
#pragma once

#include <spdlog/sinks/sink.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "tests/server/harness.h"

namespace weft::server::testing {

// What was logged, without times and levels. Thread-safe.
class Log {
 public:
  const Logger& logger() const { return logger_; }
  std::string text() const { return sink_->text(); }
  bool contains(const std::string& words) const { return text().find(words) != std::string::npos; }

 private:
  class Sink final : public spdlog::sinks::sink {
   public:
    std::string text() const {
      std::lock_guard lock(mutex_);
      return text_;
    }
    void log(const spdlog::details::log_msg& message) override {
      std::lock_guard lock(mutex_);
      text_.append(message.payload.data(), message.payload.size()).push_back('\n');
    }
    void flush() override {}
    void set_pattern(const std::string&) override {}
    void set_formatter(std::unique_ptr<spdlog::formatter>) override {}

   private:
    mutable std::mutex mutex_;  // guards the one below
    std::string text_;
  };

  const std::shared_ptr<Sink> sink_ = std::make_shared<Sink>();
  const Logger logger_ = std::make_shared<spdlog::logger>("test", sink_);
};

// Looks again and again until it is so; false after kPatience.
inline bool eventually(const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

// Its meshes are empty, unless another engine is given.
class LoggedServer {
 public:
  explicit LoggedServer(
      const ServerOptions& options, std::unique_ptr<JobStore> store = nullptr,
      const EngineFn& engine = [](const auto&, ChunkSink& sink, auto&) {
        return send_chunks(sink, 0);
      }) {
    auto started = Server::start(options, engine, log_.logger(), std::move(store));
    if (!started) throw std::runtime_error(started.error());
    server_ = std::move(*started);
  }
  Server* operator->() { return server_.get(); }
  const std::string& address() const { return server_->addresses().front(); }
  const Log& log() const { return log_; }

 private:
  Log log_;
  std::unique_ptr<Server> server_;
};

// Why a server does not start; empty where it does.
inline std::string refusal_to_start(const ServerOptions& options) {
  const auto started = Server::start(options, {}, make_logger("off"));
  return started ? "" : started.error();
}

inline std::shared_ptr<grpc::Channel> channel_to(
    const std::string& address, const std::shared_ptr<grpc::ChannelCredentials>& credentials,
    grpc::ChannelArguments arguments = {}) {
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);  // a connection of its own
  return grpc::CreateCustomChannel(address, credentials, arguments);
}

// GetServerInfo.
inline grpc::Status ask(const std::shared_ptr<grpc::Channel>& channel,
                        const std::string& authorization = "") {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kPatience);
  if (!authorization.empty()) context.AddMetadata("authorization", authorization);
  v1::GetServerInfoResponse info;
  return v1::MeshService::NewStub(channel)->GetServerInfo(&context, {}, &info);
}

}  // namespace weft::server::testing
