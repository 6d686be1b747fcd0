// SPDX-License-Identifier: Apache-2.0
// The plainest of web clients, which can misbehave, and a reader of what it gets.
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "tests/support/event.h"

namespace weft::testing {

class HttpConnection {
 public:
  // `address` is 127.0.0.1:PORT.
  explicit HttpConnection(const std::string& address)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in server{};
    server.sin_family = AF_INET;
    server.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    server.sin_port =
        htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&server), sizeof server) != 0)
      throw std::runtime_error("nobody listens at " + address);
  }
  ~HttpConnection() { ::close(socket_); }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  // What the server no longer wants to read is lost.
  void send(const std::string& bytes) {
    (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  // All that comes until the server closes the connection; throws after kPatience without.
  std::string read_all() {
    std::string text;
    while (true) {
      pollfd ready{socket_, POLLIN, 0};
      if (::poll(&ready, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) != 1)
        throw std::runtime_error("the server neither answers nor closes");
      char bytes[4096];
      const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
      if (count <= 0) return text;
      text.append(bytes, static_cast<std::size_t>(count));
    }
  }

 private:
  const int socket_;
};

inline std::string http(const std::string& address, const std::string& method,
                        const std::string& path) {
  HttpConnection connection(address);
  connection.send(method + " " + path + " HTTP/1.1\r\nHost: test\r\n\r\n");
  return connection.read_all();
}

// The value of a series in a scrape of Prometheus, written as there: `name{label="value"}`; -1
// where there is none.
inline double value_of(const std::string& scrape, const std::string& series) {
  const std::string line = "\n" + series + " ";
  const std::size_t start = ("\n" + scrape).find(line);
  return start == std::string::npos ? -1 : std::stod(scrape.substr(start + line.size() - 1));
}

}  // namespace weft::testing
