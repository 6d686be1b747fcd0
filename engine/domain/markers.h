// SPDX-License-Identifier: Apache-2.0
// Lists of markers, as requests give them: of any length. Linear or logarithmic time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "weft/pslg.h"

namespace weft {

class MarkerSet {
 public:
  explicit MarkerSet(std::vector<std::int32_t> markers) : markers_(std::move(markers)) {
    std::sort(markers_.begin(), markers_.end());
  }

  bool contains(std::int32_t marker) const {
    return std::binary_search(markers_.begin(), markers_.end(), marker);
  }

 private:
  std::vector<std::int32_t> markers_;  // ascending
};

// The index of the first marker that no segment has.
inline std::optional<std::size_t> first_without_segment(const std::vector<std::int32_t>& markers,
                                                        const std::vector<Segment>& segments) {
  std::unordered_set<std::int32_t> missing(markers.begin(), markers.end());
  for (const Segment& segment : segments) missing.erase(segment.marker);
  const auto first = std::find_if(markers.begin(), markers.end(),
                                  [&](std::int32_t marker) { return missing.contains(marker); });
  if (first == markers.end()) return std::nullopt;
  return static_cast<std::size_t>(first - markers.begin());
}

}  // namespace weft
