// SPDX-License-Identifier: Apache-2.0
// The checks of a PSLG that need no triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/geometry.h"
#include "engine/domain/pslg.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// Magnitudes of coordinates other than 0, so that products of four of them stay in range.
inline constexpr double kMinMagnitude = 1e-100;
inline constexpr double kMaxMagnitude = 1e50;

// Points of one PSLG, so that vertices and triangles can be numbered in 32 bits.
inline constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 28;
inline constexpr std::uint64_t kMaxSegments = std::uint64_t{1} << 30;

// Returns the error of the first offender, in the order: points, segments, holes, regions, snap,
// then the points as a whole; nullopt if the PSLG is valid. Throws Stopped.
std::optional<Error> validate(const Pslg& pslg, StopPoller& poller);

// The first two points that are distinct, and the first that is not on their line; fewer if there
// are none.
struct Span {
  std::array<std::uint32_t, 3> point{};
  unsigned size = 0;
};
Span spanning_points(const std::vector<Point>& points, StopPoller& poller);

}  // namespace weft
