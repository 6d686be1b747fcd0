// SPDX-License-Identifier: Apache-2.0
// What a request may ask for. Whatever is over a limit is refused before any work, and the message
// names both the value and the limit.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/engine.h"
#include "server/wire/errors.h"
#include "server/wire/wire_scan.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// Chunks number vertices and triangles with 32 bits, and a mesh has more triangles than vertices.
inline constexpr std::uint64_t kMostTriangles = 4'294'967'295;

struct Limits {
  std::uint64_t max_points = 5'000'000;
  std::uint64_t max_segments = 5'000'000;
  std::uint64_t max_seeds = 100'000;  // holes and regions together
  std::uint64_t max_expression_bytes = Expression::kMaxLength;
  std::uint64_t max_raster_values = std::uint64_t{1} << 24;
  std::uint64_t max_triangles = kMostTriangles;
  std::uint64_t max_bytes = std::uint64_t{4} << 30;      // of engine memory a job
  double max_seconds = 3600;                             // of work a job
  std::uint64_t stream_buffer = std::uint64_t{8} << 20;  // of a mesh that waits for its reader
  std::uint64_t max_request_bytes = std::uint64_t{256} << 20;  // REQUIRES: < 2 GiB
};

// REQUIRES: check_shape(request) found nothing.
std::optional<Failure> check_limits(const v1::GenerateMeshRequest& request, const Limits& limits);

// The same for a request that is not parsed yet, of what takes memory: parsing what passes takes at
// most the memory of a request at its limits, and its own bytes.
std::optional<Failure> check_limits(const WireScan& scan, const Limits& limits);

}  // namespace weft::server
