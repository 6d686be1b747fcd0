// SPDX-License-Identifier: Apache-2.0
// A client's TCP connection, encrypted or not, that never waits: what cannot be done at once says
// what to wait for.
//
//   const ClientSocket::Moved read = socket.read(buffer, sizeof buffer);
//   if (read.outcome == ClientSocket::Outcome::kReads) ... wait until it is readable ...
//
// OpenSSL works on the descriptor itself, and keeps no buffers while a connection is silent.
// Thread-safety: none, but it may move from one thread to another. REQUIRES: SIGPIPE is ignored or
// blocked.
#pragma once

#include <openssl/ssl.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstddef>
#include <memory>
#include <string>

namespace weft::server {

class ClientSocket {
 public:
  enum class Outcome {
    kDone,
    kReads,   // try again once the socket is readable
    kWrites,  // try again once it is writable
    kClosed   // by the client, or for a fault of its
  };
  struct Moved {
    Outcome outcome;
    std::size_t bytes = 0;  // above 0 if kDone
  };

  // `tls` is null for an unencrypted connection.
  ClientSocket(boost::asio::ip::tcp::socket socket, std::shared_ptr<boost::asio::ssl::context> tls);

  // One step. Done at once for an unencrypted connection.
  Outcome handshake();
  // REQUIRES: the handshake is done.
  Moved read(char* to, std::size_t most);
  // Writes as much as can be written at once.
  Moved write(const char* bytes, std::size_t count);

  // The name in the client's certificate; empty if it has shown none.
  std::string certificate_name() const;

  // To another thread's context. REQUIRES: nothing waits for the socket.
  void move_to(boost::asio::io_context& io);

  // Ends the connection, so that the client can still read what was written.
  void close();

  boost::asio::ip::tcp::socket& socket() { return socket_; }

 private:
  Moved outcome_of(int result);

  boost::asio::ip::tcp::socket socket_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{nullptr, &SSL_free};
};

}  // namespace weft::server
