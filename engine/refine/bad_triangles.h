// SPDX-License-Identifier: GPL-3.0-or-later
// The bad triangles that wait to be refined, and their order.
//
// Too large ones come first, by how much too large they are (four levels an octave), the last in
// first within a level. Against a single stack that makes 1.7 % fewer triangles of the cylinder
// model, and the same speed while a task's mesh stays in the cache.
//
// Entries are 4 bytes, and the triangle's own badness tells whether one is stale (two thirds are):
// nothing is ever searched for or removed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "engine/refine/mesh.h"

namespace weft {

// Which skinny triangle comes next, when no triangle is too large.
//   kLastInFirstOut: the fastest where the size field makes most of the triangles.
//   kShortestFirst: by the shortest edge. Where quality makes most of the triangles it makes fewer,
//     and it ends at angles where the other does not (though not always: 360 rays from one point
//     at 34 degrees go on to the triangle limit):
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

  // REQUIRES: the triangle has this badness.
  void push(std::uint32_t t, Badness badness) {
    if (order_ == Order::kShortestFirst && badness == kSkinny) [[unlikely]] {
      shortest_first_.push({t, static_cast<float>(shortest_edge2(t))});
      peak_skinny_ = std::max(peak_skinny_, shortest_first_.size());
      return;
    }
    levels_[badness].push_back(t);
    in_use_[badness / 64] |= std::uint64_t{1} << badness % 64;
  }

  // The next one that is still as bad, or kNone.
  std::uint32_t pop() {
    for (std::size_t word = in_use_.size(); word-- > 0;) {
      while (in_use_[word] != 0) {
        const auto level = static_cast<Badness>(64 * word + 63 - std::countl_zero(in_use_[word]));
        std::vector<std::uint32_t>& entries = levels_[level];
        while (!entries.empty()) {
          const std::uint32_t t = entries.back();
          entries.pop_back();
          if (mesh_.triangles[t].badness() == level) return t;
        }
        in_use_[word] &= ~(std::uint64_t{1} << level % 64);
      }
    }
    while (!shortest_first_.empty()) {
      const std::uint32_t t = shortest_first_.top().triangle;
      shortest_first_.pop();
      if (mesh_.triangles[t].badness() == kSkinny) return t;
    }
    return kNone;
  }

  // Forgets all that waits.
  void clear() {
    for (auto& entries : levels_) entries.clear();
    in_use_ = {};
    shortest_first_ = {};
  }

  std::uint64_t bytes() const {
    std::uint64_t entries = 0;
    for (const auto& level : levels_) entries += level.capacity();
    return entries * sizeof(std::uint32_t) + peak_skinny_ * sizeof(Skinny);
  }

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
  std::array<std::vector<std::uint32_t>, kWorst + 1> levels_;  // by badness
  std::array<std::uint64_t, (kWorst + 64) / 64> in_use_{};     // a bit a level
  std::priority_queue<Skinny> shortest_first_;                 // the skinny ones, kShortestFirst
  std::size_t peak_skinny_ = 0;
};

}  // namespace weft
