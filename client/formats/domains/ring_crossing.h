// SPDX-License-Identifier: Apache-2.0
// Finds where a ring crosses itself: M. I. Shamos and D. Hoey, "Geometric intersection problems",
// 1976, O(n log n), with exact predicates. Only edges whose interiors cross count; a ring that
// touches itself, at a vertex or along an edge, is accepted, because even-odd filling handles it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "client/formats/domain.h"

namespace weft::client {

// Two crossing edges, the lower index first; edge i runs from ring[i] to ring[i + 1], the last one
// back to ring[0]. REQUIRES: neighbours differ, coordinates are finite.
std::optional<std::pair<std::uint32_t, std::uint32_t>> find_crossing(std::span<const Point> ring);

}  // namespace weft::client
