// SPDX-License-Identifier: Apache-2.0
// Which server to use and how: the options of every command that connects to one.
//
// This folder has more than 25 files because a call has many steps: its options, the connection,
// the request, retries, the stream and where it is kept.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "client/call/retry.h"

namespace weft::client {

struct ConnectOptions {
  // As gRPC takes it ("host:port", "unix:/path"); empty: a private server, which uses nothing else.
  std::string server{};

  // Encryption. With any of `tls`, `tls_ca`, `tls_cert` and `tls_server_name` the connection is
  // encrypted and the server's certificate verified.
  bool tls = false;
  std::filesystem::path tls_ca{};      // PEM: trusted CAs; empty: those of the system
  std::filesystem::path tls_cert{};    // PEM: the client's certificate, if the server requires one
  std::filesystem::path tls_key{};     // PEM: its key
  std::string tls_server_name{};       // the name in the certificate; empty: the host of `server`
  std::filesystem::path token_file{};  // holds the bearer token; empty: $WEFT_TOKEN, or none

  // Send the token even if others may read it: unencrypted, to another machine.
  bool insecure = false;
};

// What every command takes that calls a server.
struct CallOptions {
  ConnectOptions server{};
  std::optional<double> timeout_seconds{};  // of all calls together
  std::uint32_t retries = RetryOptions{}.attempts;
};

}  // namespace weft::client
