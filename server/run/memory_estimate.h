// SPDX-License-Identifier: Apache-2.0
// How much memory a run is expected to take, for whoever orders runs: weft::estimate, and what the
// server holds besides. What a run takes beyond it, it gets from the MemoryGate as it grows, or
// not.
#pragma once

#include <chrono>
#include <cstdint>

#include "server/wire/limits.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// A run that is expected to take no more of the engine's memory is light: a mesh of 100,000
// triangles takes 5 MB, and 10 ms.
inline constexpr std::uint64_t kLightBytes = std::uint64_t{8} << 20;
// On a busy machine several times that. A run that works for longer is not light, either.
inline constexpr std::chrono::milliseconds kLightTime{300};

// What the server holds for a run beside the engine's memory: chunks that wait for their reader,
// and buffers.
std::uint64_t bytes_besides(const Limits& limits);

// The highest estimate of a light run, with what is besides.
inline std::uint64_t most_light(const Limits& limits) {
  return kLightBytes + bytes_besides(limits);
}

// A request, parsed, and as the engine has it.
inline std::uint64_t bytes_of_request(const v1::GenerateMeshRequest& request) {
  return 2 * request.SpaceUsedLong();
}

// Bytes, at most what the request's budget allows; takes linear time, and memory for the engine's
// form of the request meanwhile. REQUIRES: check_shape and check_limits found nothing.
std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits);

}  // namespace weft::server
