// SPDX-License-Identifier: GPL-3.0-or-later
// The bad triangles that wait to be refined, and their order.
//
// Entries are 4 bytes, and the triangle's own badness tells whether one is stale (two thirds are):
// nothing is ever searched for or removed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>

#include "engine/refine/block_stack.h"
#include "engine/refine/mesh.h"

namespace weft {

// Which bad triangle comes next.
//   kLastInFirstOut: the fastest where the size field makes most of the triangles.
//   kShortestFirst: too large ones first, then skinny ones by their shortest edge. Where quality
//     makes most of the triangles it makes fewer, and it ends at angles where the other does not
//     (though not always: 360 rays from one point at 34 degrees go on to the triangle limit):
//
//       us-east-coast, no size    20 deg    30 deg    33 deg     34 deg
//       kLastInFirstOut           20,350    48,068    384,465    (does not end)
//       kShortestFirst            18,803    37,053     72,617    102,864
//
//     It costs 4 % at 20 degrees and 27 % at 30 on cylinder with its size (960,000 triangles).
enum class Order : std::uint8_t { kLastInFirstOut, kShortestFirst };

class BadTriangles {
 public:
  BadTriangles(const Mesh& mesh, Order order) : mesh_(mesh), order_(order) {}

  void push(std::uint32_t t) {
    if (order_ == Order::kLastInFirstOut || mesh_.triangles[t].badness() == Badness::kLarge)
        [[likely]] {
      last_in_.push(t);
    } else {
      shortest_first_.push({t, static_cast<float>(shortest_edge2(t))});
      peak_skinny_ = std::max(peak_skinny_, shortest_first_.size());
    }
  }

  // The next one that is still bad, or kNone.
  std::uint32_t pop() {
    while (!last_in_.empty()) {
      const std::uint32_t t = last_in_.pop();
      if (mesh_.triangles[t].badness() != Badness::kGood) return t;
    }
    while (!shortest_first_.empty()) {
      const std::uint32_t t = shortest_first_.top().triangle;
      shortest_first_.pop();
      if (mesh_.triangles[t].badness() != Badness::kGood) return t;
    }
    return kNone;
  }

  std::uint64_t peak_bytes() const { return last_in_.peak_bytes() + peak_skinny_ * sizeof(Skinny); }

 private:
  // A skinny triangle by its shortest edge.
  struct Skinny {
    std::uint32_t triangle;
    float shortest2;
    bool operator<(const Skinny& other) const { return shortest2 > other.shortest2; }
  };

  double shortest_edge2(std::uint32_t t) const {
    const Triangle& triangle = mesh_.triangles[t];
    double shortest2 = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Point a = mesh_.vertices[triangle.vertex[i]];
      const Point b = mesh_.vertices[triangle.vertex[kNext[i]]];
      shortest2 = std::min(shortest2, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    }
    return shortest2;
  }

  const Mesh& mesh_;
  const Order order_;
  BlockStack<std::uint32_t> last_in_;
  std::priority_queue<Skinny> shortest_first_;  // the skinny ones, for kShortestFirst
  std::size_t peak_skinny_ = 0;
};

}  // namespace weft
