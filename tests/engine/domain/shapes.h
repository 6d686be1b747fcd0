// SPDX-License-Identifier: Apache-2.0
// Small PSLGs put together by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "weft/pslg.h"

namespace weft {

inline void add_segment(Pslg& pslg, Point a, Point b, std::int32_t marker = 0) {
  const auto n = static_cast<std::uint32_t>(pslg.points.size());
  pslg.points.insert(pslg.points.end(), {a, b});
  pslg.segments.push_back({n, n + 1, marker});
}

inline void add_ring(Pslg& pslg, const std::vector<Point>& ring, std::int32_t marker = 0) {
  const auto n = static_cast<std::uint32_t>(pslg.points.size());
  const auto size = static_cast<std::uint32_t>(ring.size());
  pslg.points.insert(pslg.points.end(), ring.begin(), ring.end());
  for (std::uint32_t i = 0; i < size; ++i)
    pslg.segments.push_back({n + i, n + (i + 1) % size, marker});
}

inline void add_box(Pslg& pslg, Point low, Point high, std::int32_t marker = 0) {
  add_ring(pslg, {low, {high.x, low.y}, high, {low.x, high.y}}, marker);
}

// Makes the segments from number `first` on the border of a new area.
inline void add_area(Pslg& pslg, std::size_t first, const Area& area) {
  for (std::size_t i = first; i < pslg.segments.size(); ++i)
    pslg.segments[i].area = static_cast<std::uint32_t>(pslg.areas.size());
  pslg.areas.push_back(area);
}

inline void add_area_box(Pslg& pslg, Point low, Point high, const Area& area = {}) {
  const std::size_t first = pslg.segments.size();
  add_box(pslg, low, high);
  add_area(pslg, first, area);
}

inline Pslg square(double side = 1) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {side, side});
  return pslg;
}

}  // namespace weft
