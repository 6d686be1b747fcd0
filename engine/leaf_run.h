// SPDX-License-Identifier: Apache-2.0
// Refines the leaves and emits them. If the mesh streams, leaves are sent up to the first one near
// triangles that the rounds left bad. Then these are cleaned up, and the remaining leaves are sent.
//
//   LeafRun<ConstantArea> run(plan, refinement, stage, root, fragments);
//   if (auto error = run.run()) return error;
//
// A leaf is settled if it and the leaves that overlap it have nothing pending, and final if all of
// these are settled: then no task touches its slots but its own smoothing, and what builds its
// fragment (parallel/leaf_graph.h).
//
// Errors: those of refinement (refine/refiner.h) and of the sink. Not thread-safe: one run at a
// time; its tasks go to the context's arena.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/held_bytes.h"
#include "engine/base/trace.h"
#include "engine/base/work_time.h"
#include "engine/emit/leaf_fragments.h"
#include "engine/emit/slot_fragments.h"
#include "engine/parallel/block_graph.h"
#include "engine/parallel/leaf_graph.h"
#include "engine/parallel/leaf_stage.h"
#include "engine/parallel/mesh_plan.h"
#include "engine/parallel/task_graph.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/storage/slots.h"

namespace weft {

template <class AreaBound>
class LeafRun {
 public:
  // Refinement's share of the work; the rest is building fragments.
  static constexpr double kRefining = 0.65;

  // `root` is owner 0's. REQUIRES: the stage exists.
  LeafRun(const MeshPlan& plan, const RefinementContext& refinement, LeafStage<AreaBound>& stage,
          Slots& root, SlotFragments<AreaBound>& fragments)
      : plan_(plan),
        context_(refinement.context),
        mesh_(refinement.mesh),
        stage_(stage),
        order_(stage.order()),
        leaves_(stage.leaves()),
        blocks_(stage.blocks()),
        root_(root),
        fragments_(fragments),
        leaf_fragments_(mesh_, order_, leaves_, root.number_vertices(mesh_, 0),
                        stage.earlier_owners()),
        settled_(leaves_.size()),
        smoothed_(leaves_.size()),
        final_leaves_(stage.streams() ? leaves_.size() : 0) {}

  // Errors: those of refinement, and the sink's.
  std::optional<Error> run() {
    const HeldBytes::Scope held(context_.held_bytes(), stage_.lasting_bytes());
    const std::uint32_t n = leaves_.size();
    if (stage_.streams()) fragments_.send_vertices(root_);  // any leaf may refer to these
    context_.end_stage("opening fragment");
    if (auto error = refine_all()) return error;
    if (!stopped() && final_leaves_ < n) {
      cleaned_up_ = true;
      if (leaves_.pending() > 0 || !plan_.sides.empty()) clean_up();
      if (!stage_.streams() && !stopped()) fragments_.send_vertices(root_);
      send_from(final_leaves_.exchange(n));
    }
    if (!stopped()) send_closing();
    return fragments_.run().error();
  }

  // Whether some leaves could not be sent before all were refined.
  bool cleaned_up() const { return cleaned_up_; }
  // The sum over all tasks.
  double refine_seconds() const { return time_.seconds(); }
  // Bytes of the fragments' tables, at the peak.
  std::uint64_t bytes() const { return leaf_fragments_.bytes(); }

 private:
  bool stopped() const { return fragments_.run().stopped(); }

  std::optional<Error> refine_all() {
    const bool streams = stage_.streams();
    auto graph =
        BlockGraph::of_run(order_, streams, plan_.sweeps > 0, blocks_ ? &blocks_->order() : nullptr,
                           blocks_ ? &blocks_->near() : nullptr, context_);
    if (!graph) return graph.error();
    fragments_.run().run(LeafGraph::kName, std::move(*graph), 0, final_leaves_, LeafGraph::emit,
                         [this, streams](std::uint32_t task) {
                           const std::uint32_t leaf = task / LeafGraph::kTasks;
                           const std::uint32_t step = task % LeafGraph::kTasks;
                           if (leaf >= leaves_.size()) return do_block(leaf - leaves_.size(), step);
                           if (step < LeafGraph::kRounds) refine(leaf, step);
                           if (task == LeafGraph::check_pending(leaf)) check_pending(leaf);
                           if (!streams) return;  // nothing to settle yet
                           if (task == LeafGraph::check_settled(leaf))
                             settled_[leaf] = is_settled(leaf);
                           if (task == LeafGraph::smooth(leaf) && settled_[leaf]) smooth(leaf, 0);
                           if (task == LeafGraph::number_vertices(leaf) && !is_final(leaf))
                             end_sending_at(leaf);
                           if (leaf < final_leaves_) send_leaf(task, leaf);
                         });
    return std::nullopt;
  }

  // Sends the leaves that were not sent before the clean-up.
  void send_from(std::uint32_t first) {
    TaskGraph graph(leaves_.size() * LeafGraph::kTasks);
    LeafGraph::add_emission(order_, graph, plan_.sweeps > 0);
    if (stopped()) return;
    fragments_.run().run(LeafGraph::kName, std::move(graph), first, leaves_.size(), LeafGraph::emit,
                         [this, first](std::uint32_t task) {
                           const std::uint32_t leaf = task / LeafGraph::kTasks;
                           if (leaf < first) return;
                           if (task == LeafGraph::smooth(leaf) && !smoothed_[leaf])
                             smooth(leaf, first);
                           send_leaf(task, leaf);
                         });
  }

  // Does a task of a block.
  void do_block(std::uint32_t block, std::uint32_t step) {
    if (step > BlockGraph::kRounds) return;
    const auto error = time_.measure([&] {
      return step < BlockGraph::kRounds ? blocks_->refine(block, step) : blocks_->judge(block);
    });
    if (error) fragments_.run().stop(*error);
  }

  void refine(std::uint32_t leaf, std::uint32_t round) {
    if (round == 0 && blocks_) blocks_->seed(leaf, leaves_);
    if (auto error = time_.measure([&] { return leaves_.refine(leaf, round); }))
      fragments_.run().stop(*error);
    if (round == 0) context_.add_fraction(kRefining * stage_.share_of(leaf));
    if (round >= LeafGraph::kMigrationRounds && !leaves_.has_pending(leaf))
      skip_rounds(leaf, round + 1, LeafGraph::round(leaf, round));
  }

  void check_pending(std::uint32_t leaf) {
    if (!leaves_.has_work(leaf, LeafGraph::kMigrationRounds))
      skip_rounds(leaf, LeafGraph::kMigrationRounds, LeafGraph::check_pending(leaf));
  }

  // Skips the rounds from `first` on; task `by` found that they have nothing to do.
  void skip_rounds(std::uint32_t leaf, std::uint32_t first, std::uint32_t by) {
    for (std::uint32_t round = LeafGraph::kRounds; round-- > first;) {
      if (Trace* const trace = context_.trace()) trace->skip(LeafGraph::round(leaf, round), by);
      fragments_.run().skip(LeafGraph::round(leaf, round));
    }
  }

  void smooth(std::uint32_t leaf, std::uint32_t frozen) {
    smoothed_[leaf] = true;
    if (plan_.sweeps == 0) return;
    if (auto error = time_.measure([&] { return leaves_.smooth(leaf, plan_.sweeps, frozen); }))
      fragments_.run().stop(*error);
  }

  // The leaf is not final, so it and those after it wait for the clean-up.
  void end_sending_at(std::uint32_t leaf) {
    if (leaf >= final_leaves_) return;
    final_leaves_ = leaf;
    fragments_.run().end_hold();
  }

  bool is_settled(std::uint32_t leaf) const {
    const auto& around = order_.overlapping(leaf);
    return !leaves_.has_pending(leaf) && (!blocks_ || blocks_->leaf_fits(leaf)) &&
           std::none_of(around.begin(), around.end(),
                        [&](std::uint32_t other) { return leaves_.has_pending(other); });
  }
  bool is_final(std::uint32_t leaf) const {
    const auto& around = order_.overlapping(leaf);
    return settled_[leaf] && std::all_of(around.begin(), around.end(),
                                         [&](std::uint32_t other) { return settled_[other]; });
  }

  // Does one of the tasks that make a fragment of a final leaf.
  void send_leaf(std::uint32_t task, std::uint32_t leaf) {
    if (task == LeafGraph::number_vertices(leaf)) leaf_fragments_.number_vertices(leaf);
    if (task == LeafGraph::export_triangles(leaf)) leaf_fragments_.export_triangles(leaf);
    if (task != LeafGraph::emit(leaf)) return;
    context_.add_fraction((1 - kRefining) * stage_.share_of(leaf));
    fragments_.run().finish(leaf, fragments_.build([&](FragmentBuilder<AreaBound>& builder) {
      leaf_fragments_.fill(leaf, builder);
    }));
    leaf_fragments_.built(leaf);
    if (blocks_) blocks_->built(leaf);
  }

  void clean_up() {
    auto error = context_.compute([&] {
      return time_.measure([&] { return leaves_.clean_up(final_leaves_, plan_.sides, root_); });
    });
    if (error) fragments_.run().stop(*error);
    leaf_fragments_.keep_vertices_of(leaves_.clean_up_slots());
    context_.end_stage("clean-up");
  }

  // Sends the triangles that the clean-up has made, and those of owner 0 and of the blocks that no
  // leaf has touched.
  void send_closing() {
    const Slots& cleaned_up = leaves_.clean_up_slots();
    cleaned_up.number_vertices(mesh_, leaf_fragments_.numbers());
    typename SlotFragments<AreaBound>::Sections sections;
    sections.add_vertices(cleaned_up);
    sections.add_triangles(cleaned_up);
    sections.add_triangles(root_);
    for (std::uint32_t b = 0; blocks_ && b < blocks_->size(); ++b)
      sections.add_triangles(blocks_->slots(b));
    fragments_.send(sections);
  }

  const MeshPlan& plan_;
  ExecutionContext& context_;
  MeshStore& mesh_;
  LeafStage<AreaBound>& stage_;
  const LeafOrder& order_;
  LeafTasks<AreaBound>& leaves_;
  CoarseBlocks<AreaBound>* const blocks_;  // null: none
  Slots& root_;
  SlotFragments<AreaBound>& fragments_;
  LeafFragments<AreaBound> leaf_fragments_;
  bool cleaned_up_ = false;
  WorkTime time_;
  std::vector<char> settled_;   // per leaf
  std::vector<char> smoothed_;  // per leaf
  // How many leaves may be sent before the clean-up.
  std::atomic<std::uint32_t> final_leaves_;
};

}  // namespace weft
