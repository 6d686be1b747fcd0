// SPDX-License-Identifier: Apache-2.0
// A weftd that only this process uses, on a unix socket in a new folder that only this user may
// enter.
//
// It never outlives this process: the destructor kills it, because it keeps nothing that could be
// lost, and removes the folder; if this process is killed, the pipe to its standard input closes,
// and `--exit-with-stdin` ends it.
//
//   auto server = PrivateServer::start({}, stop);
//   if (!server) return tl::unexpected(server.error());
//   auto channel = grpc::CreateChannel((*server)->address(), ...);
//
// Errors (kServerNotStarted): no weftd is found, it cannot be run, it ends at start (with its last
// lines of log) or is not ready in time.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "client/base/files.h"
#include "files/base/atomic_file.h"
#include "files/base/error.h"

namespace weft::client {

struct PrivateServerOptions {
  // DEFAULT: $WEFT_WEFTD, or weftd beside this program's binary, or weftd in the PATH.
  std::optional<std::filesystem::path> weftd;
  // Runs at the same time, each of which may take that part of the memory. DEFAULT: weftd's own.
  std::optional<int> jobs = std::nullopt;
  std::chrono::milliseconds start_timeout{30'000};
};

class PrivateServer {
 public:
  // Returns when the server listens. `meanwhile` is called while it starts, and may connect to the
  // address, but not call yet.
  static Result<std::unique_ptr<PrivateServer>> start(
      const PrivateServerOptions& options, std::stop_token stop,
      const std::function<void(const std::string& address)>& meanwhile = {});
  ~PrivateServer();
  PrivateServer(const PrivateServer&) = delete;
  PrivateServer& operator=(const PrivateServer&) = delete;

  // As gRPC takes it: "unix:/tmp/weft-x1y2z3/socket".
  std::string address() const { return "unix:" + (folder_ / "socket").string(); }
  pid_t pid() const { return pid_; }
  // The last lines that it wrote to stderr, indented; empty if there are none.
  std::string last_log_lines() const;

 private:
  using Clock = std::chrono::steady_clock;

  explicit PrivateServer(const PrivateServerOptions& options) : options_(options) {}
  Result<void> make_folder();
  Result<void> spawn(const std::filesystem::path& weftd);
  Result<void> wait_until_ready(const std::filesystem::path& weftd, Clock::time_point deadline,
                                std::stop_token stop);

  PrivateServerOptions options_;
  std::filesystem::path folder_;
  FileDescriptor input_;    // this process's end of its standard input
  FileDescriptor output_;   // and of its standard output
  FileDescriptor process_;  // a pidfd: readable when it has ended
  pid_t pid_ = 0;
};

}  // namespace weft::client
