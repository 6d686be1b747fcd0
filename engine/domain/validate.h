// SPDX-License-Identifier: Apache-2.0
// The checks of a PSLG that need no triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/stop_poller.h"
#include "weft/error.h"
#include "weft/pslg.h"

namespace weft {

// Returns the error of the first offender, in the order: points, segments, arcs, holes, regions,
// snap, then the points as a whole; nullopt if the PSLG is valid. Throws Stopped.
std::optional<Error> validate(const Pslg& pslg, StopPoller& poller);

// The first two points that are distinct, and the first that is not on their line; fewer if there
// are none.
struct Span {
  std::array<std::uint32_t, 3> point{};
  unsigned size = 0;
};
Span spanning_points(const std::vector<Point>& points, StopPoller& poller);

}  // namespace weft
