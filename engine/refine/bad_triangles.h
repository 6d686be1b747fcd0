// SPDX-License-Identifier: Apache-2.0
// The queue of bad triangles, which orders refinement.
//
//   - Too large ones come first, the one farthest over its bound first: four levels per octave,
//     last in first out within a level.
//   - Then come the skinny ones, the smallest first, by the longest edge times the cube of the
//     shortest: refining these makes larger triangles around them, and few of either are needed.
//
// Nothing is ever searched for or removed: an entry goes stale when its triangle dies, as two
// thirds do. The entry of a too large triangle has 4 bytes, and is valid if the slot's triangle
// still has that badness. The entry of a skinny triangle has the first vertex as well, which names
// the triangle (refiner.h): the slot's next triangle, skinny too, but much larger, must not take
// its place. bench/README.md compares other orders.
//
// Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/refine/storage/mesh_store.h"

namespace weft {

class BadTriangles {
 public:
  explicit BadTriangles(const MeshStore& mesh) : mesh_(mesh), heads_(64 * kSkinnyWords) {}

  // REQUIRES: the triangle has this badness.
  void push(std::uint32_t t, Badness badness) {
    if (badness == kSkinny) [[unlikely]] {
      push_skinny(t, static_cast<float>(size_of(t)));
      return;
    }
    levels_[badness].push_back(t);
    in_use_[badness / 64] |= std::uint64_t{1} << badness % 64;
  }

  // Removes and returns the next triangle that is still as bad; kNone if there is none.
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
    for (; first_word_ < kSkinnyWords; ++first_word_) {
      while (skinny_in_use_[first_word_] != 0) {
        const std::size_t level =
            64 * first_word_ + static_cast<unsigned>(std::countr_zero(skinny_in_use_[first_word_]));
        const std::uint32_t entry = heads_[level];
        const Skinny skinny = skinny_[entry];
        heads_[level] = skinny.next;
        skinny_[entry].next = free_;
        free_ = entry;
        if (skinny.next == kNone) {
          skinny_in_use_[first_word_] &= ~(std::uint64_t{1} << level % 64);
        } else {
          // The next one may be anywhere in the mesh: prefetch it while this one is refined.
          __builtin_prefetch(&mesh_.triangles[skinny_[skinny.next].triangle]);
        }
        const Triangle& t = mesh_.triangles[skinny.triangle];
        if (t.badness() == kSkinny && t.vertex[0] == skinny.first_vertex) return skinny.triangle;
      }
    }
    return kNone;
  }

  // Removes all entries.
  void clear() {
    for (auto& entries : levels_) entries.clear();
    in_use_ = {};
    skinny_.clear();
    free_ = kNone;
    skinny_in_use_ = {};
    first_word_ = kSkinnyWords;
  }

  std::uint64_t bytes() const {
    std::uint64_t entries = 0;
    for (const auto& level : levels_) entries += level.capacity();
    return (entries + heads_.capacity()) * sizeof(std::uint32_t) +
           skinny_.capacity() * sizeof(Skinny);
  }

 private:
  // Skinny triangles by size, eight levels per octave; last in first out within a level.
  struct Skinny {
    std::uint32_t triangle;
    std::uint32_t first_vertex;
    std::uint32_t next;
  };
  static constexpr unsigned kDropped = 20;  // of a float's bits
  static constexpr std::size_t kSkinnyWords = (std::size_t{1} << (31 - kDropped)) / 64;

  void push_skinny(std::uint32_t t, float size) {
    const std::size_t level = std::bit_cast<std::uint32_t>(size) >> kDropped;
    std::uint32_t entry = free_;
    if (entry == kNone) {
      entry = static_cast<std::uint32_t>(skinny_.size());
      skinny_.push_back({});
    } else {
      free_ = skinny_[entry].next;
    }
    skinny_[entry] = {t, mesh_.triangles[t].vertex[0],
                      (skinny_in_use_[level / 64] >> level % 64 & 1) ? heads_[level] : kNone};
    heads_[level] = entry;
    skinny_in_use_[level / 64] |= std::uint64_t{1} << level % 64;
    first_word_ = std::min(first_word_, level / 64);
  }

  // The root of its longest edge times the cube of its shortest: an area.
  double size_of(std::uint32_t t) const {
    const Triangle& triangle = mesh_.triangles[t];
    double shortest2 = std::numeric_limits<double>::infinity();
    double longest2 = 0;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Point a = mesh_.vertices[triangle.vertex[i]];
      const Point b = mesh_.vertices[triangle.vertex[kNext[i]]];
      const double length2 = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
      shortest2 = std::min(shortest2, length2);
      longest2 = std::max(longest2, length2);
    }
    return std::sqrt(shortest2 * std::sqrt(shortest2 * longest2));
  }

  const MeshStore& mesh_;
  std::array<std::vector<std::uint32_t>, kWorst + 1> levels_;  // by badness
  std::array<std::uint64_t, (kWorst + 64) / 64> in_use_{};     // a bit per level
  std::vector<Skinny> skinny_;
  std::uint32_t free_ = kNone;
  std::vector<std::uint32_t> heads_;  // valid if skinny_in_use_ has the bit
  std::array<std::uint64_t, kSkinnyWords> skinny_in_use_{};
  std::size_t first_word_ = kSkinnyWords;
};

}  // namespace weft
