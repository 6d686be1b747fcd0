// SPDX-License-Identifier: Apache-2.0
#include "client/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <utility>

namespace weft::client {

Result<Connection> connect(const std::string& address, std::stop_token stop) {
  Connection connection;
  connection.address = address;
  if (address.empty()) {
    auto server = PrivateServer::start({}, std::move(stop));
    if (!server) return tl::unexpected(server.error());
    connection.server = std::move(*server);
    connection.address = connection.server->address();
  }
  connection.channel = grpc::CreateChannel(connection.address, grpc::InsecureChannelCredentials());
  return connection;
}

}  // namespace weft::client
