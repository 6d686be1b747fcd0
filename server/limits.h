// SPDX-License-Identifier: Apache-2.0
// What a request may ask for. Whatever is over a limit is refused before any work, and the message
// names both the value and the limit.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/size/expression.h"
#include "server/errors.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

struct Limits {
  std::uint64_t max_points = 5'000'000;
  std::uint64_t max_segments = 5'000'000;
  std::uint64_t max_seeds = 100'000;  // holes and regions together
  std::uint64_t max_expression_bytes = Expression::kMaxLength;
  std::uint64_t max_raster_values = std::uint64_t{1} << 24;
  std::uint64_t max_triangles = 200'000'000;
  std::uint64_t max_bytes = std::uint64_t{4} << 30;            // of engine memory a job
  double max_seconds = 3600;                                   // of work a job
  std::uint64_t max_request_bytes = std::uint64_t{256} << 20;  // REQUIRES: < 2 GiB
};

// REQUIRES: check_shape(request) found nothing.
std::optional<Failure> check_limits(const v1::GenerateMeshRequest& request, const Limits& limits);

// For requests that are not parsed yet: 2 bytes on the wire become 80 in memory for each region, so
// the count must be known before.
std::optional<Failure> check_seed_count(std::uint64_t seeds, const Limits& limits);

}  // namespace weft::server
