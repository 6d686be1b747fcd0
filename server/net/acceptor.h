// SPDX-License-Identifier: Apache-2.0
// Accepts connections over TCP at an address.
//
//   auto acceptor = Acceptor::listen("127.0.0.1:0", io);
//   if (!acceptor) return complain(acceptor.error());
//   (*acceptor)->start([](tcp::socket socket) { ... });
//
// Thread-safety: lives on the thread of its context, but for `listen` and `port`.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace weft::server {

class Acceptor {
 public:
  using Listening = boost::asio::ip::tcp::acceptor;
  // If it throws, the connection is closed.
  using Welcome = std::function<void(boost::asio::ip::tcp::socket socket)>;
  // Called if a connection could not be accepted, because descriptors have run out: before the
  // next try, which comes 100 ms later.
  using Exhausted = std::function<void(Listening& listening)>;

  // Listens at each address of the host, all with one port: HOST:PORT, where port 0 is any free
  // one. Listens for IPv6, too, if the host is 0.0.0.0. No other process may listen at the same
  // port. The error says what is wrong with the address.
  //
  // The acceptor may be destroyed once the context no longer runs.
  static tl::expected<std::unique_ptr<Acceptor>, std::string> listen(const std::string& address,
                                                                     boost::asio::io_context& io);
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  int port() const { return port_; }

  // Until `close`, calls `welcome` with each connection. Call at most once.
  void start(
      Welcome welcome, Exhausted exhausted = [](Listening&) {});
  void close();

 private:
  struct Socket {
    Listening listening;
    boost::asio::steady_timer breather;
  };

  Acceptor(std::vector<Listening> sockets, boost::asio::io_context& io);
  void accept(Socket& socket);
  void rest(Socket& socket);

  std::list<Socket> sockets_;
  const int port_;
  bool closed_ = false;
  Welcome welcome_;
  Exhausted exhausted_;
};

}  // namespace weft::server
