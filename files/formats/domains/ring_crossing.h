// SPDX-License-Identifier: Apache-2.0
// Finds where a ring crosses itself, and where the rings of a polygon overlap: M. I. Shamos and D.
// Hoey, "Geometric intersection problems", 1976, O(n log n), with exact predicates. Only edges
// whose interiors cross count; rings that touch, at a vertex or along an edge, are accepted,
// because even-odd filling handles them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "files/formats/domain.h"

namespace weft::files {

// Two crossing edges, the lower index first; edge i runs from ring[i] to ring[i + 1], the last one
// back to ring[0]. REQUIRES: neighbours differ, coordinates are finite.
std::optional<std::pair<std::uint32_t, std::uint32_t>> find_crossing(std::span<const Point> ring);

// A ring that parity does not treat as what it is.
struct RingOverlap {
  std::uint32_t ring = 0;
  std::optional<std::uint32_t> crossed;  // another ring, if their edges cross
  Point at;  // where the ring begins to overlap, or an end of the edge that crosses
};

// What tells the holes of a polygon from its other rings: all but the first are holes; holes run
// the other way round; nothing but where they are.
enum class RingRoles { kOuterFirst, kByDirection, kByPlace };

// The first of the rings of a polygon that cross each other; or a ring that `roles` do not make
// what parity makes of it: a hole outside of the polygon or in another hole, a ring in another one
// that is no hole. REQUIRES: as find_crossing, of each ring; none crosses itself; there is a ring.
std::optional<RingOverlap> find_overlap(std::span<const std::span<const Point>> rings,
                                        RingRoles roles);

}  // namespace weft::files
