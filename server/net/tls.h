// SPDX-License-Identifier: Apache-2.0
// Encryption of TCP addresses: TLS 1.2 and 1.3, and client certificates if a CA for them is named.
//
// The files are read again when they change, within two seconds: a renewed certificate needs no
// restart, and open connections stay open. Rename new files into place, the key first or
// both at once by a link to their folder. Missing or unreadable files change nothing;
// while certificate and key do not match, new connections are refused.
//
//   auto credentials = tls_credentials({.certificate = "server.pem", .key = "server.key"});
//   if (!credentials) return complain(credentials.error());
//   builder.AddListeningPort("0.0.0.0:7421", *credentials);
#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace weft::server {

// Names of PEM files.
struct TlsOptions {
  std::string certificate{};  // the server's, then intermediate ones; empty: no encryption
  std::string key{};          // of the server's certificate
  std::string client_ca{};    // clients need a certificate of one of these; empty: they need none
};

// REQUIRES: certificate and key are named. The error names the file at fault.
tl::expected<std::shared_ptr<grpc::ServerCredentials>, std::string> tls_credentials(
    const TlsOptions& options);

}  // namespace weft::server
