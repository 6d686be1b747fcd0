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
  MappedArea(const Expression& expression, const SizeMap& map)
      : expression_(expression), map_(map) {}

  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                    double region_bound, const QualityBounds& quality, std::uint32_t* badness) {
    // Mostly the ring lies in the box of the last one, where the function is constant.
    const double room = std::min(std::min(p.x - box_.min_x, box_.max_x - p.x),
                                 std::min(p.y - box_.min_y, box_.max_y - p.y));
    if (room > 0) [[likely]] {
      const RingVerdict verdict =
          judge_ring(ring, first, last, quality,
                     UniformAreaBound{2 * std::min(size_, region_bound)}, room * room, badness);
      if (!verdict.beyond) [[likely]]
        return verdict;
    }
    return judge_elsewhere(ring, first, last, p, region_bound, quality, badness);
  }

  // Insertions between polls: fewer where the expression is long (4,096 powers take 1 ms a ring).
  std::uint32_t poll_interval() const {
    return 1 + static_cast<std::uint32_t>(512 / (1 + expression_.operations() / 16));
  }

  // The grading function at n points. REQUIRES: as Expression::evaluate.
  void bounds_at(std::size_t n, const double* x, const double* y, double* bound);

  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  // The vectors that hold an expression's batches.
  struct alignas(64) Lanes {
    double values[Expression::kLanes];
  };

  // Finds a box around the ring where the function is constant, or evaluates it.
  RingVerdict judge_elsewhere(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                              double region_bound, const QualityBounds& quality,
                              std::uint32_t* badness);
  // Evaluates the function at the centroids.
  RingVerdict judge_evaluated(const SizeMap::Place& place, const Ring& ring, std::uint32_t first,
                              std::uint32_t last, Point p, double region_bound,
                              const QualityBounds& quality, std::uint32_t* badness);

  const Expression& expression_;
  const SizeMap& map_;
  Box box_;          // where the function is constant; empty at first
  double size_ = 0;  // its value there
  std::vector<Lanes> x_, y_, bound_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
