// SPDX-License-Identifier: Apache-2.0
#include "server/net/listen.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>

namespace weft::server {
namespace {

constexpr std::string_view kUnix = "unix:";

class Socket {
 public:
  explicit Socket(int family) : fd_(::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }

 private:
  const int fd_;
};

tl::unexpected<std::string> refuse(std::string reason) {
  return tl::unexpected<std::string>(std::move(reason));
}

tl::unexpected<std::string> refuse_errno() {
  return refuse(std::strerror(errno));
}

tl::expected<void, std::string> claim_unix(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(name.sun_path))
    return refuse(fmt::format("the path has {} bytes; a socket's path has 1 to {}", path.size(),
                              sizeof(name.sun_path) - 1));
  std::memcpy(name.sun_path, path.data(), path.size());

  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0) {
    if (errno == ENOENT) return {};
    return refuse_errno();
  }
  if (!S_ISSOCK(file.st_mode)) return refuse("a file that is no socket is in the way");
  const Socket probe(AF_UNIX);
  if (::connect(probe.fd(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0)
    return refuse("another server listens there");
  if (::unlink(path.c_str()) != 0) return refuse_errno();
  return {};
}

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

tl::expected<Addresses, std::string> look_up(const HostPort& where) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(where.host.c_str(), where.port.c_str(), &hints, &found);
  if (error != 0) return refuse(::gai_strerror(error));
  return Addresses(found, &::freeaddrinfo);
}

bool is_loopback(const sockaddr& address) {
  if (address.sa_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    return ntohl(v4.sin_addr.s_addr) >> 24 == 127;
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
  return address.sa_family == AF_INET6 && IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr);
}

tl::expected<void, std::string> claim_tcp(const HostPort& where) {
  const auto found = look_up(where);
  if (!found) return refuse(found.error());
  // gRPC listens on every address of the host that it can; one is enough.
  int reason = EADDRNOTAVAIL;
  for (const addrinfo* each = found->get(); each != nullptr; each = each->ai_next) {
    const Socket probe(each->ai_family);
    const int on = 1;
    ::setsockopt(probe.fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    if (::bind(probe.fd(), each->ai_addr, each->ai_addrlen) == 0) return {};
    reason = errno;
  }
  return refuse(std::strerror(reason));
}

}  // namespace

bool is_unix(std::string_view address) {
  return address.starts_with(kUnix);
}

std::optional<HostPort> split_host_port(const std::string& address) {
  const auto colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  HostPort out{address.substr(0, colon), address.substr(colon + 1)};
  const bool bracketed = out.host.front() == '[' && out.host.back() == ']';
  if (bracketed) out.host = out.host.substr(1, out.host.size() - 2);
  if (out.host.empty() || (!bracketed && out.host.find(':') != std::string::npos))
    return std::nullopt;
  std::uint16_t number = 0;
  const char* end = out.port.data() + out.port.size();
  const auto [stop, error] = std::from_chars(out.port.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return out;
}

tl::expected<void, std::string> claim(const std::string& address) {
  if (is_unix(address)) return claim_unix(address.substr(kUnix.size()));
  if (const auto where = split_host_port(address)) return claim_tcp(*where);
  return refuse("not of the form HOST:PORT or unix:PATH");
}

bool is_local(const std::string& address) {
  if (is_unix(address)) return true;
  const auto where = split_host_port(address);
  if (!where) return false;
  const auto found = look_up(*where);
  if (!found) return false;
  for (const addrinfo* each = found->get(); each != nullptr; each = each->ai_next)
    if (!is_loopback(*each->ai_addr)) return false;
  return true;
}

std::string bound_address(const std::string& address, int port) {
  if (is_unix(address)) return address;
  return fmt::format("{}:{}", address.substr(0, address.rfind(':')), port);
}

void release(const std::string& address) {
  if (is_unix(address)) ::unlink(address.substr(kUnix.size()).c_str());
}

}  // namespace weft::server
