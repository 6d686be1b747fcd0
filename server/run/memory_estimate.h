// SPDX-License-Identifier: Apache-2.0
// The memory that a run is expected to take: weft::estimate, and what the server holds besides. A
// run that needs more must get it from the MemoryBudget as it grows.
//
// Units: bytes. Thread-safety: every function may be called from any thread.
#pragma once

#include <chrono>
#include <cstdint>

#include "server/wire/limits.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// A run is light if it is expected to take no more of the engine's memory: a mesh of 100,000
// triangles takes 5 MB and 10 ms.
inline constexpr std::uint64_t kLightBytes = std::uint64_t{8} << 20;
// A run that computes for longer is not light, either. On a busy machine 10 ms become several times
// that.
inline constexpr std::chrono::milliseconds kLightTime{300};

// What the server holds for a run beside the engine's memory: chunks that wait for their reader,
// and buffers.
std::uint64_t bytes_besides(const Limits& limits);

// The highest estimate of a light run, with what is besides.
inline std::uint64_t max_light_bytes(const Limits& limits) {
  return kLightBytes + bytes_besides(limits);
}

// A request, parsed, and in the engine's form.
inline std::uint64_t bytes_of_request(const v1::GenerateMeshRequest& request) {
  return 2 * request.SpaceUsedLong();
}

// At most what the request's budget allows. Takes linear time, and meanwhile memory for the
// engine's form of the request. REQUIRES: check_shape and check_limits found nothing.
std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits);

}  // namespace weft::server
