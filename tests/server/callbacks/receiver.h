// SPDX-License-Identifier: Apache-2.0
// A receiver of callbacks on loopback, which answers what the test says.
//
//   Receiver receiver([](const Received&) { return "HTTP/1.1 204 No Content\r\n\r\n"; });
//   ... receiver.url() ...
//   ASSERT_TRUE(receiver.wait_for(1));
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace weft::server::testing {

struct Received {
  std::string line;                            // of the request
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

inline std::string answer_of(int status, const std::string& headers = "",
                             const std::string& body = "") {
  return "HTTP/1.1 " + std::to_string(status) +
         " Status\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + headers + "\r\n" +
         body;
}

class Receiver {
 public:
  // Called for each request, on a thread of its own; an empty answer is none: the connection stays
  // open, as long as this lives.
  using Answer = std::function<std::string(const Received& request)>;

  explicit Receiver(Answer answer);
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  int port() const { return port_; }
  std::string url(const std::string& host = "127.0.0.1") const;
  std::vector<Received> all() const;
  // False if there were not as many after kPatience.
  bool wait_for(std::size_t requests) const;

 private:
  void accept_until_closed();
  void serve(int socket);

  const Answer answer_;
  int listener_ = -1;
  int port_ = 0;
  mutable std::mutex mutex_;  // guards the four below
  std::vector<Received> received_;
  std::vector<int> open_;
  std::vector<std::thread> threads_;
  bool closing_ = false;
  mutable std::condition_variable changed_;
  std::thread acceptor_;
};

}  // namespace weft::server::testing
