// SPDX-License-Identifier: Apache-2.0
// When the memory of a leaf may be given back, while other leaves are refined and sent.
//
// Everything follows from halos; two leaves overlap if their halos do. Around a leaf a are rings: a
// itself (0), the leaves that overlap a (1), the leaves that overlap one of those (2).
//
//   1. The vertices of a lie in its halo. They are made there, and smoothing moves none out of any
//      halo that it is in (parallel/leaf_tasks.h, OwnsBoxUnfrozen).
//   2. A triangle in a's slots was made by a's task, which owned all three vertices: they lie in
//      its halo. So each belongs to ring 0 or 1, or to an owner before the leaves
//      (parallel/coarse_blocks.h), whose vertices stay.
//   3. A task touches a triangle only if it owns two of its vertices (refine/ownership.h). If the
//      triangle is in a slot of a, its vertices lie in both halos: the task is one of ring 0 or 1.
//      Refinement and smoothing keep to this alike: smoothing reads the triangles at a star, two of
//      whose vertices are on its link or in its middle, and of those across the link the ends of
//      the edge between.
//   4. Building the fragment of a reads the triangles in a's slots, and the copies that ring 1 has
//      exported.
//
//   what of a        is read by                                  is given back when
//   triangles        tasks of rings 0 and 1 (3), its own         its own fragment is built, because
//                    fragment (4)                                that waits for ring 1
//   copies that it   fragments of rings 0 and 1 (4)              these fragments are built
//   has exported
//   vertices, with   tasks and fragments of rings 0 to 2:        these fragments are built
//   their numbers    through triangles in slots of rings 0 and
//   and segments     1 (2), which one ring more touches (3, 4)
//
// The fragment of a leaf waits until its rings 0 to 2 have done their rounds, and rings 0 and 1 are
// smoothed. So once all fragments of rings 0 to 2 of a are built, nothing there is still to be
// refined, smoothed or built.
//
// The clean-up comes after all fragments of the frozen leaves, and touches triangles with two
// vertices outside the halos of these. They are in slots of leaves that are not frozen (2) and
// whose fragments are not built, so all their vertices still exist. Its own triangles may be sent
// after everything else: the leaves whose vertices it uses keep these (`keep_vertices`).
//
// Thread-safety: several threads may call `fragment_built` at the same time, once for each leaf;
// the rest may be called only while no other call runs.
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
      unbuilt_[l] = unsettled_[l] = static_cast<std::uint32_t>(order.overlapping(l).size() + 1);
  }

  // Call when a fragment is built. Calls drop_copies(a) for each leaf a whose copies are no longer
  // read, and drop_vertices(b) for each leaf b whose vertices are no longer read.
  template <class DropCopies, class DropVertices>
  void fragment_built(std::uint32_t leaf, DropCopies&& drop_copies, DropVertices&& drop_vertices) {
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
  // Calls f for a leaf and those that overlap it.
  template <class F>
  void for_around(std::uint32_t leaf, F&& f) const {
    f(leaf);
    for (const std::uint32_t other : order_->overlapping(leaf)) f(other);
  }

  const LeafOrder* order_ = nullptr;
  // Per leaf, the number of leaves among itself and the overlapping ones whose fragments are not
  // built, and of those around which not all fragments are built.
  std::vector<std::atomic<std::uint32_t>> unbuilt_;
  std::vector<std::atomic<std::uint32_t>> unsettled_;
  std::vector<char> kept_;
};

}  // namespace weft
