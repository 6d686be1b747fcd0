// SPDX-License-Identifier: Apache-2.0
// A connection that has just been accepted, until it is known to speak HTTP/2: its handshake, and
// the client's preface. gRPC knows nothing of it.
//
// Thread-safety: lives on the thread of its socket's context.
#pragma once

#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "server/front/client_socket.h"
#include "server/net/connection_table.h"

namespace weft::server {

class Arrival : public std::enable_shared_from_this<Arrival> {
 public:
  using Clock = std::chrono::steady_clock;
  using List = std::list<std::shared_ptr<Arrival>>;  // the oldest first
  // Called once the preface has come.
  using Ready = std::function<void(ClientSocket client,
                                   std::shared_ptr<ConnectionTable::Connection> connection)>;

  // `list` and `ready` outlive the arrival.
  Arrival(ClientSocket client, List& list, const Ready& ready);

  // Stands in the list from now on, until it is ready or closed.
  void start(std::shared_ptr<ConnectionTable::Connection> connection);
  void close();
  Clock::time_point since() const { return since_; }

 private:
  void step();
  void wait(ClientSocket::Outcome outcome);
  std::shared_ptr<Arrival> leave_list();

  ClientSocket client_;
  List& list_;
  const Ready& ready_;
  const Clock::time_point since_ = Clock::now();
  std::shared_ptr<ConnectionTable::Connection> connection_;  // null once it has left
  List::iterator place_;
  bool encrypted_ = false;  // the handshake is done
  std::size_t got_ = 0;     // bytes of the preface
};

}  // namespace weft::server
