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
inline std::uint64_t bytes_besides(const Limits& limits) {
  constexpr std::uint64_t kBuffers = std::uint64_t{8} << 20;
  return kBuffers + limits.stream_buffer;
}

// The highest estimate of a light run, with what is besides.
inline std::uint64_t max_light_bytes(const Limits& limits) {
  return kLightBytes + bytes_besides(limits);
}

// A request, parsed, and in the engine's form.
inline std::uint64_t bytes_of_request(const v1::GenerateMeshRequest& request) {
  return 2 * request.SpaceUsedLong();
}
// A request in the larger of these forms: the engine's segments have a marker and an area, 8 bytes,
// which the wire may leave out.
inline std::uint64_t bytes_of_larger_form(const v1::GenerateMeshRequest& request) {
  return request.SpaceUsedLong() + 4 * static_cast<std::uint64_t>(request.domain().segments_size());
}

// The field that takes most of the request.
inline const char* largest_field(const v1::GenerateMeshRequest& request) {
  return request.size().SpaceUsedLong() > request.domain().SpaceUsedLong() ? "size" : "domain";
}

}  // namespace weft::server
