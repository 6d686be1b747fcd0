// SPDX-License-Identifier: Apache-2.0
// Which narrow water may be closed without losing what lies behind it.
//
// Waters are what is connected across edges, and weigh as many equilateral triangles of the finest
// edges as they enclose where they are not narrow. A strait is narrow water on the widest way from
// the heaviest water to one that weighs kLarge or more, or that must stay. All other narrow water
// may be closed: what that cuts off weighs less, and need not stay.
//
// Method: the spanning forest of triangles and waters that prefers wide triangles (Kruskal 1956),
// in which a way between two waters is the widest; each tree hangs from its heaviest water, and a
// triangle is in a strait if what hangs from it weighs kLarge or more, or must stay.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/stop_poller.h"

namespace weft {

inline constexpr double kLarge = 100;

// Per triangle of the arrangement.
struct Waters {
  const Arrangement& arrangement;
  const std::vector<std::uint32_t>& region;  // kNone is land
  const std::vector<double>& width;   // of narrow water that may be closed; infinity for the rest
  const std::vector<double>& weight;  // 0 or more, may be infinite
  const std::vector<bool>& must_stay;
};

// Per triangle: whether it is in a strait. Throws Stopped.
std::vector<bool> find_straits(const Waters& waters, StopPoller& poller);

// The number of sets of triangles that hold, connected across edges; `set` gets the number of each
// triangle's set, kNone for those that do not hold. Throws Stopped.
std::uint32_t number_sets(const Arrangement& arrangement, const std::vector<bool>& holds,
                          std::vector<std::uint32_t>& set, StopPoller& poller);

}  // namespace weft
