// SPDX-License-Identifier: Apache-2.0
// The rules for connections before the caller is identified: where they must be encrypted, how long
// they may idle, how often they may ping.
#pragma once

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/tls.h"

namespace weft::server {

// Returns credentials per address: TLS for TCP if a certificate is named; the folder of a unix
// socket protects it. Without a certificate, an address that other machines can reach is refused
// unless `insecure`. The error names the address or the file.
tl::expected<std::vector<std::shared_ptr<grpc::ServerCredentials>>, std::string> credentials_for(
    const std::vector<std::string>& addresses, const TlsOptions& tls, bool insecure);

// The security of these credentials, as written to the log: none, tls or mtls.
const char* security_of(const std::string& address, const TlsOptions& tls);

// Maximum streams that one connection may have open; further calls wait at the client.
inline constexpr int kMostStreams = 256;

void limit_connections(grpc::ServerBuilder& builder);

}  // namespace weft::server
