// SPDX-License-Identifier: Apache-2.0
#include "server/net/reset_guard.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>

namespace weft::server {
namespace {

// As grpc_sockaddr_to_uri spells it: an IPv4 address within IPv6 is IPv4.
std::string peer_of(int socket) {
  sockaddr_storage storage{};
  socklen_t length = sizeof storage;
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&storage), &length) != 0) return "";
  char host[INET6_ADDRSTRLEN] = {};
  if (storage.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(storage);
    ::inet_ntop(AF_INET, &v4.sin_addr, host, sizeof host);
    return fmt::format("ipv4:{}:{}", host, ntohs(v4.sin_port));
  }
  if (storage.ss_family != AF_INET6) return "";
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(storage);
  if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr)) {
    ::inet_ntop(AF_INET, &v6.sin6_addr.s6_addr[12], host, sizeof host);
    return fmt::format("ipv4:{}:{}", host, ntohs(v6.sin6_port));
  }
  ::inet_ntop(AF_INET6, &v6.sin6_addr, host, sizeof host);
  return fmt::format("ipv6:%5B{}%5D:{}", host, ntohs(v6.sin6_port));
}

// gRPC would read all that has arrived, about 100,000 calls, before it sees the end of the
// connection. The kernel discards it if no byte of it is asked for.
bool shut_down(int socket) {
  if (::shutdown(socket, SHUT_RDWR) != 0) return false;
  constexpr std::size_t kAtOnce = std::size_t{1} << 20;
  while (::recv(socket, nullptr, kAtOnce, MSG_TRUNC | MSG_DONTWAIT) > 0) continue;
  return true;
}

}  // namespace

bool ResetGuard::counts(const std::string& peer) const {
  return most_ != 0 && (peer.starts_with("ipv4:") || peer.starts_with("ipv6:"));
}

bool ResetGuard::was_reset(const std::string& peer, Clock::time_point now) {
  if (!counts(peer)) return false;
  std::lock_guard lock(mutex_);
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    counts_.clear();
  }
  return ++counts_[peer] == most_ + 1;
}

bool ResetGuard::began(const std::string& peer) {
  if (!counts(peer)) return false;
  std::lock_guard lock(mutex_);
  return ++open_[peer] == kMostOpen + 1;
}

void ResetGuard::ended(const std::string& peer) {
  if (!counts(peer)) return;
  std::lock_guard lock(mutex_);
  const auto found = open_.find(peer);
  if (found != open_.end() && --found->second == 0) open_.erase(found);
}

int close_connections_of(const std::string& peer) {
  int closed = 0;
  std::error_code error;
  std::filesystem::directory_iterator entry("/proc/self/fd", error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename();
    int number = -1;
    std::from_chars(name.data(), name.data() + name.size(), number);
    if (peer_of(number) != peer) continue;
    // A descriptor of our own: gRPC may close its one, and the number be another's, meanwhile.
    const int own = ::fcntl(number, F_DUPFD_CLOEXEC, 0);
    if (own < 0) continue;
    if (peer_of(own) == peer) closed += shut_down(own);
    ::close(own);
  }
  return closed;
}

}  // namespace weft::server
