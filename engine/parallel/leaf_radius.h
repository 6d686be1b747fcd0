// SPDX-License-Identifier: Apache-2.0
// The coarse phase's criterion, after the paper's eq. 5: refine until every circumradius is below a
// quarter of the side of the leaf where the triangle's centroid lies. Vertices are never removed,
// so once it holds, circumdisks stay small, and a leaf's task rarely meets vertices that it does
// not own.
//
// That makes some 25 triangles in a leaf, so it is applied only to dense leaves, for which many
// more are expected. Around a dense leaf the limit grows by half of the distance from it; away from
// all of them it is twice the leaf's side. So it makes about 1 % more triangles than the size asks
// for, even if few leaves are dense.
//
// Units: lengths of the domain; weights are triangles. Thread-safety: `again` makes one for each
// thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/area_bound.h"

namespace weft {

// The weight from which on a leaf counts as dense: `dense`, or 0 if applying the criterion to all
// leaves adds little to the mesh. So a mesh that fills most of its leaves has the criterion in all
// of them, and may be streamed (CoarsePhase::fits), which takes less memory.
inline double dense_weight(const Quadtree& tree, double dense) {
  constexpr double kInLeaf = 25;  // triangles
  constexpr double kFew = 0.002;  // of all
  double light = 0;
  double all = 0;
  for (const Quadtree::Leaf& leaf : tree.leaves()) {
    all += leaf.weight;
    if (leaf.weight < dense) light += kInLeaf;
  }
  return light <= kFew * all ? 0 : dense;
}

// Replaces the grading function (refine/area_bound.h), except for its lattice, because points that
// are inserted here stay in the final mesh.
template <class AreaBound>
class LeafRadius {
 public:
  static constexpr bool kBoundsAreas = false;
  static constexpr double kRadiusPerSide = 0.25;

  // A leaf is dense from this weight on. REQUIRES: the tree outlives this, and all like it.
  LeafRadius(const Quadtree& tree, double dense, const AreaBound& area,
             const ExecutionContext& context)
      : tree_(&tree), area_(area.again()) {
    constexpr std::size_t kAtOnce = 32;
    const auto& leaves = tree.leaves();
    const auto is_dense = [&](std::uint32_t l) { return leaves[l].weight >= dense; };
    std::vector<Near> near(leaves.size());
    context.for_each((leaves.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t batch) {
      if (context.poll()) return;  // the caller polls, too
      const std::size_t end = std::min((batch + 1) * kAtOnce, leaves.size());
      for (auto l = static_cast<std::uint32_t>(batch * kAtOnce); l < end; ++l) {
        if (is_dense(l)) near[l].push_back(l);
        for (const std::uint32_t other : tree.touching(l)) {
          const bool counts = !is_dense(l) || leaves[other].depth > leaves[l].depth;
          if (counts && is_dense(other)) near[l].push_back(other);
        }
      }
    });
    dense_near_ = std::make_shared<const std::vector<Near>>(std::move(near));
  }

  // A copy for another thread.
  LeafRadius again() const { return *this; }

  // The limit on the circumradius of a triangle with this centroid.
  double limit_at(Point centroid) const {
    const auto& leaves = tree_->leaves();
    const std::uint32_t leaf = tree_->leaf_at(centroid);
    double limit = kElsewhere * leaves[leaf].side();
    for (const std::uint32_t l : (*dense_near_)[leaf]) {
      const double away = std::max(0.0, -room_in(leaves[l].box, centroid));
      limit = std::min(limit, kRadiusPerSide * leaves[l].side() + kGrowth * away);
    }
    return limit;
  }

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
      const double limit = 2 * limit_at(centroid);
      const double allowed = limit * b.cross * (limit * b.cross);
      badness[i] = product > allowed ? badness_of_size(product, allowed) : kGood;
    }
    return verdict;
  }

  LatticePoint nearest_of_lattice(Point c, double region_bound, const LatticeShape& shape) {
    return area_.nearest_of_lattice(c, region_bound, shape);
  }

  // None: a coarse mesh has no rows of the final one (refine/row_filler.h).
  std::optional<double> uniform_bound(const Box&) const { return std::nullopt; }

  std::uint64_t bytes() const {
    std::uint64_t bytes = dense_near_->capacity() * sizeof(Near);
    for (const Near& near : *dense_near_) bytes += near.capacity() * sizeof(near[0]);
    return bytes;
  }

  static constexpr std::uint32_t poll_interval() { return 512; }
  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  static constexpr double kElsewhere = 2;
  static constexpr double kGrowth = 0.5;  // 1 doubles what is deferred and saves 0.1 %

  // The dense leaves among a leaf and those that it touches. In a dense leaf, only smaller ones set
  // a lower limit than its own.
  using Near = std::vector<std::uint32_t>;

  const Quadtree* tree_;
  AreaBound area_;
  std::shared_ptr<const std::vector<Near>> dense_near_;  // per leaf
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
