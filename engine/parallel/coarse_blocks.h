// SPDX-License-Identifier: Apache-2.0
// Makes the coarse mesh of a mesh with many leaves block by block, so that the first leaves are
// refined and sent before most of the coarse mesh is made.
//
// A block is a node of the leaves' quadtree, with a dozen to some dozens of leaves below it. Blocks
// are the leaves of a coarser tree of the same boxes, and are refined as leaves are (leaf_tasks.h),
// by tasks of the same graph: first one thread refines the coarse mesh as a whole for the blocks,
// then each block is refined for its leaves (leaf_radius.h). The leaves refine what a block's
// rounds leave.
//
//   CoarseBlocks<ConstantArea> blocks(refinement, quality, area, tree, box, 1e6);
//   if (auto error = blocks.begin(slots, box)) return error;
//   if (blocks.fit()) BlockGraph::add(blocks.order(), blocks.near(), graph);
//   ... blocks.refine(b, 0), blocks.refine(b, 1), blocks.judge(b), blocks.seed(l, leaves) ...
//
// The blocks of many leaves are ordered along the sweep, so that the first ones are done soon;
// those of few leaves so that chains of blocks that wait for one another are short.
//
// A block has two rounds, in both of which bad triangles outside the block migrate. The second
// leaves few triangles, which the leaves refine.
//
// Then the triangles in the slots of the block, and those of owner 0 with centroids in the block,
// are judged by the bounds of the final mesh. Only tasks of the block and of blocks that overlap it
// touch them, and these are done: a triangle in a slot of block b lies in b's halo
// (emit/leaf_release.h, 2), and so does one of owner 0 (`fit`).
//
// A leaf begins when all blocks whose halos overlap its own are judged: only these have triangles
// with two vertices there, or with centroids in the leaf, and no task of any other block touches
// these.
//
// Once the fragments of all leaves around a block are built, the triangles in its slots are no
// longer read: a leaf's fragment waits for the tasks of the leaves that overlap it, to which a
// triangle may have migrated from it. Nearly always all of them are dead, and their slots are given
// back. Vertices stay.
//
// Errors: those of refinement (refine/refiner.h). Thread-safety: the steps may run in any order
// that BlockGraph permits, of different blocks and leaves at the same time.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/parallel/block_graph.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/leaf_radius.h"
#include "engine/parallel/leaf_tasks.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/refiner.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/triangle_judge.h"

namespace weft {

template <class AreaBound>
class CoarseBlocks {
 public:
  using Tasks = LeafTasks<LeafRadius<AreaBound>>;

  // `leaves` is the tree over `box`; a block weighs at most `weight`. REQUIRES: all leaves are
  // dense (leaf_radius.h), and the tree outlives this.
  CoarseBlocks(const RefinementContext& refinement, const QualityBounds& quality,
               const AreaBound& area, const Quadtree& leaves, const Box& box, double weight)
      : refinement_(refinement),
        quality_(quality),
        no_angles_(without_angles(quality)),
        area_(area),
        leaves_(leaves),
        tree_(blocks_over(leaves, box, weight)),
        order_(leaves.leaves().size() <= LeafOrder::kFewLeaves ? LeafOrder(tree_)
                                                               : LeafOrder::along_sweep(tree_)),
        block_radius_(tree_, 0, area, refinement.context),
        radius_(leaves, 0, area, refinement.context),
        tasks_(refinement, no_angles_, radius_, tree_, order_, kFirstOwner, false),
        base_(order_.size()),
        near_(tree_, leaves),
        judged_(order_.size()),
        unseeded_(order_.size()),
        unbuilt_(order_.size()),
        unfit_(leaves.leaves().size()) {
    for (std::uint32_t l = 0; l < near_.leaves(); ++l) {
      for (const std::uint32_t b : near_[l]) {
        ++unseeded_[b];
        ++unbuilt_[b];
      }
    }
  }

  static constexpr std::uint32_t kFirstOwner = 1;  // of slots; the leaves' come after the blocks'

  // Refines the coarse mesh for the blocks. `slots` has all triangles.
  std::optional<Error> begin(Slots& slots, const Box& box) {
    Refiner<OwnsAll, LeafRadius<AreaBound>> refiner(refinement_, no_angles_, block_radius_);
    refiner.begin(slots, OwnsAll{}, box);
    auto error = refiner.queue_all();
    if (!error) error = refiner.run();
    stats_ = refiner.stats();
    if (!error) spread(slots);
    return error;
  }

  // Whether each triangle of owner 0 lies in the halo of the block of its centroid. If not, blocks
  // cannot be refined by tasks.
  bool fit() const { return fit_; }

  std::uint32_t size() const { return tasks_.size(); }
  const LeafOrder& order() const { return order_; }
  const BlocksNear& near() const { return near_; }
  const Slots& slots(std::uint32_t block) const { return tasks_.slots(block); }
  std::uint64_t deferred() const { return tasks_.deferred(); }

  std::optional<Error> refine(std::uint32_t block, std::uint32_t round) {
    return tasks_.refine(block, round);
  }

  std::optional<Error> judge(std::uint32_t block) {
    AreaBound area = area_.again();
    area.begin(tree_.leaves()[block].halo);
    TriangleJudge judge;
    const auto look_at = [&](std::uint32_t t) {
      if (!refinement_.mesh.triangles[t].dead()) judge_triangle(t, judge, area, judged_[block]);
    };
    for (const std::uint32_t t : base_[block]) look_at(t);
    base_[block] = std::vector<std::uint32_t>();
    slots(block).for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) look_at(t);
    });
    std::stable_sort(judged_[block].begin(), judged_[block].end(), LessByLeaf{});
    if (const auto& bad = area.bad_size()) return bad_size_error(*bad);
    return refinement_.context.poll();
  }

  // Gives a leaf the bad triangles to begin with. Call once per leaf.
  void seed(std::uint32_t leaf, LeafTasks<AreaBound>& leaves) {
    std::vector<BadTriangle> seeds;
    for (const std::uint32_t b : near_[leaf]) {
      const auto [first, last] =
          std::equal_range(judged_[b].begin(), judged_[b].end(), leaf, LessByLeaf{});
      for (auto j = first; j != last; ++j) {
        if (j->bad) seeds.push_back(j->triangle);
        if (!j->fits) unfit_[leaf].push_back(j->triangle.triangle);
      }
      if (unseeded_[b].fetch_sub(1, std::memory_order_acq_rel) == 1)
        judged_[b] = std::vector<Judged>();
    }
    leaves.seed(leaf, seeds);
  }

  // Whether no triangle of the coarse mesh is left in a leaf with a circumradius of more than a
  // quarter of the leaf's side: then the clean-up stays near. REQUIRES: the leaf's rounds are done.
  bool leaf_fits(std::uint32_t leaf) const {
    return std::all_of(unfit_[leaf].begin(), unfit_[leaf].end(),
                       [&](std::uint32_t t) { return refinement_.mesh.triangles[t].dead(); });
  }

  // Call when the fragment of a leaf is built.
  void built(std::uint32_t leaf) {
    for (const std::uint32_t b : near_[leaf]) {
      if (unbuilt_[b].fetch_sub(1, std::memory_order_acq_rel) == 1 && all_dead(slots(b)))
        tasks_.give_back_triangles(b);
    }
  }

  RefinerStats stats() const {
    RefinerStats sum = stats_;
    sum += tasks_.stats();
    return sum;
  }
  // Bytes at the peak, without the judged triangles.
  std::uint64_t bytes() const {
    return tasks_.bytes() + order_.bytes() + tree_.bytes() + radius_.bytes() + near_.bytes() +
           unfit_.capacity() * sizeof(unfit_[0]);
  }

 private:
  struct Judged {
    std::uint32_t leaf;  // where its centroid lies
    BadTriangle triangle;
    bool bad;
    bool fits;
  };
  struct LessByLeaf {
    bool operator()(const Judged& a, const Judged& b) const { return a.leaf < b.leaf; }
    bool operator()(const Judged& a, std::uint32_t leaf) const { return a.leaf < leaf; }
    bool operator()(std::uint32_t leaf, const Judged& b) const { return leaf < b.leaf; }
  };

  static QualityBounds without_angles(QualityBounds quality) {
    quality.sin2 = 0;
    quality.off_centre = 0;
    return quality;
  }

  // Builds the blocks' tree from one sample per leaf, so only nodes are split that are split in the
  // leaves' tree.
  static Quadtree blocks_over(const Quadtree& leaves, const Box& box, double weight) {
    std::vector<Quadtree::Sample> samples;
    samples.reserve(leaves.leaves().size());
    for (const Quadtree::Leaf& leaf : leaves.leaves())
      samples.push_back(
          {{0.5 * (leaf.box.min_x + leaf.box.max_x), 0.5 * (leaf.box.min_y + leaf.box.max_y)},
           leaf.weight});
    return Quadtree::build(box, std::move(samples), weight);
  }

  Point centroid_of(std::uint32_t t) const {
    const auto& v = refinement_.mesh.triangles[t].vertex;
    const auto& vertices = refinement_.mesh.vertices;
    return centroid(vertices[v[0]], vertices[v[1]], vertices[v[2]]);
  }
  double region_bound(std::uint32_t t) const {
    return refinement_.regions[refinement_.mesh.triangles[t].region].max_area;
  }

  bool all_dead(const Slots& slots) const {
    bool dead = true;
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t)
        dead = dead && refinement_.mesh.triangles[t].dead();
    });
    return dead;
  }

  // Distributes owner 0's triangles to the blocks.
  void spread(const Slots& slots) {
    const MeshStore& mesh = refinement_.mesh;
    LeafRadius<AreaBound> radius = radius_.again();
    TriangleJudge judge;
    std::vector<BadTriangle> bad;
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) {
        Triangle& triangle = mesh.triangles[t];
        const std::uint32_t block = tree_.leaf_at(centroid_of(t));
        const Box& halo = tree_.leaves()[block].halo;
        for (const std::uint32_t v : triangle.vertex)
          fit_ = fit_ && OwnsBox::contains(halo, mesh.vertices[v].x, mesh.vertices[v].y);
        base_[block].push_back(t);
        triangle.set_badness(judge(mesh, t, region_bound(t), no_angles_, radius));
        if (triangle.badness() != kGood) bad.push_back({t, triangle.vertex[0]});
      }
    });
    tasks_.seed(bad);
  }

  void judge_triangle(std::uint32_t t, TriangleJudge& judge, AreaBound& area,
                      std::vector<Judged>& judged) {
    const MeshStore& mesh = refinement_.mesh;
    Triangle& triangle = mesh.triangles[t];
    const Badness badness = judge(mesh, t, region_bound(t), quality_, area);
    triangle.set_badness(badness);
    const Point middle = centroid_of(t);
    const std::uint32_t leaf = leaves_.leaf_at(middle);
    const auto& v = triangle.vertex;
    const double radius2 =
        circumradius2(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]);
    const double limit = LeafRadius<AreaBound>::kRadiusPerSide * leaves_.leaves()[leaf].side();
    const bool fits = radius2 <= limit * limit;
    if (badness == kGood && fits) return;
    judged.push_back({leaf, {t, triangle.vertex[0]}, badness != kGood, fits});
  }

  const RefinementContext refinement_;
  const QualityBounds quality_;
  const QualityBounds no_angles_;
  const AreaBound& area_;
  const Quadtree& leaves_;
  const Quadtree tree_;
  const LeafOrder order_;
  const LeafRadius<AreaBound> block_radius_;
  const LeafRadius<AreaBound> radius_;  // of the leaves
  Tasks tasks_;
  std::vector<std::vector<std::uint32_t>> base_;  // per block, owner 0's triangles, until judged
  const BlocksNear near_;
  std::vector<std::vector<Judged>> judged_;  // per block, until its leaves are seeded
  // Per block, the number of leaves near it that are not seeded, and of those whose fragments are
  // not built.
  std::vector<std::atomic<std::uint32_t>> unseeded_;
  std::vector<std::atomic<std::uint32_t>> unbuilt_;
  std::vector<std::vector<std::uint32_t>> unfit_;  // per leaf
  bool fit_ = true;
  RefinerStats stats_;
};

}  // namespace weft
