// SPDX-License-Identifier: Apache-2.0
// Asks a running weftd whether it serves, as the health check of a container does.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace weft::server {

// Calls grpc.health.v1.Health/Check for the whole server, without encryption or a token, at a
// unix:PATH on which it listens. Succeeds if the reply is SERVING; the error says what came
// instead. Waits at most 10 s.
tl::expected<void, std::string> check_health(const std::string& address);

}  // namespace weft::server
