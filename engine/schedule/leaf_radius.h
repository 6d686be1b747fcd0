// SPDX-License-Identifier: GPL-3.0-or-later
// The prelude's criterion, the paper's eq. 5: refine until every circumradius is below a quarter of
// the side of the leaf where the triangle's centroid lies. Vertices are never removed, so once it
// holds, circumdisks stay small, and a leaf's task rarely meets what it does not own.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/refine/area_bound.h"
#include "engine/schedule/quadtree.h"

namespace weft {

// Stands in for the grading function (refine/area_bound.h).
class LeafRadius {
 public:
  static constexpr double kFraction = 4;

  explicit LeafRadius(const Quadtree& tree) : tree_(&tree) {}

  void begin(const Box&) {}
  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p, double,
                    const QualityBounds& quality, Badness* badness) const {
    const RingVerdict verdict =
        judge_ring(ring, first, last, quality,
                   UniformAreaBound{std::numeric_limits<double>::infinity()}, badness);
    for (std::uint32_t i = first; i < last; ++i) {
      const RingPoint& a = ring.points[i];
      const RingPoint& b = ring.points[i + 1];
      const double ex = b.x - a.x;
      const double ey = b.y - a.y;
      const Point centroid{p.x + (a.x + b.x) * (1.0 / 3), p.y + (a.y + b.y) * (1.0 / 3)};
      // R = |a| |b| |e| / (2 a x b)
      const double product = a.length2 * b.length2 * (ex * ex + ey * ey);
      const double limit = 2 / kFraction * tree_->leaves()[tree_->leaf_at(centroid)].side();
      const double allowed = limit * b.cross * (limit * b.cross);
      badness[i] = product > allowed ? badness_of_size(product, allowed) : kGood;
    }
    return verdict;
  }

  static constexpr std::uint32_t poll_interval() { return 512; }
  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  const Quadtree* tree_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
