// SPDX-License-Identifier: Apache-2.0
// One connection of a browser: HTTP/1.1, one request after the other. Only console.cpp uses it.
//
// Reads no further ahead than one window of a body, and holds at most two messages of a response:
// one that is being written, and the next; of a file, one window. A browser that reads nothing
// therefore stops the call; one that reads too slowly loses the connection.
// Thread-safety: none; everything runs on the console's thread.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>

#include "server/console/assets.h"
#include "server/console/bridge_call.h"
#include "server/console/exchange.h"
#include "server/console/frames.h"
#include "server/console/request_rules.h"
#include "server/net/caller.h"
#include "server/net/drain_gate.h"
#include "server/net/reading_rate.h"

namespace weft::server {

struct SessionTimes {
  std::chrono::milliseconds header;  // for the handshake, and for one request's header
  std::chrono::milliseconds idle;    // between two requests
  std::chrono::milliseconds body;    // of an exchange, from its header to its end
};

// One of the addresses that are listened on.
struct Door {
  bool console = false;  // leads to pages and calls, too, not to the routes alone
  OriginRules rules{};
};

class Session {
 public:
  virtual ~Session() = default;
  virtual void start() = 0;
  // Ends at once.
  virtual void close() = 0;
  // Ends once the response at work, if any, is written.
  virtual void finish() = 0;
  // Whether it waits for a request, or for the rest of one's header.
  virtual bool idle() const = 0;
  // The address that it comes from, without its port.
  virtual const std::string& host() const = 0;
  // Whether it has, or writes the answer of, an exchange.
  virtual bool exchanging() const = 0;
};

// What all sessions share. Outlives them.
struct SessionContext {
  boost::asio::io_context& io;
  BridgeStub& stub;
  DrainGate& calls;
  const Authenticator& authenticator;
  std::string secret;  // see caller.h
  std::span<const Asset> assets;
  std::function<std::string()> metrics;
  SessionTimes times;
  ReaderPatience patience;
  std::uint64_t most_request_bytes;
  ByteBudget budget;
  Routes* routes = nullptr;
  std::list<Session*> open{};  // the longest idle first
  bool stopping = false;
};

// `tls` is null for an unencrypted connection. The door outlives the session, which keeps itself
// alive.
std::shared_ptr<Session> make_session(boost::asio::ip::tcp::socket socket,
                                      std::shared_ptr<boost::asio::ssl::context> tls,
                                      const Door& door, SessionContext& context);

}  // namespace weft::server
