// SPDX-License-Identifier: Apache-2.0
#include "tests/server/callbacks/receiver.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/support/event.h"

namespace weft::server::testing {
namespace {

// Of `text`, which begins with a whole head.
Received parse(const std::string& text) {
  Received request;
  std::istringstream lines(text);
  std::getline(lines, request.line);
  if (!request.line.empty()) request.line.pop_back();
  for (std::string line; std::getline(lines, line) && line.size() > 1;) {
    const auto colon = line.find(": ");
    std::string name = line.substr(0, colon);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    request.headers[name] = line.substr(colon + 2, line.size() - colon - 3);
  }
  request.body = text.substr(text.find("\r\n\r\n") + 4);
  return request;
}

bool is_whole(const std::string& text) {
  if (text.find("\r\n\r\n") == text.npos) return false;
  const Received request = parse(text);
  const auto length = request.headers.find("content-length");
  return length == request.headers.end() || request.body.size() >= std::stoul(length->second);
}

}  // namespace

Receiver::Receiver(Answer answer)
    : answer_(std::move(answer)), listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof where;
  auto* const name = reinterpret_cast<sockaddr*>(&where);
  if (::bind(listener_, name, size) != 0 || ::listen(listener_, 64) != 0 ||
      ::getsockname(listener_, name, &size) != 0)
    throw std::runtime_error("no receiver on loopback");
  port_ = ntohs(where.sin_port);
  acceptor_ = std::thread([this] { accept_until_closed(); });
}

Receiver::~Receiver() {
  std::vector<std::thread> threads;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    ::shutdown(listener_, SHUT_RDWR);
    for (const int socket : open_) ::shutdown(socket, SHUT_RDWR);
    threads.swap(threads_);
  }
  changed_.notify_all();
  acceptor_.join();
  for (std::thread& thread : threads) thread.join();
  for (const int socket : open_) ::close(socket);
  ::close(listener_);
}

std::string Receiver::url(const std::string& host) const {
  return "http://" + host + ":" + std::to_string(port_) + "/hook";
}

std::vector<Received> Receiver::all() const {
  const std::lock_guard lock(mutex_);
  return received_;
}

bool Receiver::wait_for(std::size_t requests) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return received_.size() >= requests; });
}

void Receiver::accept_until_closed() {
  while (true) {
    const int socket = ::accept(listener_, nullptr, nullptr);
    if (socket < 0) return;
    const std::lock_guard lock(mutex_);
    open_.push_back(socket);
    if (closing_)
      ::shutdown(socket, SHUT_RDWR);
    else
      threads_.emplace_back([this, socket] { serve(socket); });
  }
}

void Receiver::serve(int socket) {
  std::string text;
  char bytes[4096];
  while (!is_whole(text)) {
    const ssize_t count = ::recv(socket, bytes, sizeof bytes, 0);
    if (count <= 0) return;
    text.append(bytes, static_cast<std::size_t>(count));
  }
  const Received request = parse(text);
  {
    const std::lock_guard lock(mutex_);
    received_.push_back(request);
  }
  changed_.notify_all();
  const std::string answer = answer_(request);
  if (answer.empty()) return;
  (void)!::send(socket, answer.data(), answer.size(), MSG_NOSIGNAL);
  ::shutdown(socket, SHUT_WR);
}

}  // namespace weft::server::testing
