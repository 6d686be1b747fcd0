// SPDX-License-Identifier: Apache-2.0
// The rules for connections before the caller is identified: where they must be encrypted, how long
// they may idle, how often they may ping. What else they may do is in server/front/.
#pragma once

#include <grpcpp/server_builder.h>

#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/tls.h"

namespace weft::server {

// Refuses an address that other machines can reach if it is not encrypted, unless `insecure`. The
// error names it.
tl::expected<void, std::string> check_encryption(const std::vector<std::string>& addresses,
                                                 const TlsOptions& tls, bool insecure);

// The security of these credentials, as written to the log: none, tls or mtls.
const char* security_of(const std::string& address, const TlsOptions& tls);

// Streams that one connection may have open; further calls wait at the client.
inline constexpr std::size_t kMaxStreams = 256;

void limit_connections(grpc::ServerBuilder& builder);

}  // namespace weft::server
