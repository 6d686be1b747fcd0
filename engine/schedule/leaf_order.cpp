// SPDX-License-Identifier: Apache-2.0
#include "engine/schedule/leaf_order.h"

#include <algorithm>

namespace weft {

LeafOrder::LeafOrder(const Quadtree& tree)
    : conflicts_(tree.conflicts()), colours_(conflicts_.size(), 0) {
  std::vector<bool> used;
  for (std::uint32_t l = 0; l < size(); ++l) {
    used.assign(conflicts_[l].size() + 1, false);
    for (const std::uint32_t other : conflicts_[l]) {
      if (other < l && colours_[other] < used.size()) used[colours_[other]] = true;
    }
    const auto free = std::find(used.begin(), used.end(), false);
    colours_[l] = static_cast<std::uint32_t>(free - used.begin());
  }
}

bool LeafOrder::in_conflict(std::uint32_t leaf, std::uint32_t other) const {
  return std::binary_search(conflicts_[leaf].begin(), conflicts_[leaf].end(), other);
}

std::size_t LeafOrder::bytes() const {
  std::size_t bytes = colours_.capacity() * sizeof(std::uint32_t) +
                      conflicts_.capacity() * sizeof(std::vector<std::uint32_t>);
  for (const auto& c : conflicts_) bytes += c.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace weft
