// SPDX-License-Identifier: Apache-2.0
// Closes connections that begin calls and reset them: each costs the client two frames of a few
// bytes and the server a call, and gRPC 1.51 bounds neither the rate nor, since a reset stream no
// longer counts as open, the number ("HTTP/2 rapid reset", CVE-2023-44487).
//
// gRPC may not tell of resets for as long as one connection brings more: it takes calls up, and
// ends none (200,000 in a minute, 4 GB). So calls are counted, too, that began and have not ended:
// more than four times the streams that HTTP/2 lets a connection have open are being reset.
//
// A connection is known by its peer's address. Those of unix sockets cannot be told apart, so their
// calls are not counted: the folder of the socket guards them.
//
// Law: honest clients reset a call for every wish of their users; a client that stops all its
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
  // Of one connection, begun and not ended.
  static constexpr std::uint64_t kMostOpen = 4 * kMostStreams;

  // 0: no bound.
  explicit ResetGuard(std::uint64_t resets_a_second) : most_(resets_a_second) {}

  // Both are true if it is one call too many, and its connection is to be closed: once a second for
  // each peer, and whenever the bound on calls that have not ended is crossed.
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

// Shuts the connections down whose other end has this address, spelled as gRPC spells peers:
// ipv4:HOST:PORT or ipv6:%5BHOST%5D:PORT. gRPC then ends their calls. Returns how many there were.
int close_connections_of(const std::string& peer);

}  // namespace weft::server
