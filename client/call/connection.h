// SPDX-License-Identifier: Apache-2.0
// A channel to the server that the user named, or to a private one.
//
// Every call on the channel carries the token, if there is one. Certificates, keys and tokens are
// read when connecting.
//
// Errors: kUnreadableInput names the file that is missing or malformed; kUsage says that the token
// would be sent unencrypted; kServerNotStarted as private_server.h says. If the TLS handshake
// fails, the first call ends with UNAVAILABLE.
#pragma once

#include <grpcpp/channel.h>

#include <memory>
#include <stop_token>
#include <string>

#include "client/call/connect_options.h"
#include "client/call/private_server.h"
#include "files/base/error.h"

namespace weft::client {

struct Connection {
  std::unique_ptr<PrivateServer> server;  // null if the user named one
  std::shared_ptr<grpc::Channel> channel;
  std::string address;
};

// Does not wait for a named server: the first call finds out whether it is there.
Result<Connection> connect(const ConnectOptions& options, std::stop_token stop);
// The same for a single mesh, to which a private server gives all of its memory.
Result<Connection> connect_for_mesh(const ConnectOptions& options, std::stop_token stop);

}  // namespace weft::client
