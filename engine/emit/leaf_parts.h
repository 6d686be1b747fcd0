// SPDX-License-Identifier: Apache-2.0
// Makes the parts of finished leaves (emit.h), and gives back the memory that is no longer needed
// once they are built (emit/leaf_release.h).
//
//   LeafParts<ConstantArea> parts(mesh, order, leaves, numbers);
//   parts.number(l);           // in the order of the leaves
//   parts.hand_on(l);
//   parts.fill(l, builder);    // once those that overlap l have handed on
//   parts.built(l);
//
// Thread-safety: the steps may run in any order that LeafGraph permits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/held_bytes.h"
#include "engine/emit/emit.h"
#include "engine/emit/leaf_release.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/leaf_tasks.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"

namespace weft {

template <class AreaBound>
class LeafParts {
 public:
  // Numbers the leaves' vertices from `first_number` on. `earlier_owners` are in the order of their
  // leaves.
  LeafParts(MeshStore& mesh, const LeafOrder& order, LeafTasks<AreaBound>& leaves,
            std::uint32_t first_number, std::vector<EarlierOwner> earlier_owners)
      : mesh_(mesh),
        order_(order),
        leaves_(leaves),
        earlier_owners_(std::move(earlier_owners)),
        release_(order),
        handed_on_(order.size()),
        numbers_(first_number) {}

  void number(std::uint32_t leaf) {
    for_slots(leaf, [&](const Slots& s) { numbers_ = s.number_vertices(mesh_, numbers_); });
  }
  // The number after the last vertex numbered so far.
  std::uint32_t numbers() const { return numbers_; }

  // Copies the triangles that go with other parts.
  void hand_on(std::uint32_t leaf) {
    auto& handed_on = handed_on_[leaf];
    handed_on = triangles_handed_on(mesh_, leaves_.slots(leaf));
    copies_.add(handed_on.capacity() * sizeof(HandedOn));
  }

  void fill(std::uint32_t leaf, PartBuilder<AreaBound>& builder) const {
    const Slots& slots = leaves_.slots(leaf);
    std::size_t vertices = 0;
    for_slots(leaf, [&](const Slots& s) { vertices += s.vertex_count(); });
    builder.expect(vertices, slots.triangle_slots());
    for_slots(leaf, [&](const Slots& s) {
      s.for_vertices(
          [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
    });
    auto gone = handed_on_[leaf].cbegin();
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (; gone != handed_on_[leaf].cend() && first <= gone->slot && gone->slot < last; ++gone) {
        builder.add_triangles(first, gone->slot);
        first = gone->slot + 1;
      }
      builder.add_triangles(first, last);
    });
    for (const std::uint32_t other : order_.overlapping(leaf)) {
      if (other > leaf) break;
      for (const HandedOn& h : handed_on_[other]) {
        if (h.owner == slots.owner()) builder.add_triangle(h.triangle());
      }
    }
  }

  void built(std::uint32_t leaf) {
    leaves_.give_back_triangles(leaf);
    release_.part_built(
        leaf,
        [&](std::uint32_t a) {
          copies_.remove(handed_on_[a].capacity() * sizeof(HandedOn));
          handed_on_[a] = std::vector<HandedOn>();
        },
        [&](std::uint32_t b) { leaves_.give_back_vertices(b); });
  }

  // Keeps the vertices that the clean-up's triangles use, because these are sent last.
  void keep_vertices_of(const Slots& cleaned_up) {
    cleaned_up.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) {
        if (mesh_.triangles[t].dead()) continue;
        for (const std::uint32_t vertex : mesh_.triangles[t].vertex) {
          const std::uint32_t owner = mesh_.block_of_vertex(vertex).owner;
          if (owner >= leaves_.first_owner() && owner != cleaned_up.owner())
            release_.keep_vertices(owner - leaves_.first_owner());
        }
      }
    });
  }

  // Bytes at the peak.
  std::uint64_t bytes() const {
    return release_.bytes() + handed_on_.capacity() * sizeof(handed_on_[0]) + copies_.peak();
  }

 private:
  // Calls f for the owners whose vertices leave with the part of a leaf, in order.
  template <class F>
  void for_slots(std::uint32_t leaf, F&& f) const {
    auto earlier =
        std::lower_bound(earlier_owners_.begin(), earlier_owners_.end(), leaf,
                         [](const EarlierOwner& owner, std::uint32_t l) { return owner.leaf < l; });
    for (; earlier != earlier_owners_.end() && earlier->leaf == leaf; ++earlier) f(*earlier->slots);
    f(leaves_.slots(leaf));
  }

  MeshStore& mesh_;
  const LeafOrder& order_;
  LeafTasks<AreaBound>& leaves_;
  std::vector<EarlierOwner> earlier_owners_;  // by the leaf
  LeafRelease release_;
  std::vector<std::vector<HandedOn>> handed_on_;  // per leaf
  HeldBytes copies_;
  std::uint32_t numbers_;
};

}  // namespace weft
