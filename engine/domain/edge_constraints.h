// SPDX-License-Identifier: GPL-3.0-or-later
// What lies on each constrained edge, looked up by its two vertices.
//
// A hash table with open addressing, in shards: one table of millions of edges would rehash, and
// one of nodes would be freed, for longer than a cancellation may take. It is never walked, so its
// order cannot leak into a result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/domain/arrangement.h"

namespace weft {

// Edges are named by the ids of their vertices, in any order.
class EdgeConstraints {
 public:
  using Constraint = Arrangement::Constraint;

  // Merges with what lies on the edge already.
  void add(std::uint32_t a, std::uint32_t b, const Constraint& constraint);

  // REQUIRES: the edge is in the table.
  const Constraint& at(std::uint32_t a, std::uint32_t b) const;
  Constraint take(std::uint32_t a, std::uint32_t b);

  std::size_t size() const { return size_; }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no edge joins kNone to kNone

  struct Slot {
    std::uint64_t key = kFree;
    Constraint constraint;
  };

  // Its size is a power of two, at most three quarters of it in use; an edge lies in the first free
  // slot from its home on.
  struct Shard {
    std::vector<Slot> slots;
    std::size_t used = 0;

    std::size_t home(std::uint64_t key) const;
    std::size_t find(std::uint64_t key) const;  // the edge's slot, or the free one it would take
    void grow();
    void erase(std::size_t slot);
  };

  static std::uint64_t key(std::uint32_t a, std::uint32_t b);
  static std::uint64_t hash(std::uint64_t key);
  static std::size_t shard(std::uint64_t key) { return hash(key) >> 56; }

  std::array<Shard, 256> shards_;
  std::size_t size_ = 0;
};

}  // namespace weft
