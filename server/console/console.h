// SPDX-License-Identifier: Apache-2.0
// The web server, over HTTP/1.1: the console, which is the application in a browser and gRPC-Web
// for every service of the server, and the routes of server/http/, on one port or on one each.
//
//   auto console = Console::start({.address = "127.0.0.1:0"}, {.channel = ..., ...});
//   if (!console) return complain(console.error());
//   ... (*console)->address() ...
//   (*console)->stop(end);
//
//   POST /package.Service/Method   a call, of the type application/grpc-web+proto
//   GET  /metrics                  what --metrics shows, for whoever may call
//   GET  /, /jobs, /mesh/...       the application
//   /v1/...                        what the routes answer (exchange.h)
//
// A call's bytes pass to the server through a channel within the process, so tokens, limits,
// deadlines, metrics and the log are those of gRPC. What is different: browsers open six
// connections to a host over HTTP/1.1, and each call has one to itself, so a seventh waits in the
// browser. A browser that goes away, or closes its half of the connection, cancels its call. A
// message is read into memory once its caller is known, and counted before, within `request_bytes`
// of all that are on their way.
//
// Limits: 16 KiB of headers, which have 10 s; 75 s between two requests; 60 s, or --stall-timeout,
// without a byte read. A connection beyond the limit, or beyond its host's share of it, closes the
// one that has been idle longest, of that host if it has too many, or is itself closed if none is.
//
// Thread-safety: every function may be called from any thread. One thread runs all connections.
#pragma once

#include <grpcpp/channel.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/console/assets.h"
#include "server/net/caller.h"
#include "server/net/reading_rate.h"
#include "server/net/tls.h"
#include "server/observe/log.h"

namespace weft::server {

class Routes;
struct SessionContext;

struct ConsoleOptions {
  std::string address{};               // HOST:PORT; empty: there is no console
  std::string http{};                  // HOST:PORT of the routes alone; empty: there is none
  std::vector<std::string> origins{};  // whose pages may call, see request_rules.h
  std::span<const Asset> assets{};     // of the application; empty: gRPC-Web only
  std::chrono::milliseconds header_timeout = std::chrono::seconds(10);
  std::chrono::milliseconds idle_timeout = std::chrono::seconds(75);
  std::size_t connections = 512;
  std::size_t meshes = 128;  // on their way over HTTP at the same time, until they are sent
  // Of their files. Default: nine tenths of what is free in their folder at the start.
  std::optional<std::uint64_t> file_bytes{};

  bool wanted() const { return !address.empty() || !http.empty(); }
};

struct ConsoleParts {
  std::shared_ptr<grpc::Channel> channel;  // within the process
  const Authenticator& authenticator;      // outlives the console
  std::string secret;                      // that it believes
  std::function<std::string()> metrics;    // called on a thread of the console
  TlsOptions tls{};
  bool insecure = false;                     // see credentials_for in connections.h
  std::uint64_t most_request_bytes = 0;      // of one message
  std::uint64_t request_bytes = 0;           // of messages on their way in, together
  double client_share = 1;                   // of these and of the connections, for one client
  ReaderPatience patience{};                 // with browsers that read slowly
  std::chrono::milliseconds body_timeout{};  // of the body of an exchange
  // Makes the routes, which end before what it is given.
  std::function<std::unique_ptr<Routes>(SessionContext&)> routes{};
  Logger log;
};

class Console {
 public:
  // The error names the address or file and what is wrong with it.
  static tl::expected<std::unique_ptr<Console>, std::string> start(const ConsoleOptions& options,
                                                                   ConsoleParts parts);
  // Ends what is open at once.
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  // As bound; empty: there is none.
  const std::string& address() const { return address_; }
  const std::string& http_address() const { return http_address_; }

  // Reads the certificates again for the next connection.
  void reload();

  // Accepts no more connections, closes idle ones and lets responses at work be written until
  // `end`, those of exchanges until `exchanges_end`; then closes all, which cancels their calls.
  // Returns when no call is open.
  void stop(std::chrono::steady_clock::time_point end,
            std::chrono::steady_clock::time_point exchanges_end);

 private:
  class Listener;
  explicit Console(std::unique_ptr<Listener> listener) noexcept;

  std::string address_;
  std::string http_address_;
  std::unique_ptr<Listener> listener_;
};

}  // namespace weft::server
