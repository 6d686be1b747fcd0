// SPDX-License-Identifier: Apache-2.0
// When the memory of a leaf may be given back, while other leaves are refined and sent.
//
// Everything follows from grown boxes; leaves are in conflict if theirs overlap. For leaf a:
//   1. Its vertices lie in its grown box. They are made there, and smoothing moves none out of any
//      grown box that it is in (leaf_tasks.h, OwnsBoxUnfrozen).
//   2. A triangle in its slots was made by its task, which owned all three vertices: they lie in
//      its grown box. So each belongs to a, to a leaf in conflict with a, or to an owner before
//      the leaves (coarse_blocks.h), whose vertices stay.
//   3. A task touches a triangle only if it owns two of its vertices (refine/ownership.h). If the
//      triangle is in a slot of a, its vertices lie in both grown boxes: the task is a's, or that
//      of a leaf in conflict with a. Refinement and smoothing keep to this alike: smoothing reads
//      the triangles at a star, two of whose vertices are on its link or in its middle, and of
//      those across the link the ends of the edge between.
//   4. Building the part of a reads the triangles in the slots of a, and the copies that leaves
//      in conflict with a have handed on.
//
// Only a and the leaves in conflict with it read the TRIANGLES of a, and all that its rounds left
// behind (3, 4). The part of a waits until these leaves are done, so a's triangles may be freed
// once it is built. (Triangles that a hands on are copied before.)
//
// The COPIES that a handed on are read when parts of a and of leaves in conflict with it are built.
//
// The VERTICES of b are read through triangles in slots of b and of leaves in conflict with b (2),
// or copies of these, by tasks at most one conflict away from the slots' leaf (3, 4): two conflicts
// away from b at most. Before the part of a leaf, the rounds of all that are at most two conflicts
// away are done, and smoothing of all in conflict with it. So once all parts at most two conflicts
// away from b are built, nothing at most two conflicts away from b is left to be refined, smoothed
// or built, and the vertices, their numbers and subsegments may be freed. Smoothing needs no
// further ring, because it reads no further than refinement does.
//
// The clean-up comes after all parts of the frozen leaves, and touches triangles with two vertices
// outside the grown boxes of these. They are in slots of leaves that are not frozen (2) and whose
// parts are not built, so all their vertices still exist. Its own triangles may be sent after
// everything else: the leaves whose vertices it uses keep these (`keep_vertices`).
//
// Thread-safety: several threads may call `part_built` at the same time, once for each leaf; the
// rest may be called only while no other call runs.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/parallel/leaf_order.h"

namespace weft {

class LeafRelease {
 public:
  LeafRelease() = default;
  explicit LeafRelease(const LeafOrder& order)
      : order_(&order), unbuilt_(order.size()), unsettled_(order.size()), kept_(order.size(), 0) {
    for (std::uint32_t l = 0; l < order.size(); ++l)
      unbuilt_[l] = unsettled_[l] = static_cast<std::uint32_t>(order.conflicts(l).size() + 1);
  }

  // Call when a part is built. Calls drop_copies(a) for each leaf a whose copies are no longer
  // read, and drop_vertices(b) for each leaf b whose vertices are no longer read.
  template <class DropCopies, class DropVertices>
  void part_built(std::uint32_t leaf, DropCopies&& drop_copies, DropVertices&& drop_vertices) {
    for_around(leaf, [&](std::uint32_t a) {
      if (unbuilt_[a].fetch_sub(1, std::memory_order_acq_rel) != 1) return;
      drop_copies(a);
      for_around(a, [&](std::uint32_t b) {
        if (unsettled_[b].fetch_sub(1, std::memory_order_acq_rel) == 1 && !kept_[b])
          drop_vertices(b);
      });
    });
  }

  // Keeps the vertices of this leaf until the end.
  void keep_vertices(std::uint32_t leaf) { kept_[leaf] = 1; }

  std::uint64_t bytes() const {
    return unbuilt_.capacity() * 2 * sizeof(unbuilt_[0]) + kept_.capacity();
  }

 private:
  // Calls f for a leaf and those in conflict with it.
  template <class F>
  void for_around(std::uint32_t leaf, F&& f) const {
    f(leaf);
    for (const std::uint32_t other : order_->conflicts(leaf)) f(other);
  }

  const LeafOrder* order_ = nullptr;
  // Per leaf, the number of leaves among itself and those in conflict whose parts are not built,
  // and of those around which not all parts are built.
  std::vector<std::atomic<std::uint32_t>> unbuilt_;
  std::vector<std::atomic<std::uint32_t>> unsettled_;
  std::vector<char> kept_;
};

}  // namespace weft
