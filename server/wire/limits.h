// SPDX-License-Identifier: Apache-2.0
// What a request may ask for. Whatever is over a limit is refused before any work, and the message
// names both the value and the limit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "server/wire/errors.h"
#include "server/wire/wire_scan.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

// Chunks number vertices and triangles with 32 bits, and a mesh has more triangles than vertices.
inline constexpr std::uint64_t kMaxTriangles = 4'294'967'295;

struct Limits {
  std::uint64_t max_points = 5'000'000;
  std::uint64_t max_segments = 5'000'000;
  std::uint64_t max_seeds = 100'000;  // holes, regions and areas together
  std::uint64_t max_expression_bytes = kMaxExpressionBytes;
  std::uint64_t max_raster_values = std::uint64_t{1} << 24;
  std::uint64_t max_triangles = kMaxTriangles;
  std::uint64_t max_bytes = std::uint64_t{4} << 30;      // of engine memory per run
  double max_seconds = 3600;                             // of work per run
  std::uint64_t stream_buffer = std::uint64_t{8} << 20;  // of a mesh that waits for its reader
  std::uint64_t max_request_bytes = std::uint64_t{256} << 20;  // REQUIRES: < 2 GiB
};

// A limit on a number of things in a request. `name` is its field in v1::ServerLimits, and with
// dashes its flag: max_points, --max-points.
struct CountLimit {
  std::string_view name;
  std::uint64_t Limits::*limit;
  std::string_view about;  // the help of the flag
};
inline constexpr std::array kCountLimits = {
    CountLimit{"max_points", &Limits::max_points, "Maximum points per request"},
    CountLimit{"max_segments", &Limits::max_segments, "Maximum segments per request"},
    CountLimit{"max_seeds", &Limits::max_seeds,
               "Maximum seeds of holes and regions, and areas, per request"},
    CountLimit{"max_raster_values", &Limits::max_raster_values, "Maximum values of a size raster"},
};

std::optional<Failure> check_limits(const v1::GenerateMeshRequest& request, const Limits& limits);

// The same for a request that is not parsed yet, of what takes memory: parsing what passes takes at
// most the memory of a request at its limits, and its own bytes.
std::optional<Failure> check_limits(const WireScan& scan, const Limits& limits);

}  // namespace weft::server
