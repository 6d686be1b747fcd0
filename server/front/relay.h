// SPDX-License-Identifier: Apache-2.0
// One connection between a client and gRPC: what the rules let pass, and all that comes back.
//
// gRPC has one end of a pair of sockets, the relay the other. Each direction moves until it would
// wait, and holds no more than what the receiver did not take at once; so a client that reads
// nothing stops gRPC, and gRPC that reads nothing stops the client, as does a call that must wait
// for its turn. A silent connection has no buffers. Closing sends GOAWAY, with the cause, if no
// frame is cut in two by that.
//
// Thread-safety: a relay lives on the thread of its lane. `start` may be called from any.
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_set>
#include <vector>

#include "server/front/client_socket.h"
#include "server/front/connection_rules.h"
#include "server/net/connection_table.h"

namespace weft::server {

class Relay;

// A thread with connections of its own.
class Lane {
 public:
  Lane();
  // Ends all connections.
  ~Lane();
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  boost::asio::io_context& io() { return io_; }
  // Waits until no connection is left, and ends those that are at `end`.
  void finish(std::chrono::steady_clock::time_point end);

 private:
  friend class Relay;

  void refresh_often();

  boost::asio::io_context io_{1};
  const boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  boost::asio::steady_timer timer_{io_};
  std::unordered_set<Relay*> relays_;
  std::vector<char> scratch_;  // of whoever is at work
  std::string passes_;         // likewise
  std::thread thread_;
};

// What all relays share.
struct RelayContext {
  ConnectionTable& table;
  ConnectionRules::Options rules;
  // Called for a connection that was closed for what its client did.
  std::function<void(const std::string& peer, const ConnectionRules::Violation& violation)> closed;
};

class Relay : public std::enable_shared_from_this<Relay> {
 public:
  struct Parts {
    ClientSocket client;
    int inner;  // a non-blocking end of a pair of unix sockets; the relay closes it
    std::shared_ptr<ConnectionTable::Connection> connection;
  };
  // `context` and `lane` outlive the relay, which keeps itself. The client's preface has
  // been read.
  static std::shared_ptr<Relay> make(Parts parts, const RelayContext& context, Lane& lane);
  ~Relay();

  void start();
  // Ends the connection for this cause, on whatever thread it is called.
  void close_for(ConnectionRules::Violation violation);

 private:
  friend class Lane;
  using Step = void (Relay::*)();
  using Inner = boost::asio::local::stream_protocol::socket;

  Relay(Parts parts, const RelayContext& context, Lane& lane);

  bool is_closed() const { return connection_ == nullptr || closed_ != decltype(closed_)(); }
  void from_client();
  bool pass_on(std::string_view bytes);  // false: waits for gRPC, or is closed
  void from_server();
  bool send_back(std::string_view bytes);  // false: waits for the client, or is closed
  template <class Socket>
  void wait(Socket& socket, boost::asio::socket_base::wait_type what, Step then);
  void wait_for_client(ClientSocket::Outcome outcome, Step then);
  void go_on(Step step);  // later, after others had their turn
  void violate(const ConnectionRules::Violation& violation);
  void close();  // to the client; to gRPC once it has handed over all calls
  void close_to_server();
  void refresh();  // what was reset in a second that has passed no longer counts
  void report();

  const RelayContext& context_;
  Lane& lane_;
  ClientSocket client_;
  Inner inner_;
  std::shared_ptr<ConnectionTable::Connection> connection_;  // null once it is closed to gRPC
  ConnectionRules::Clock::time_point closed_{};              // to the client; 0: it is open
  ConnectionRules rules_;
  std::string held_;       // what the client sent from a call on that may not begin yet
  bool holds_ = false;     // such a call
  std::string to_server_;  // what gRPC did not take
  std::string to_client_;  // what the client did not take
};

}  // namespace weft::server
