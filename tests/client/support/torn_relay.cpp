// SPDX-License-Identifier: Apache-2.0
#include "tests/client/support/torn_relay.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace weft::client {
namespace {

constexpr std::size_t kHolds = std::numeric_limits<std::size_t>::max();

sockaddr_un name_of(const std::filesystem::path& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof name.sun_path) throw std::runtime_error("a long path: " + text);
  std::memcpy(name.sun_path, text.data(), text.size());
  return name;
}

// False if the other end is gone.
bool send_all(int socket, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = ::send(socket, bytes, size, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

}  // namespace

TornRelay::TornRelay(const std::filesystem::path& wire, std::filesystem::path server,
                     std::vector<std::size_t> tears)
    : address_("unix:" + wire.string()),
      server_(std::move(server)),
      tears_(std::move(tears)),
      listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      end_(::eventfd(0, EFD_CLOEXEC)) {
  const sockaddr_un name = name_of(wire);
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
      ::listen(listener_.get(), 8) != 0)
    throw std::runtime_error("cannot listen on " + wire.string());
  thread_ = std::thread([this] { run(); });
}

TornRelay::~TornRelay() {
  const std::uint64_t one = 1;
  (void)write_all(end_.get(), &one, sizeof one);
  thread_.join();
}

void TornRelay::run() {
  for (;;) {
    pollfd fds[] = {{listener_.get(), POLLIN, 0}, {end_.get(), POLLIN, 0}};
    if (::poll(fds, 2, -1) < 0) continue;
    if (fds[1].revents != 0) return;
    FileDescriptor client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!client.is_open()) continue;
    hold(client.get());
    if (pass(client, torn_ < tears_.size() ? tears_[torn_] : kHolds)) ++torn_;
    hold(-1);
  }
}

void TornRelay::hold(int client) {
  std::lock_guard lock(mutex_);
  client_ = client;
}

void TornRelay::tear() {
  std::lock_guard lock(mutex_);
  if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
}

bool TornRelay::pass(const FileDescriptor& client, std::size_t limit) {
  FileDescriptor server(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_un name = name_of(server_);
  if (::connect(server.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0)
    return false;
  std::array<char, 65536> buffer;
  for (;;) {
    pollfd fds[] = {{client.get(), POLLIN, 0}, {server.get(), POLLIN, 0}, {end_.get(), POLLIN, 0}};
    if (::poll(fds, 3, -1) < 0) continue;
    if (fds[2].revents != 0) return false;
    if (fds[0].revents != 0) {
      const ssize_t size = ::read(client.get(), buffer.data(), buffer.size());
      if (size <= 0 || !send_all(server.get(), buffer.data(), static_cast<std::size_t>(size)))
        return false;
    }
    if (fds[1].revents != 0) {
      const ssize_t size = ::read(server.get(), buffer.data(), std::min(buffer.size(), limit));
      if (size <= 0 || !send_all(client.get(), buffer.data(), static_cast<std::size_t>(size)))
        return false;
      if (limit != kHolds) limit -= static_cast<std::size_t>(size);
      if (limit == 0) return true;
    }
  }
}

}  // namespace weft::client
