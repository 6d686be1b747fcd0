// SPDX-License-Identifier: Apache-2.0
#include "tests/server/store/cutting_proxy.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <stdexcept>
#include <string_view>

namespace weft::server {
namespace {

constexpr const char* kSocketName = ".s.PGSQL.5432";
constexpr int kTickMs = 20;

int unix_socket(const std::string& path, bool listens) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  const bool ready = listens ? bind(made, generic, sizeof address) == 0 && listen(made, 16) == 0
                             : connect(made, generic, sizeof address) == 0;
  if (ready) return made;
  close(made);
  return -1;
}

// False if the connection has ended.
bool pass_on(int from, int to, std::string& passed) {
  char buffer[1 << 16];
  const ssize_t got = read(from, buffer, sizeof buffer);
  if (got <= 0) return false;
  passed.assign(buffer, static_cast<std::size_t>(got));
  for (std::string_view rest = passed; !rest.empty();) {
    const ssize_t sent = send(to, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace

CuttingProxy::CuttingProxy(const std::string& uri) : uri_(uri) {
  constexpr std::string_view kHost = "host=";
  const std::size_t begin = uri.find(kHost) + kHost.size();
  const std::size_t end = uri.find('&', begin);
  std::string host = uri.substr(begin, end - begin);
  for (std::size_t at = host.find("%2F"); at != std::string::npos; at = host.find("%2F")) {
    host.replace(at, 3, "/");
  }
  server_ = host + "/" + kSocketName;
  uri_.replace(begin, end - begin, folder_.path().string());
  listening_ = unix_socket((folder_ / kSocketName).string(), true);
  if (listening_ < 0) throw std::runtime_error("the proxy cannot listen");
  accepting_ = std::thread([this] { accept_all(); });
}

CuttingProxy::~CuttingProxy() {
  stopping_ = true;
  accepting_.join();
  for (std::thread& thread : serving_) thread.join();
  close(listening_);
}

void CuttingProxy::accept_all() {
  while (!stopping_) {
    pollfd wait{listening_, POLLIN, 0};
    if (poll(&wait, 1, kTickMs) <= 0) continue;
    const int client = accept(listening_, nullptr, nullptr);
    serving_.emplace_back([this, client] { serve(client); });
  }
}

void CuttingProxy::serve(int client) {
  const int server = unix_socket(server_, false);
  bool open = server >= 0;
  bool cutting = false;
  std::string passed;
  while (open && !stopping_) {
    pollfd waits[2] = {{client, POLLIN, 0}, {server, POLLIN, 0}};
    if (poll(waits, 2, kTickMs) <= 0) continue;
    if (waits[1].revents != 0) open = !cutting && pass_on(server, client, passed);
    if (open && waits[0].revents != 0) {
      open = pass_on(client, server, passed);
      if (passed.find("COMMIT") != std::string::npos && cuts_ > 0) {
        --cuts_;
        cutting = true;  // the server's answer ends the connection instead
      }
    }
  }
  close(client);
  if (server >= 0) close(server);
}

}  // namespace weft::server
