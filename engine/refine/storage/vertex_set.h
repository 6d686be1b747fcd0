// SPDX-License-Identifier: Apache-2.0
// A set of vertices that is filled and cleared many times: a table with open addressing. No result
// depends on its order.
//
// Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {

class VertexSet {
 public:
  void clear() {
    std::fill(slots_.begin(), slots_.end(), kNone);
    size_ = 0;
  }

  // Returns whether the vertex is new. REQUIRES: it is not kNone.
  bool add(std::uint32_t vertex) {
    if (2 * size_ >= slots_.size()) grow();
    std::uint32_t& slot = find(vertex);
    if (slot == vertex) return false;
    slot = vertex;
    ++size_;
    return true;
  }

  std::uint64_t bytes() const { return slots_.capacity() * sizeof(slots_[0]); }

 private:
  static constexpr std::size_t kFirst = 1024;  // slots, a power of two

  // The slot of the vertex, or the free one where it would go.
  std::uint32_t& find(std::uint32_t vertex) {
    const std::size_t last = slots_.size() - 1;
    std::size_t i = vertex * 0x9e3779b97f4a7c15u >> 20 & last;
    while (slots_[i] != kNone && slots_[i] != vertex) i = (i + 1) & last;
    return slots_[i];
  }

  void grow() {
    std::vector<std::uint32_t> old(std::max(kFirst, 2 * slots_.size()), kNone);
    std::swap(old, slots_);
    for (const std::uint32_t vertex : old) {
      if (vertex != kNone) find(vertex) = vertex;
    }
  }

  std::vector<std::uint32_t> slots_;
  std::size_t size_ = 0;
};

}  // namespace weft
