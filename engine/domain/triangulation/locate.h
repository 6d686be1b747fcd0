// SPDX-License-Identifier: Apache-2.0
// Where a point lies in an arrangement.
#pragma once

#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/stop_poller.h"

namespace weft {

struct Location {
  std::uint32_t triangle = kNone;  // it contains the point; kNone outside the convex hull
  bool on_segment = false;         // on a constrained edge, decided exactly
  bool on_vertex = false;
};

// Walks from triangle `start`. Exact predicates; throws Stopped.
Location locate(const Arrangement& arrangement, Point p, std::uint32_t start, StopPoller& poller);

// Whether a segment or a vertex is nearer to p than `distance`. REQUIRES: the triangle contains p.
bool is_near(const Arrangement& arrangement, Point p, std::uint32_t triangle, double distance,
             StopPoller& poller);

}  // namespace weft
