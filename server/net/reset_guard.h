// SPDX-License-Identifier: Apache-2.0
// Closes connections that begin calls and reset them: each costs the client two frames of a few
// bytes and the server a call, and gRPC 1.51 bounds neither the rate nor, since a reset stream no
// longer counts as open, the number ("HTTP/2 rapid reset", CVE-2023-44487).
//
// gRPC may not report resets while a connection sends more of them: it begins calls, and ends none
// (200,000 in a minute, 4 GB). So calls that began and have not ended are counted, too: if there
// are more than twice the streams that HTTP/2 lets a connection have open, they are being reset.
// Each takes 70 KB of gRPC.
//
// A connection is identified by its peer's address. Those of unix sockets cannot be told apart, so
// their calls are not counted: the folder of the socket protects them. Nor are those of the
// console, which come from within the process: over HTTP/1.1 a reset costs the browser its
// connection.
//
// Law: honest clients reset calls only when their users cancel; a client that stops all its
// calls at once resets as many as GRPC_ARG_MAX_CONCURRENT_STREAMS. The bound is well above that.
// Thread-safety: every function may be called from any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

#include "server/net/connections.h"

namespace weft::server {

class ResetGuard {
 public:
  using Clock = std::chrono::steady_clock;
  // Maximum calls of one connection that began and have not ended.
  static constexpr std::uint64_t kMostOpen = 2 * kMostStreams;

  // 0: no bound.
  explicit ResetGuard(std::uint64_t resets_a_second) : most_(resets_a_second) {}

  // Both return true if the connection must be closed because this call exceeds a bound: once per
  // second and peer, and whenever the bound on calls that have not ended is crossed.
  bool was_reset(const std::string& peer, Clock::time_point now = Clock::now());
  bool began(const std::string& peer);

  void ended(const std::string& peer);

 private:
  bool counts(const std::string& peer) const;

  const std::uint64_t most_;
  std::mutex mutex_;  // guards the three below
  std::unordered_map<std::string, std::uint64_t> open_;
  Clock::time_point second_{};
  std::unordered_map<std::string, std::uint64_t> counts_;  // of this second
};

// Shuts down the connections whose other end has this address, spelled as gRPC spells peers:
// ipv4:HOST:PORT or ipv6:%5BHOST%5D:PORT. gRPC then ends their calls. Returns their number.
int close_connections_of(const std::string& peer);

}  // namespace weft::server
