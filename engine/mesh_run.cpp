// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/mesh_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "engine/delivery.h"
#include "engine/emit.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/mapped_area.h"
#include "engine/refine/refiner.h"
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
                 plan.order,
                 plan.other_bytes + corners.bytes(),
                 cut_off ? context.budget().triangle_limit : limit(plan, context)},
        root_(Slots::of_domain(plan.domain)),
        delivery_(sink, context, summary) {}

  // `start` is when the work on the mesh began.
  std::optional<Error> run(Clock::time_point start) {
    context_.add_triangles(static_cast<std::int64_t>(plan_.domain.triangles.size()));
    context_.end_stage("mesh set-up");
    auto error = context_.compute([&] { return prelude(); });
    summary_.prelude_seconds = seconds_since(start);
    if (!error) error = leaves_ ? run_leaves() : run_alone();
    if (error) return error;
    delivery_.finish();
    context_.end_stage("closing");
    summary_.engine_seconds = seconds_since(start) - blocked_seconds_;
    summary_.refine_seconds += refine_time_.seconds();
    summary_.emit_seconds = emit_time_.seconds();
    if (leaves_) {
      for (const Quadtree::Leaf& leaf : tree_.leaves()) summary_.leaves.push_back(leaf.box);
      summary_.rounds = leaves_->rounds();
      add(leaves_->figures());
      summary_.deferred = leaves_->deferred();
    }
    summary_.peak_bytes = plan_.domain.bytes() + plan_.other_bytes + corners_.bytes() +
                          mesh_.bytes() + root_.bytes() + root_bytes_ + peak_part_bytes_ +
                          (leaves_ ? leaves_->bytes() + tree_.bytes() : 0);
    return std::nullopt;
  }

 private:
  static constexpr std::uint64_t kNoCap = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint32_t kRounds = LeafTasks<AreaBound>::kRounds;
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
    if (!cut_off_ && plan_.expected_triangles > plan_.leaf_triangles) {
      Prelude<AreaBound> prelude(setting_, plan_.quality, area_, plan_.leaf_triangles, root_);
      auto error = prelude.run(plan_.box);
      add(prelude.figures());
      if (error) return error;
      tree_ = prelude.take_tree();
      if (tree_.leaves().size() > 1) {
        leaves_.emplace(setting_, plan_.quality, area_, tree_, prelude.bad_triangles());
        context_.end_stage("conflicts");
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
      return error;
    });
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
    run_graph(
        kClosingGraph, TaskGraph(parts), 0, parts, [](std::uint32_t part) { return part; },
        [&](std::uint32_t part) {
          finish_part(part, build_part([&](PartBuilder<AreaBound>& builder) {
                        const std::size_t end = std::min((part + 1) * kPerPart, sections.size());
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
    return error_;
  }

  // Tasks of leaf l: kRounds rounds of refinement, whether that settled it, its numbers, what it
  // hands on, its part. By leaf, so that the first leaves are finished first.
  static constexpr std::uint32_t kTasks = kRounds + 4;
  static constexpr Trace::GraphName kLeafGraph{
      "leaves",
      {"round 1", "round 2", "round 3", "round 4", "settle", "number", "hand on", "part"}};
  static constexpr Trace::GraphName kClosingGraph{"closing parts", {"closing part"}};
  static std::uint32_t round_task(std::uint32_t leaf, std::uint32_t round) {
    return leaf * kTasks + round;
  }
  static std::uint32_t settle_task(std::uint32_t leaf) { return leaf * kTasks + kRounds; }
  static std::uint32_t number_task(std::uint32_t leaf) { return leaf * kTasks + kRounds + 1; }
  static std::uint32_t hand_on_task(std::uint32_t leaf) { return leaf * kTasks + kRounds + 2; }
  static std::uint32_t part_task(std::uint32_t leaf) { return leaf * kTasks + kRounds + 3; }

  void add_refinement(TaskGraph& graph) const {
    for (std::uint32_t l = 0; l < leaves_->size(); ++l) {
      for (std::uint32_t round = 0; round < kRounds; ++round) {
        if (round > 0) graph.add_dependency(round_task(l, round - 1), round_task(l, round));
        for (const std::uint32_t other : leaves_->conflicts(l)) {
          if (leaves_->before(other, l)) {
            graph.add_dependency(round_task(other, round), round_task(l, round));
          } else if (round > 0) {
            graph.add_dependency(round_task(other, round - 1), round_task(l, round));
          }
        }
      }
    }
  }

  // A leaf is final once all that own a part of its grown box are done, and none of them, nor of
  // their own conflicts, has left anything to the clean-up: that must have room to work.
  void add_parts(TaskGraph& graph) const {
    for (std::uint32_t l = 0; l < leaves_->size(); ++l) {
      graph.add_dependency(round_task(l, kRounds - 1), settle_task(l));
      graph.add_dependency(settle_task(l), number_task(l));
      if (l > 0) graph.add_dependency(number_task(l - 1), number_task(l));
      graph.add_dependency(number_task(l), hand_on_task(l));
      graph.add_dependency(hand_on_task(l), part_task(l));
      for (const std::uint32_t other : leaves_->conflicts(l)) {
        graph.add_dependency(round_task(other, kRounds - 1), settle_task(l));
        graph.add_dependency(settle_task(other), number_task(l));
        if (other < l) graph.add_dependency(hand_on_task(other), part_task(l));
      }
    }
  }

  // Refines and sends at the same time up to the first leaf that is near something left over, then
  // cleans up, and sends the rest. Where nothing is left over, that is all.
  std::optional<Error> run_leaves() {
    const std::uint32_t n = leaves_->size();
    numbers_ = root_.number_vertices(mesh_, 0);
    handed_on_.resize(n);
    settled_.resize(n);
    final_leaves_ = streams_ ? n : 0;
    if (streams_) send_opening();
    context_.end_stage("opening part");
    {
      TaskGraph graph(n * kTasks);
      add_refinement(graph);
      if (streams_) add_parts(graph);
      run_graph(kLeafGraph, std::move(graph), 0, final_leaves_, part_task,
                [this](std::uint32_t task) {
                  const std::uint32_t leaf = task / kTasks;
                  const std::uint32_t step = task % kTasks;
                  if (step < kRounds) refine(leaf, step);
                  if (!streams_) return;  // nothing to settle yet
                  if (task == settle_task(leaf)) settled_[leaf] = is_settled(leaf);
                  if (task == number_task(leaf) && !may_be_final(leaf))
                    final_leaves_ = std::min(final_leaves_.load(), leaf);
                  if (leaf < final_leaves_) send_leaf(task, leaf);
                });
    }
    if (!stopped_ && final_leaves_ < n) {
      if (leaves_->left() > 0) clean_up();
      if (!streams_ && !stopped_) send_opening();
      const std::uint32_t first = final_leaves_.exchange(n);
      TaskGraph graph(n * kTasks);
      add_parts(graph);
      if (!stopped_) {
        run_graph(kLeafGraph, std::move(graph), first, n, part_task,
                  [this, first](std::uint32_t task) {
                    if (task / kTasks >= first) send_leaf(task, task / kTasks);
                  });
      }
    }
    if (!stopped_) send_closing();
    return error_;
  }

  // What a leaf is of the work.
  double share_of(std::uint32_t leaf) const { return tree_.leaves()[leaf].weight / total_weight_; }

  void refine(std::uint32_t leaf, std::uint32_t round) {
    if (auto error = refine_time_.measure([&] { return leaves_->refine(leaf, round); }))
      stop(*error);
    if (round == 0) context_.add_fraction(kRefining * share_of(leaf));
    if (round == 0 || leaves_->has_left(leaf)) return;
    for (std::uint32_t later = kRounds; --later > round;) {
      if (Trace* const trace = context_.trace())
        trace->skip(round_task(leaf, later), round_task(leaf, round));
      run_->skip(round_task(leaf, later));
    }
  }

  bool is_settled(std::uint32_t leaf) const {
    const auto& conflicts = leaves_->conflicts(leaf);
    return !leaves_->has_left(leaf) &&
           std::none_of(conflicts.begin(), conflicts.end(),
                        [&](std::uint32_t other) { return leaves_->has_left(other); });
  }
  bool may_be_final(std::uint32_t leaf) const {
    const auto& conflicts = leaves_->conflicts(leaf);
    return settled_[leaf] && std::all_of(conflicts.begin(), conflicts.end(),
                                         [&](std::uint32_t other) { return settled_[other]; });
  }

  // Numbers the vertices of a final leaf, finds the triangles that go with other parts, or builds
  // its part.
  void send_leaf(std::uint32_t task, std::uint32_t leaf) {
    const Slots& slots = leaves_->slots(leaf);
    if (task == number_task(leaf)) numbers_ = slots.number_vertices(mesh_, numbers_);
    if (task == hand_on_task(leaf)) handed_on_[leaf] = triangles_handed_on(mesh_, slots);
    if (task != part_task(leaf)) return;
    context_.add_fraction((1 - kRefining) * share_of(leaf));
    finish_part(
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
          for (const std::uint32_t other : leaves_->conflicts(leaf)) {
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
    if (error) stop(*error);
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
    if (error) stop(*error);
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
      PartBuilder<AreaBound> builder(mesh_, plan_.domain, corners_, area_.again(), context_);
      fill(builder);
      return builder.finish();
    });
  }

  // Runs the tasks, and sends parts `first` to `last` - 1 in order as they are finished.
  template <class TaskOfPart, class Task>
  void run_graph(const Trace::GraphName& name, TaskGraph graph, std::uint32_t first,
                 std::uint32_t last, TaskOfPart task_of_part, Task task) {
    Trace* const trace = context_.trace();
    const std::uint32_t ahead = parts_ahead(context_.threads());
    for (std::uint32_t part = first + ahead; part < last; ++part) graph.hold(task_of_part(part));
    parts_ = std::vector<PendingPart>(last);
    GraphRun run(graph, context_.arena(), context_.threads(), [&](std::uint32_t t) {
      if (stopped_.load(std::memory_order_relaxed)) return;
      try {
        if (trace) {
          trace->time(t, [&] { task(t); });
        } else {
          task(t);
        }
      } catch (const std::bad_alloc&) {
        stop({ErrorCode::kBudgetExceeded, "", "memory ran out"});
      } catch (const std::exception& e) {
        stop({ErrorCode::kInternal, "", e.what()});
      }
    });
    run_ = &run;
    if (trace) {
      trace->end_stage("graph building");
      trace->begin_graph(name, graph);
      for (std::uint32_t part = first; part < last; ++part) trace->add_part(task_of_part(part));
    }
    run.start();
    std::atomic<std::uint32_t>& next = next_part_;
    next = first;
    const auto ready = [&] { return next < last && parts_[next].ready.load() && !stopped_; };
    do {
      for (; ready(); ++next) {
        if (next + ahead < last) run.release(task_of_part(next + ahead));
        const auto before = Clock::now();
        part_bytes_ -= parts_[next].part.bytes();
        if (auto error = delivery_.send(std::move(parts_[next].part))) stop(*error);
        parts_[next].part = {};
        const auto after = Clock::now();
        const auto idle_since = std::max(before, run.idle_since().value_or(after));
        blocked_seconds_ += std::chrono::duration<double>(after - idle_since).count();
      }
    } while (run.step() || ready());
    if (trace) trace->end_stage(name.stage);
    if (run.starved() && !stopped_)
      stop({ErrorCode::kBudgetExceeded, "", "memory ran out: no thread could be started"});
  }

  void finish_part(std::uint32_t index, std::optional<Part>&& part) {
    if (!part) {
      if (auto error = context_.poll()) stop(*error);
      return;
    }
    const std::uint64_t waiting = part_bytes_ += part->bytes();
    for (std::uint64_t peak = peak_part_bytes_; peak < waiting;) {
      if (peak_part_bytes_.compare_exchange_weak(peak, waiting)) break;
    }
    parts_[index].part = std::move(*part);
    parts_[index].ready.store(true);
    if (index == next_part_) run_->notify();  // later ones are found ready
  }

  void stop(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
    stopped_ = true;
  }

  struct PendingPart {
    std::atomic<bool> ready{false};
    Part part;
  };

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
  Quadtree tree_;
  std::optional<LeafTasks<AreaBound>> leaves_;
  bool streams_ = false;
  double total_weight_ = 0;
  double blocked_seconds_ = 0;    // in the sink, while there was nothing else to do
  std::uint64_t root_bytes_ = 0;  // of owner 0's refiners
  WorkTime refine_time_;
  WorkTime emit_time_;

  std::uint32_t numbers_ = 0;                     // of vertices, given so far
  std::vector<std::vector<HandedOn>> handed_on_;  // per leaf
  std::vector<char> settled_;  // per leaf: it and its conflicts have nothing left
  // How many leaves may be sent before the clean-up.
  std::atomic<std::uint32_t> final_leaves_ = 0;
  std::vector<PendingPart> parts_;
  std::atomic<std::uint32_t> next_part_{0};   // to be sent
  std::atomic<std::uint64_t> part_bytes_{0};  // of parts that wait to be sent
  std::atomic<std::uint64_t> peak_part_bytes_{0};
  GraphRun* run_ = nullptr;  // the one at work

  std::atomic<bool> stopped_{false};
  std::mutex mutex_;  // guards the one below
  std::optional<Error> error_;
};

}  // namespace

template <class AreaBound>
std::optional<Error> run_mesh(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink,
                              ExecutionContext& context, Summary& summary) {
  const auto attempt = [&](bool cut_off) -> std::optional<Error> {
    const auto start = Clock::now();
    auto mesh = context.compute([&] {
      return Mesh::from(plan.domain, context.budget().triangle_limit, plan.expected_triangles,
                        context);
    });
    if (!mesh) return mesh.error();
    auto corners = context.compute([&] { return AcuteCorners::build(plan.domain, context); });
    if (!corners) return corners.error();
    return MeshRun<AreaBound>(plan, area, sink, context, summary, *mesh, *corners, cut_off)
        .run(start);
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
