// SPDX-License-Identifier: Apache-2.0
// The leaves of a mesh, ready to be refined: runs the coarse phase, and holds its results: the
// quadtree, the order, the blocks and the leaves' tasks.
//
//   LeafStage<ConstantArea> stage(plan, area, refinement, root);
//   if (auto error = stage.prepare(true)) return error;
//   if (stage.exists()) LeafRun<ConstantArea>(stage, ...).run();
//
// Not thread-safe; the headers of `blocks` and `leaves` say what tasks may call.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/parallel/coarse_blocks.h"
#include "engine/parallel/coarse_phase.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/leaf_tasks.h"
#include "engine/parallel/mesh_plan.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/storage/slots.h"

namespace weft {

template <class AreaBound>
class LeafStage {
 public:
  // From so many leaves on, fragments are sent while others are refined. A smaller mesh takes
  // little time, and may be cleaned up anywhere.
  static constexpr std::uint32_t kStreamingLeaves = 64;

  // `root` has all triangles of the mesh. All outlive this.
  LeafStage(const MeshPlan& plan, const AreaBound& area, const RefinementContext& refinement,
            Slots& root)
      : plan_(plan), area_(area), refinement_(refinement), root_(root) {}

  // Errors: those of refinement (refine/refiner.h).
  std::optional<Error> prepare(bool may_stream) {
    const double pieces = may_stream ? plan_.leaves_per_block() : 1;
    CoarsePhase<AreaBound> coarse(refinement_, plan_.quality, area_, plan_.narrow,
                                  plan_.leaf_triangles, pieces, root_);
    auto tree = coarse.find_tree(plan_.box);
    if (!tree) return tree.error();
    tree_ = std::move(*tree);
    for (const Quadtree::Leaf& leaf : tree_.leaves()) total_weight_ += leaf.weight;
    auto error = tree_.leaves().size() > 1 ? make_leaves(coarse, pieces, may_stream) : std::nullopt;
    before_ += coarse.stats();
    return error;
  }

  // Whether there are leaves; if not, the mesh should be refined by one task.
  bool exists() const { return leaves_.has_value(); }
  // Whether fragments may be sent while others are refined.
  bool streams() const { return streams_; }

  const Quadtree& tree() const { return tree_; }
  const LeafOrder& order() const { return order_; }
  // REQUIRES: exists().
  LeafTasks<AreaBound>& leaves() { return *leaves_; }
  // Null if the coarse mesh was refined as a whole.
  CoarseBlocks<AreaBound>* blocks() { return blocks_ ? &*blocks_ : nullptr; }

  // A leaf's share of the work.
  double share_of(std::uint32_t leaf) const { return tree_.leaves()[leaf].weight / total_weight_; }

  // The owners of the blocks, each with the leaf before whose vertices its own are sent.
  std::vector<EarlierOwner> earlier_owners() const {
    std::vector<EarlierOwner> result;
    if (!blocks_) return result;
    std::vector<char> met(blocks_->size(), 0);
    for (std::uint32_t l = 0; l < leaves_->size(); ++l) {
      for (const std::uint32_t b : blocks_->near()[l]) {
        if (!std::exchange(met[b], 1)) result.push_back({l, &blocks_->slots(b)});
      }
    }
    return result;
  }

  // The statistics of all refiners so far.
  RefinerStats stats() const {
    RefinerStats all = before_;
    if (leaves_) all += leaves_->stats();
    if (blocks_) all += blocks_->stats();
    return all;
  }
  std::uint64_t deferred() const {
    return (leaves_ ? leaves_->deferred() : 0) + (blocks_ ? blocks_->deferred() : 0);
  }
  // Bytes of tables and tasks.
  std::uint64_t bytes() const {
    return (leaves_ ? leaves_->bytes() + order_.bytes() + tree_.bytes() : 0) +
           (blocks_ ? blocks_->bytes() : 0);
  }
  // Bytes of those that exist from the beginning to the end.
  std::uint64_t lasting_bytes() const {
    constexpr std::uint64_t kPerLeaf = 320;  // leaf_tasks.h, leaf_fragments.h
    return order_.bytes() + tree_.bytes() + leaves_->size() * kPerLeaf +
           (blocks_ ? blocks_->bytes() : 0);
  }

 private:
  std::optional<Error> make_leaves(CoarsePhase<AreaBound>& coarse, double pieces, bool may_stream) {
    if (pieces > 1 && coarse.all_dense(tree_)) {
      if (auto error = make_blocks(pieces)) return error;
    }
    if (!blocks_) {
      if (auto error = coarse.fit(tree_, plan_.box)) return error;
      order_ = coarse.take_order();
    }
    const std::uint32_t first_owner =
        CoarseBlocks<AreaBound>::kFirstOwner + (blocks_ ? blocks_->size() : 0);
    leaves_.emplace(refinement_, plan_.quality, area_, tree_, order_, first_owner,
                    plan_.sweeps > 0);
    if (!blocks_) leaves_->seed(coarse.bad_triangles());
    streams_ = coarse.fits() && leaves_->size() >= kStreamingLeaves && may_stream;
    return std::nullopt;
  }

  // Makes blocks, if the coarse mesh can be refined in blocks.
  std::optional<Error> make_blocks(double leaves_per_block) {
    ExecutionContext& context = refinement_.context;
    std::optional<Error> error;
    blocks_.emplace(refinement_, plan_.quality, area_, tree_, plan_.box,
                    plan_.leaf_triangles * leaves_per_block);
    if ((error = context.poll())) return error;
    context.for_each(2, [&](std::size_t which) {
      if (which == 0) error = blocks_->begin(root_, plan_.box);
      if (which == 1) order_ = CoarsePhase<AreaBound>::order_of(tree_, area_);
    });
    context.end_stage("blocks");
    if (!error) error = context.poll();
    if (!error && blocks_->fit() && tree_.leaves().size() >= kStreamingLeaves) return std::nullopt;
    before_ += blocks_->stats();
    blocks_.reset();
    return error;
  }

  const MeshPlan& plan_;
  const AreaBound& area_;
  const RefinementContext& refinement_;
  Slots& root_;
  Quadtree tree_;
  LeafOrder order_;
  std::optional<CoarseBlocks<AreaBound>> blocks_;
  std::optional<LeafTasks<AreaBound>> leaves_;
  bool streams_ = false;
  double total_weight_ = 0;
  RefinerStats before_;  // the coarse phase's, and those of blocks that were given up
};

}  // namespace weft
