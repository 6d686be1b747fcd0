// SPDX-License-Identifier: Apache-2.0
// What holds for connections before anyone knows who is at the other end: where they must be
// encrypted, how long they may idle, how often they may ping.
#pragma once

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/tls.h"

namespace weft::server {

// One for each address: TLS for TCP where a certificate is named; a unix socket is guarded by its
// folder. Without a certificate, an address that other machines can reach is refused unless
// `insecure`. The error names the address or the file.
tl::expected<std::vector<std::shared_ptr<grpc::ServerCredentials>>, std::string> credentials_for(
    const std::vector<std::string>& addresses, const TlsOptions& tls, bool insecure);

// What these credentials ask for, as the log tells it: none, tls or mtls.
const char* security_of(const std::string& address, const TlsOptions& tls);

// That one connection may have open at a time; calls beyond these wait at the client.
inline constexpr int kMostStreams = 256;

void limit_connections(grpc::ServerBuilder& builder);

}  // namespace weft::server
