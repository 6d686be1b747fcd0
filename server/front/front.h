// SPDX-License-Identifier: Apache-2.0
// What stands between TCP and gRPC: accepts connections, ends TLS, and passes on what the rules of
// connection_rules.h and connection_table.h allow.
//
// gRPC 1.51 accepts without a bound, stops accepting for good once descriptors run out, and bounds
// neither header blocks nor streams nor frames. So weftd accepts itself. gRPC gets a connection
// once the client has shown its handshake and its preface, as one end of a pair of unix sockets;
// `ConnectionTable::find` tells the client's address and certificate by that end's name, which is
// the peer of its calls. Connections of unix addresses are gRPC's own: their folder protects them.
//
//   auto front = Front::open({.listen = {"127.0.0.1:0"}}, table, log);
//   if (!front) return complain(front.error());
//   auto acceptor = builder.experimental().AddExternalConnectionAcceptor(...);
//   ... start gRPC ...
//   (*front)->start(std::move(acceptor));
//
// A connection has 20 s for its handshake and preface. If descriptors run out, one that is kept in
// reserve accepts and closes, and accepting goes on.
//
// Thread-safety: every function may be called from any thread, one at a time.
#pragma once

#include <grpcpp/server_builder.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/connection_table.h"
#include "server/net/tls.h"
#include "server/observe/log.h"

namespace weft::server {

struct FrontOptions {
  std::vector<std::string> listen{};  // HOST:PORT
  TlsOptions tls{};
  std::uint64_t max_resets = 600;  // see connection_rules.h
  unsigned lanes = 1;              // threads that move bytes
};

class Front {
 public:
  // Called for each connection that is closed by a rule, on any thread.
  using OnClosed = std::function<void(const char* cause)>;

  // Listens at every address or at none; `table` outlives the front. The error names the address or
  // file.
  static tl::expected<std::unique_ptr<Front>, std::string> open(const FrontOptions& options,
                                                                ConnectionTable& table, Logger log,
                                                                OnClosed on_closed);
  // Ends what is open at once.
  ~Front();
  Front(const Front&) = delete;
  Front& operator=(const Front&) = delete;

  // As bound, in the order of the options.
  const std::vector<int>& ports() const;

  // Begins to accept. gRPC has been started, and lives until `stop_accepting`.
  void start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc);
  // Reads the certificates again for the next connection.
  void reload();
  void stop_accepting();
  // Lets connections that gRPC has closed send what is left, until `end`. REQUIRES: gRPC has shut
  // down.
  void finish(std::chrono::steady_clock::time_point end);

 private:
  class Door;
  explicit Front(std::unique_ptr<Door> door);

  std::unique_ptr<Door> door_;
};

}  // namespace weft::server
