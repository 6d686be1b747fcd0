// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/hostile/floods.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/e2e/hostile/http2_client.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;
using IsOver = std::function<bool()>;

constexpr std::uint8_t kHeaders = 1;
constexpr std::uint8_t kSettings = 4;
constexpr std::uint8_t kPing = 6;
constexpr std::uint8_t kWindowUpdate = 8;
constexpr std::uint8_t kContinuation = 9;
constexpr std::uint8_t kUnknown = 0x42;

// Does one round of something on each of `count` connections in turn.
template <class Round>
Flooded on_connections(const Target& target, std::size_t count, const IsOver& is_over,
                       Round&& round) {
  std::vector<std::unique_ptr<Http2Client>> clients(count);
  Flooded flooded;
  while (!is_over())
    for (auto& client : clients) {
      if (is_over()) break;
      try {
        if (client == nullptr) {
          client = std::make_unique<Http2Client>(target.address, target.encrypted);
          ++flooded.connections;
        }
        round(*client);
        client->listen(milliseconds(0));
      } catch (const std::runtime_error&) {
        std::this_thread::sleep_for(milliseconds(1));  // the server takes no connection
        continue;
      }
      if (client->alive()) continue;
      ++flooded.closed;
      if (client->goaway()) ++flooded.goaways[*client->goaway()];
      client.reset();
    }
  return flooded;
}

int bare_connection(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
  ::inet_pton(AF_INET, address.substr(0, colon).c_str(), &where.sin_addr);
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  (void)::connect(socket, reinterpret_cast<const sockaddr*>(&where), sizeof where);
  return socket;
}

// 1,100 connections without a byte, held for as long as the server holds them.
Flooded bare_connections(const Target& target, const IsOver& is_over) {
  Flooded flooded;
  std::vector<int> open;
  while (!is_over()) {
    while (open.size() < 1'100 && !is_over()) {
      open.push_back(bare_connection(target.address));
      ++flooded.connections;
    }
    std::erase_if(open, [&](int socket) {
      pollfd ended{socket, POLLIN, 0};
      if (::poll(&ended, 1, 0) == 0) return false;
      ::close(socket);
      ++flooded.closed;
      return true;
    });
    std::this_thread::sleep_for(milliseconds(1));
  }
  for (const int socket : open) ::close(socket);
  return flooded;
}

Flooded idle_connections(const Target& target, const IsOver& is_over) {
  return on_connections(target, 1'100, is_over, [](Http2Client&) {});
}

Flooded continuations(const Target& target, const IsOver& is_over) {
  std::string fields;
  while (fields.size() < 16'000) fields += literal_header("x", "y");
  return on_connections(target, 4, is_over, [&](Http2Client& client) {
    client.frame(kHeaders, 0, 1, literal_header(":method", "POST"));
    for (int i = 0; i < 64 && client.alive(); ++i) {
      client.frame(kContinuation, 0, 1, fields);
      client.flush();
    }
  });
}

Flooded health_without_end(const Target& target, const IsOver& is_over) {
  return on_connections(target, 300, is_over, [](Http2Client& client) {
    for (int i = 0; i < 500; ++i) client.open("/grpc.health.v1.Health/Check");
  });
}

Flooded resets(const Target& target, const IsOver& is_over) {
  return on_connections(target, 128, is_over, [](Http2Client& client) {
    for (int i = 0; i < 64; ++i) client.reset(client.open("/weft.v1.MeshService/GetServerInfo"));
  });
}

template <std::uint8_t type, std::size_t bytes, std::uint32_t stream = 0>
Flooded frames(const Target& target, const IsOver& is_over) {
  // Of a window update, whose first bit is reserved: by 1.
  std::string payload(bytes, '\0');
  payload.back() = 1;
  return on_connections(target, 32, is_over, [&](Http2Client& client) {
    for (int i = 0; i < 1'000; ++i) client.frame(type, 0, stream, payload);
  });
}

}  // namespace

const Flood kFloods[] = {{"bare-connections", bare_connections},
                         {"idle-connections", idle_connections},
                         {"continuations", continuations},
                         {"health-without-end", health_without_end},
                         {"resets-of-many", resets},
                         {"unknown-frames", frames<kUnknown, 100>},
                         {"window-updates", frames<kWindowUpdate, 4>},
                         {"settings", frames<kSettings, 6>},
                         {"pings", frames<kPing, 8>}};

}  // namespace weft::e2e
