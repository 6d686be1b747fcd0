// SPDX-License-Identifier: Apache-2.0
// A channel to the server that the user named, or to a private one.
#pragma once

#include <grpcpp/channel.h>

#include <memory>
#include <stop_token>
#include <string>

#include "client/error.h"
#include "client/private_server.h"

namespace weft::client {

struct Connection {
  std::unique_ptr<PrivateServer> server;  // null when the user named one
  std::shared_ptr<grpc::Channel> channel;
  std::string address;
};

// `address` as gRPC takes it ("host:port", "unix:/path"); empty: a private server is started. Does
// not wait for a named server: the first call finds out.
Result<Connection> connect(const std::string& address, std::stop_token stop);

}  // namespace weft::client
