// SPDX-License-Identifier: Apache-2.0
// The kinds of hostile client that hostile_clients.cpp has.
#pragma once

#include <grpcpp/client_context.h>

#include <chrono>
#include <string>
#include <string_view>

namespace weft::e2e {

inline constexpr const char* kHostileKinds[] = {
    "fields-of-strangers",  // unknown fields; a stranger sends no token
    "fields",
    "resets-of-strangers",  // "HTTP/2 rapid reset", CVE-2023-44487
    "bodies-of-strangers",  // messages that never end
    "bodies",
    "crumbs",   // a region of 170 M triangles, of which the size does not tell
    "spike",    // 20 M triangles between the samples of the size
    "flood",    // 90 calls at a time
    "stalls",   // meshes that are never read
    "submits",  // jobs, cancelled at once
    "ids",      // of 8 MB
};

inline std::string token_of(std::string_view name) {
  return "the-token-of-" + std::string(name);
}

// As this caller, who waits for so long.
inline void identify(grpc::ClientContext& context, std::string_view name,
                     std::chrono::seconds patience = std::chrono::seconds(10)) {
  context.AddMetadata("authorization", "Bearer " + token_of(name));
  context.set_deadline(std::chrono::system_clock::now() + patience);
}

}  // namespace weft::e2e
