// SPDX-License-Identifier: GPL-3.0-or-later
// A grading function that is an expression: evaluated for a ring of triangles at a time, and only
// where the size map's bounds leave a doubt (size/size_map.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/refine/area_bound.h"
#include "engine/size/size_map.h"

namespace weft {

// One a thread: it remembers the box of the last ring, where the next one mostly lies, too.
class MappedArea {
 public:
  MappedArea(const Expression& size, const SizeMap& map) : size_(size), map_(map) {}

  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                    double region_bound, const QualityBounds& quality, std::uint32_t* badness) {
    find_place(ring, first, last, p);
    if (place_.node->constant() && place_.node->lo > 0) [[likely]] {
      return judge_ring(ring, first, last, quality,
                        UniformAreaBound{2 * std::min(place_.node->lo, region_bound)}, badness);
    }
    return judge_evaluated(ring, first, last, p, region_bound, quality, badness);
  }

  // Insertions between polls: fewer where the expression is long (4,096 powers take 1 ms a ring).
  std::uint32_t poll_interval() const {
    return 1 + static_cast<std::uint32_t>(512 / (1 + size_.operations() / 16));
  }

  // The grading function at n points. REQUIRES: as Expression::evaluate.
  void bounds_at(std::size_t n, const double* x, const double* y, double* bound);

  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  // The vectors that hold an expression's batches.
  struct alignas(64) Lanes {
    double values[Expression::kLanes];
  };

  void find_place(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p);
  RingVerdict judge_evaluated(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                              double region_bound, const QualityBounds& quality,
                              std::uint32_t* badness);

  const Expression& size_;
  const SizeMap& map_;
  SizeMap::Place place_{nullptr, {}};
  std::vector<Lanes> x_, y_, bound_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
