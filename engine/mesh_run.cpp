// SPDX-License-Identifier: Apache-2.0
#include "engine/mesh_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/delivery.h"
#include "engine/emit.h"
#include "engine/part_run.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/mapped_area.h"
#include "engine/refine/refiner.h"
#include "engine/refine/smoother.h"
#include "engine/schedule/leaf_graph.h"
#include "engine/schedule/leaf_tasks.h"
#include "engine/schedule/prelude.h"
#include "engine/schedule/quadtree.h"
#include "engine/schedule/task_graph.h"
#include "engine/schedule/trace.h"

namespace weft {
namespace {

using Clock = ExecutionContext::Clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Seconds that several threads add up.
class WorkTime {
 public:
  template <class F>
  auto measure(F&& f) {
    struct Stop {
      WorkTime& work;
      Clock::time_point start = Clock::now();
      ~Stop() { work.nanoseconds_.fetch_add((Clock::now() - start).count()); }
    } stop{*this};
    return f();
  }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  std::atomic<std::int64_t> nanoseconds_{0};
};

template <class AreaBound>
class MeshRun {
 public:
  MeshRun(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink, ExecutionContext& context,
          Summary& summary, Mesh& mesh, const AcuteCorners& corners, bool cut_off)
      : plan_(plan),
        area_(area),
        context_(context),
        summary_(summary),
        mesh_(mesh),
        corners_(corners),
        cut_off_(cut_off),
        setting_{mesh,
                 corners,
                 plan.domain.regions,
                 context,
                 plan.other_bytes + corners.bytes(),
                 cut_off ? context.budget().triangle_limit : limit(plan, context)},
        root_(Slots::of_domain(plan.domain)),
        delivery_(sink, context, summary),
        parts_(delivery_, context) {}

  // All before the leaves' tasks, or all refinement where there is one leaf. `start` is when the
  // work on the mesh began.
  std::optional<Error> prepare(Clock::time_point start) {
    context_.add_triangles(static_cast<std::int64_t>(plan_.domain.triangles.size()));
    context_.end_stage("mesh set-up");
    auto error = prelude();
    summary_.prelude_seconds = seconds_since(start);
    return error;
  }

  // The rest.
  std::optional<Error> run(Clock::time_point start) {
    if (auto error = leaves_ ? run_leaves() : run_alone()) return error;
    delivery_.finish();
    context_.end_stage("closing");
    summary_.engine_seconds = seconds_since(start) - parts_.blocked_seconds();
    summary_.refine_seconds += refine_time_.seconds();
    summary_.emit_seconds = emit_time_.seconds();
    if (leaves_) {
      for (const Quadtree::Leaf& leaf : tree_.leaves()) summary_.leaves.push_back(leaf.box);
      summary_.rounds = leaves_->rounds();
      add(leaves_->figures());
      summary_.deferred = leaves_->deferred();
    }
    summary_.peak_bytes = plan_.domain.bytes() + plan_.other_bytes + corners_.bytes() +
                          mesh_.bytes() + root_.bytes() + root_bytes_ + parts_.peak_bytes() +
                          (leaves_ ? leaves_->bytes() + order_.bytes() + tree_.bytes() : 0);
    return std::nullopt;
  }

 private:
  static constexpr std::uint64_t kNoCap = std::numeric_limits<std::uint64_t>::max();
  // From so many leaves on, parts leave while others are refined. A smaller mesh is done at once,
  // and keeps the right to a clean-up.
  static constexpr std::uint32_t kStreamingLeaves = 64;
  // Of the minimum angle's sine, squared: up to 30 degrees. Above, what the clean-up inserts breeds
  // skinny triangles far around, and with small leaves one domain in 270 would keep some, near what
  // has been sent (of 8,000 up to 30 degrees, none). There all is cleaned up before anything
  // leaves.
  static constexpr double kStreamingSin2 = 0.2501;

  static constexpr double kRefining = 0.65;  // of the work; the rest is building parts

  // Of triangles, in the first attempt: the client's wish stands in for the server's limit.
  static std::uint64_t limit(const MeshPlan& plan, const ExecutionContext& context) {
    return std::min(plan.max_triangles.value_or(kNoCap), context.budget().triangle_limit);
  }

  std::optional<Error> prelude() {
    if (!cut_off_ && plan_.wants_leaves()) {
      Prelude<AreaBound> prelude(setting_, plan_.quality, area_, plan_.narrow, plan_.leaf_triangles,
                                 root_);
      auto error = prelude.run(plan_.box);
      add(prelude.figures());
      if (error) return error;
      tree_ = prelude.take_tree();
      if (tree_.leaves().size() > 1) {
        order_ = prelude.take_order();
        leaves_.emplace(setting_, plan_.quality, area_, tree_, order_, prelude.bad_triangles());
        for (const Quadtree::Leaf& leaf : tree_.leaves()) total_weight_ += leaf.weight;
        streams_ = prelude.fits() && leaves_->size() >= kStreamingLeaves && !plan_.max_triangles &&
                   plan_.quality.sin2 <= kStreamingSin2;
        return std::nullopt;
      }
    }
    context_.count_triangles_as(kRefining);
    return refine_time_.measure([&] {
      Refiner<OwnsAll, AreaBound> refiner(setting_, plan_.quality, area_,
                                          cut_off_ ? *plan_.max_triangles : kNoCap);
      refiner.begin(root_, OwnsAll{}, plan_.box);
      auto error = refiner.queue_all();
      if (!error) error = refiner.run();
      add(refiner.figures());
      if (!error && plan_.sweeps > 0 && !cut_off_) error = smooth_alone();
      return error;
    });
  }

  std::optional<Error> smooth_alone() {
    Smoother<OwnsAll, AreaBound> smoother(setting_, plan_.quality, area_.again());
    smoother.begin(OwnsAll{}, plan_.box, static_cast<std::uint32_t>(plan_.domain.vertices.size()));
    return smoother.run(root_, plan_.sweeps);
  }

  void add(const RefinerFigures& figures) {
    summary_.insertions += figures.insertions;
    summary_.exact_predicates += figures.exact_predicates;
    root_bytes_ = std::max(root_bytes_, figures.bytes);
  }

  // A piece of an owner's slots.
  struct Section {
    std::uint32_t first;
    std::uint32_t last;
    bool vertices;  // not triangles
  };

  static void add_vertices(const Slots& slots, std::vector<Section>& sections) {
    slots.for_vertices([&](std::uint32_t first, std::uint32_t last) {
      sections.push_back({first, last, true});
    });
  }
  static void add_triangles(const Slots& slots, std::vector<Section>& sections) {
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      sections.push_back({first, last, false});
    });
  }
  static void build(PartBuilder<AreaBound>& builder, const Section& section) {
    if (section.vertices) {
      builder.add_vertices(section.first, section.last);
    } else {
      builder.add_triangles(section.first, section.last);
    }
  }

  // Builds the parts of what is final, so many sections each, and sends them.
  void send(const std::vector<Section>& sections) {
    constexpr std::size_t kPerPart = 48;  // about 10,000 vertices or triangles
    const auto parts = static_cast<std::uint32_t>((sections.size() + kPerPart - 1) / kPerPart);
    parts_.run(
        kClosingGraph, TaskGraph(parts), 0, parts, [](std::uint32_t part) { return part; },
        [&](std::uint32_t part) {
          parts_.finish(part, build_part([&](PartBuilder<AreaBound>& builder) {
                          const std::size_t end = std::min((part + 1) * kPerPart, sections.size());
                          std::size_t vertices = 0;
                          std::size_t triangles = 0;
                          for (std::size_t s = part * kPerPart; s < end; ++s)
                            (sections[s].vertices ? vertices : triangles) +=
                                sections[s].last - sections[s].first;
                          builder.expect(vertices, triangles);
                          for (std::size_t s = part * kPerPart; s < end; ++s)
                            build(builder, sections[s]);
                        }));
        });
  }

  // The mesh is refined already.
  std::optional<Error> run_alone() {
    root_.number_vertices(mesh_, 0);
    std::vector<Section> sections;
    add_vertices(root_, sections);
    add_triangles(root_, sections);
    send(sections);
    context_.add_fraction(1);
    return parts_.error();
  }

  static constexpr Trace::GraphName kClosingGraph{"closing parts", {"closing part"}};

  // Refines and sends at the same time up to the first leaf that is near something left over, then
  // cleans up, and sends the rest. Where nothing is left over, that is all.
  std::optional<Error> run_leaves() {
    const std::uint32_t n = leaves_->size();
    numbers_ = root_.number_vertices(mesh_, 0);
    handed_on_.resize(n);
    settled_.resize(n);
    smoothed_.resize(n);
    final_leaves_ = streams_ ? n : 0;
    if (streams_) send_opening();
    context_.end_stage("opening part");
    {
      TaskGraph graph(n * LeafGraph::kTasks);
      LeafGraph::add_refinement(order_, graph);
      if (streams_) LeafGraph::add_parts(order_, graph, plan_.sweeps > 0);
      parts_.run(LeafGraph::kName, std::move(graph), 0, final_leaves_, LeafGraph::part,
                 [this](std::uint32_t task) {
                   const std::uint32_t leaf = task / LeafGraph::kTasks;
                   const std::uint32_t step = task % LeafGraph::kTasks;
                   if (step < LeafGraph::kRounds) refine(leaf, step);
                   if (!streams_) return;  // nothing to settle yet
                   if (task == LeafGraph::settle(leaf)) settled_[leaf] = is_settled(leaf);
                   if (task == LeafGraph::smooth(leaf) && may_be_final(leaf)) smooth(leaf, 0);
                   if (task == LeafGraph::number(leaf) && !may_be_final(leaf))
                     final_leaves_ = std::min(final_leaves_.load(), leaf);
                   if (leaf < final_leaves_) send_leaf(task, leaf);
                 });
    }
    if (!parts_.stopped() && final_leaves_ < n) {
      if (leaves_->left() > 0) clean_up();
      if (!streams_ && !parts_.stopped()) send_opening();
      const std::uint32_t first = final_leaves_.exchange(n);
      TaskGraph graph(n * LeafGraph::kTasks);
      LeafGraph::add_parts(order_, graph, plan_.sweeps > 0);
      if (!parts_.stopped()) {
        parts_.run(LeafGraph::kName, std::move(graph), first, n, LeafGraph::part,
                   [this, first](std::uint32_t task) {
                     const std::uint32_t leaf = task / LeafGraph::kTasks;
                     if (leaf < first) return;
                     if (task == LeafGraph::smooth(leaf) && !smoothed_[leaf]) smooth(leaf, first);
                     send_leaf(task, leaf);
                   });
      }
    }
    if (!parts_.stopped()) send_closing();
    return parts_.error();
  }

  // What a leaf is of the work.
  double share_of(std::uint32_t leaf) const { return tree_.leaves()[leaf].weight / total_weight_; }

  void refine(std::uint32_t leaf, std::uint32_t round) {
    if (auto error = refine_time_.measure([&] { return leaves_->refine(leaf, round); }))
      parts_.stop(*error);
    if (round == 0) context_.add_fraction(kRefining * share_of(leaf));
    if (LeafGraph::may_be_handed(round + 1) || leaves_->has_left(leaf)) return;
    for (std::uint32_t later = LeafGraph::kRounds; --later > round;) {
      if (Trace* const trace = context_.trace())
        trace->skip(LeafGraph::round(leaf, later), LeafGraph::round(leaf, round));
      parts_.skip(LeafGraph::round(leaf, later));
    }
  }

  void smooth(std::uint32_t leaf, std::uint32_t frozen) {
    smoothed_[leaf] = true;
    if (plan_.sweeps == 0) return;
    if (auto error =
            refine_time_.measure([&] { return leaves_->smooth(leaf, plan_.sweeps, frozen); }))
      parts_.stop(*error);
  }

  bool is_settled(std::uint32_t leaf) const {
    const auto& conflicts = order_.conflicts(leaf);
    return !leaves_->has_left(leaf) &&
           std::none_of(conflicts.begin(), conflicts.end(),
                        [&](std::uint32_t other) { return leaves_->has_left(other); });
  }
  bool may_be_final(std::uint32_t leaf) const {
    const auto& conflicts = order_.conflicts(leaf);
    return settled_[leaf] && std::all_of(conflicts.begin(), conflicts.end(),
                                         [&](std::uint32_t other) { return settled_[other]; });
  }

  // Numbers the vertices of a final leaf, finds the triangles that go with other parts, or builds
  // its part.
  void send_leaf(std::uint32_t task, std::uint32_t leaf) {
    const Slots& slots = leaves_->slots(leaf);
    if (task == LeafGraph::number(leaf)) numbers_ = slots.number_vertices(mesh_, numbers_);
    if (task == LeafGraph::hand_on(leaf)) handed_on_[leaf] = triangles_handed_on(mesh_, slots);
    if (task != LeafGraph::part(leaf)) return;
    context_.add_fraction((1 - kRefining) * share_of(leaf));
    parts_.finish(
        leaf, build_part([&](PartBuilder<AreaBound>& builder) {
          builder.expect(slots.vertex_count(), slots.triangle_slots());
          slots.for_vertices(
              [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
          auto gone = handed_on_[leaf].cbegin();
          slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
            for (; gone != handed_on_[leaf].cend() && first <= gone->slot && gone->slot < last;
                 ++gone) {
              builder.add_triangles(first, gone->slot);
              first = gone->slot + 1;
            }
            builder.add_triangles(first, last);
          });
          for (const std::uint32_t other : order_.conflicts(leaf)) {
            if (other > leaf) break;
            for (const HandedOn& h : handed_on_[other]) {
              if (h.owner == slots.owner()) builder.add_triangle(h.triangle);
            }
          }
        }));
    leaves_->give_back_triangles(leaf);
  }

  void clean_up() {
    auto error = context_.compute(
        [&] { return refine_time_.measure([&] { return leaves_->clean_up(final_leaves_); }); });
    if (error) parts_.stop(*error);
    context_.end_stage("clean-up");
  }

  // Owner 0's vertices, which any leaf may refer to.
  void send_opening() {
    auto part = context_.compute([&] {
      return build_part([&](PartBuilder<AreaBound>& builder) {
        root_.for_vertices(
            [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
      });
    });
    const auto error = part ? delivery_.send(std::move(*part)) : context_.poll();
    if (error) parts_.stop(*error);
  }

  // What the clean-up has made, and those of owner 0's triangles that no leaf has touched.
  void send_closing() {
    const Slots& cleaned_up = leaves_->clean_up_slots();
    cleaned_up.number_vertices(mesh_, numbers_);
    std::vector<Section> sections;
    add_vertices(cleaned_up, sections);
    add_triangles(cleaned_up, sections);
    add_triangles(root_, sections);
    send(sections);
  }

  template <class F>
  std::optional<Part> build_part(F&& fill) {
    return emit_time_.measure([&] {
      PartBuilder<AreaBound> builder(mesh_, plan_.domain, corners_, area_.again(),
                                     plan_.quality.lattice.exists(), cut_off_, context_);
      fill(builder);
      return builder.finish();
    });
  }

  const MeshPlan& plan_;
  const AreaBound& area_;
  ExecutionContext& context_;
  Summary& summary_;
  Mesh& mesh_;
  const AcuteCorners& corners_;
  const bool cut_off_;
  const Setting setting_;
  Slots root_;
  Delivery delivery_;
  PartRun parts_;
  Quadtree tree_;
  LeafOrder order_;
  std::optional<LeafTasks<AreaBound>> leaves_;
  bool streams_ = false;
  double total_weight_ = 0;
  std::uint64_t root_bytes_ = 0;  // of owner 0's refiners
  WorkTime refine_time_;
  WorkTime emit_time_;

  std::uint32_t numbers_ = 0;                     // of vertices, given so far
  std::vector<std::vector<HandedOn>> handed_on_;  // per leaf
  std::vector<char> settled_;   // per leaf: it and its conflicts have nothing left
  std::vector<char> smoothed_;  // per leaf
  // How many leaves may be sent before the clean-up.
  std::atomic<std::uint32_t> final_leaves_ = 0;
};

}  // namespace

template <class AreaBound>
std::optional<Error> run_mesh(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink,
                              ExecutionContext& context, Summary& summary) {
  const auto attempt = [&](bool cut_off) -> std::optional<Error> {
    const auto start = Clock::now();
    std::optional<Mesh> mesh;
    std::optional<AcuteCorners> corners;
    std::optional<MeshRun<AreaBound>> run;
    const auto prepare = [&]() -> std::optional<Error> {
      auto mesh_made = Mesh::from(plan.domain, context.budget().triangle_limit,
                                  plan.expected_triangles, context);
      if (!mesh_made) return mesh_made.error();
      mesh.emplace(std::move(*mesh_made));
      auto corners_made = AcuteCorners::build(plan.domain, plan.quality, context);
      if (!corners_made) return corners_made.error();
      corners.emplace(std::move(*corners_made));
      run.emplace(plan, area, sink, context, summary, *mesh, *corners, cut_off);
      return run->prepare(start);
    };
    if (auto error = context.compute(prepare)) return error;
    return run->run(start);
  };
  const double cap = static_cast<double>(plan.max_triangles.value_or(0));
  if (plan.max_triangles && plan.least_triangles > cap) return attempt(true);
  const Summary before = summary;
  auto error = attempt(false);
  const bool reached = error && error->code == ErrorCode::kLimitExceeded && plan.max_triangles &&
                       *plan.max_triangles <= context.budget().triangle_limit;
  if (!reached) return error;
  summary = before;
  context.add_triangles(-static_cast<std::int64_t>(context.triangles()));
  return attempt(true);
}

template std::optional<Error> run_mesh(const MeshPlan&, const ConstantArea&, ChunkSink&,
                                       ExecutionContext&, Summary&);
template std::optional<Error> run_mesh(const MeshPlan&, const MappedArea&, ChunkSink&,
                                       ExecutionContext&, Summary&);

}  // namespace weft
