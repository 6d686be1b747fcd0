// SPDX-License-Identifier: Apache-2.0
// Refinement by leaves of the quadtree, one task at a time for each leaf (the paper's Section 2.4).
//
// A leaf's task owns the leaf's halo (refine/ownership.h) and refines the bad triangles whose
// centroids lie in the leaf. Two leaves overlap if their halos do: their tasks run one after the
// other, all others at the same time. The ORDER of two that overlap is fixed beforehand: by round,
// then by leaf_order.h. So the mesh depends on the request alone, whatever the threads do.
//
//   round 1, 2   Bad triangles that a task makes outside its leaf migrate to the leaf there, which
//                takes them in a fixed order: those of an overlapping leaf before it in the same
//                round, those of one after it in the next. Some 11 % of the insertions are for
//                these.
//   round 3, 4   A task refines all bad triangles that it owns. A leaf that has nothing pending and
//                receives nothing skips these.
//   clean-up     One task refines what is pending after the rounds, and makes periodic sides match.
//   It owns all that has not been
//                sent: all but the halos of the leaves before `frozen`.
//
// A triangle that a task cannot refine, because its cavity reaches beyond the halo, migrates to the
// leaf of its Steiner point, or is pending until the next round: 0.02 to 0.3 %, if a size makes the
// mesh or if two parallel segments do. The first round begins with rows of the lattice in what is
// clear of segments (refine/row_filler.h).
//
//   LeafTasks<ConstantArea> leaves(refinement, quality, area, tree, order, 1);
//   leaves.seed(bad);
//   ... leaves.refine(l, 0), ... in an order that LeafGraph permits ...
//   if (leaves.pending() > 0) leaves.clean_up(0, {}, root);
//
// Errors: those of refinement (refine/refiner.h). Thread-safety: of different leaves, `refine` and
// `smooth` may run at the same time if the leaves do not overlap, `seed` and giving back memory
// always; `clean_up` and the statistics only while no task runs.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/held_bytes.h"
#include "engine/parallel/leaf_graph.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/periodic_sides.h"
#include "engine/refine/refiner.h"
#include "engine/refine/row_filler.h"
#include "engine/refine/smoothing/equaliser.h"
#include "engine/refine/smoothing/smoother.h"
#include "engine/refine/smoothing/stages.h"
#include "engine/refine/storage/slots.h"

namespace weft {

// An owner before the leaves, whose vertices leave with a leaf's fragment: the first one that may
// need them.
struct EarlierOwner {
  std::uint32_t leaf;
  const Slots* slots;
};

// The clean-up's ownership: all but the halos of the frozen leaves, the first ones.
struct OwnsUnfrozen {
  static constexpr bool kRestricted = true;
  const Quadtree* tree = nullptr;
  // Per leaf, the frozen ones among itself and those that overlap it.
  const std::vector<std::vector<std::uint32_t>>* frozen = nullptr;
  bool owns(Point p) const {
    const auto& near = (*frozen)[tree->leaf_at(p)];
    return std::none_of(near.begin(), near.end(), [&](std::uint32_t l) {
      return OwnsBox::contains(tree->leaves()[l].halo, p.x, p.y);
    });
  }
  constexpr bool in_core(double, double) const { return true; }
  constexpr bool core_holds(Point, double) const { return true; }
};

// A leaf's ownership while it is smoothed: its halo without those of frozen leaves.
struct OwnsBoxUnfrozen {
  static constexpr bool kRestricted = true;
  Box box;
  // Halos that overlap `box`. The first ones are those of frozen leaves.
  const std::vector<Box>* others = nullptr;
  std::size_t frozen = 0;
  bool owns(Point p) const {
    return OwnsBox::contains(box, p.x, p.y) &&
           std::none_of(others->begin(), others->begin() + static_cast<std::ptrdiff_t>(frozen),
                        [&](const Box& b) { return OwnsBox::contains(b, p.x, p.y); });
  }
  // Whether an owned vertex may move from one point to another: not out of any halo. The vertices
  // that a leaf has made must lie in its halo, because the clean-up relies on that to avoid those
  // of frozen leaves.
  bool may_move(Point from, Point to) const {
    return owns(to) && std::none_of(others->begin(), others->end(), [&](const Box& b) {
             return OwnsBox::contains(b, from.x, from.y) && !OwnsBox::contains(b, to.x, to.y);
           });
  }
};

template <class AreaBound>
class LeafTasks {
 public:
  // Leaf l is owner `first_owner` + l of slots; the clean-up is the owner after the last leaf.
  // `in_stages`: the first round of a leaf refines in stages (refine/smoothing/stages.h).
  LeafTasks(const RefinementContext& refinement, const QualityBounds& quality,
            const AreaBound& area, const Quadtree& tree, const LeafOrder& order,
            std::uint32_t first_owner, bool in_stages)
      : refinement_(refinement),
        quality_(quality),
        area_(area),
        tree_(tree),
        order_(order),
        first_owner_(first_owner),
        in_stages_(in_stages),
        leaves_(order.size()) {
    for (std::uint32_t l = 0; l < size(); ++l) leaves_[l].slots = Slots(first_owner_ + l);
    clean_up_slots_ = Slots(first_owner_ + size());
  }

  // Gives a leaf, before its first round, the bad triangles to begin with: those whose centroids
  // lie in the leaf, in their order.
  void seed(std::uint32_t leaf, const std::vector<BadTriangle>& seeds) {
    gave(leaves_[leaf].bytes());
    leaves_[leaf].pending.insert(leaves_[leaf].pending.end(), seeds.begin(), seeds.end());
    took(leaves_[leaf].bytes());
  }
  // The same for all leaves.
  void seed(const std::vector<BadTriangle>& seeds) {
    for (const BadTriangle& t : seeds)
      leaves_[tree_.leaf_at(centroid_of(t.triangle))].pending.push_back(t);
    for (const Leaf& l : leaves_) took(l.bytes());
  }

  ~LeafTasks() { refinement_.context.held_bytes().remove(held_.now()); }
  LeafTasks(const LeafTasks&) = delete;
  LeafTasks& operator=(const LeafTasks&) = delete;

  std::uint32_t size() const { return static_cast<std::uint32_t>(leaves_.size()); }
  std::uint32_t first_owner() const { return first_owner_; }
  const Slots& slots(std::uint32_t leaf) const { return leaves_[leaf].slots; }
  // These give back a leaf's memory: all but the vertices, and the vertices. REQUIRES: it is no
  // longer read (leaf_release.h).
  void give_back_triangles(std::uint32_t leaf) {
    gave(leaves_[leaf].bytes());
    Slots slots = std::move(leaves_[leaf].slots);
    slots.give_back_triangles(refinement_.mesh);
    leaves_[leaf] = Leaf{.slots = std::move(slots)};
    took(leaves_[leaf].bytes());
  }
  void give_back_vertices(std::uint32_t leaf) {
    gave(leaves_[leaf].bytes());
    leaves_[leaf].slots.give_back_vertices(refinement_.mesh);
    took(leaves_[leaf].bytes());
  }
  const Slots& clean_up_slots() const { return clean_up_slots_; }

  std::optional<Error> refine(std::uint32_t leaf, std::uint32_t round) {
    Leaf& l = leaves_[leaf];
    if (!has_work(leaf, round)) return std::nullopt;
    const std::uint64_t before = l.bytes();
    rounds_[round].store(true, std::memory_order_relaxed);
    const Lease worker(*this);
    auto& refiner = worker->refiner;
    const Quadtree::Leaf& place = tree_.leaves()[leaf];
    const OwnsBox ownership{place.halo, LeafGraph::migrates(round) ? place.box : place.halo};
    refiner.begin(l.slots, ownership, place.halo);
    const bool in_stages = round == 0 && has_stages(place.halo);
    if constexpr (AreaBound::kBoundsAreas) {
      if (in_stages) refiner.set_stage(kFirstStage);
    }
    for (const BadTriangle& t : l.pending) refiner.queue(t);
    for (const SegmentEdge& s : l.pending_segments) refiner.queue(s);
    for_migrants_to(leaf, round, [&](const auto& what) {
      refiner.queue(what);
      return true;
    });
    if (round == 0) worker->filler.fill(refiner, l.slots, ownership, place.box, l.pending);
    std::optional<Error> error;
    if constexpr (AreaBound::kBoundsAreas) {
      error = in_stages ? refine_in_stages(*worker, leaf) : refiner.run();
    } else {
      error = refiner.run();
    }
    l.pending.clear();
    l.pending_segments.clear();
    for (const BadTriangle& t : refiner.deferred()) migrate(leaf, round, t, steiner_point_of(t));
    for (const SegmentEdge& s : refiner.deferred_segments()) migrate(leaf, round, s);
    for (const BadTriangle& t : refiner.migrants()) {
      if (refinement_.mesh.triangles[t.triangle].vertex[0] == t.first_vertex)
        migrate(leaf, round, t, centroid_of(t.triangle));
    }
    deferred_.fetch_add(refiner.deferred().size() + refiner.deferred_segments().size(),
                        std::memory_order_relaxed);
    gave(before);
    took(l.bytes());
    return error;
  }

  // Smooths a leaf in `sweeps` sweeps. REQUIRES: no other task refines in its halo, and the
  // overlapping leaves before it are smoothed or will not be. Does not change what the leaves
  // before `frozen` have made.
  std::optional<Error> smooth(std::uint32_t leaf, std::uint32_t sweeps, std::uint32_t frozen) {
    const Halos halos = halos_around(leaf, frozen);
    const Lease worker(*this);
    auto& smoother = worker->smoother;
    const Box& box = tree_.leaves()[leaf].halo;
    smoother.begin(OwnsBoxUnfrozen{box, &halos.boxes, halos.frozen}, box, 0, first_owner_);
    return smoother.run(leaves_[leaf].slots, sweeps);
  }

  // Refines triangles that are pending after the last round, without touching what the leaves
  // before `frozen` have made. Triangles too near to these stay as they are. Then makes sides
  // match; the other triangles are in `earlier`. REQUIRES: if there are such sides, none is frozen.
  std::optional<Error> clean_up(std::uint32_t frozen, const PeriodicSides& sides,
                                const Slots& earlier) {
    std::vector<std::vector<std::uint32_t>> frozen_near(leaves_.size());
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
      if (l < frozen) frozen_near[l].push_back(l);
      for (const std::uint32_t other : order_.overlapping(l)) {
        if (other < frozen) frozen_near[l].push_back(other);
      }
    }
    Refiner<OwnsUnfrozen, AreaBound> refiner(refinement_, quality_, area_.again());
    refiner.begin(clean_up_slots_, OwnsUnfrozen{&tree_, &frozen_near}, tree_.box());
    for (const Leaf& l : leaves_) {
      for (const BadTriangle& t : l.pending) refiner.queue(t);
      for (const SegmentEdge& s : l.pending_segments) refiner.queue(s);
    }
    auto error = refiner.run();
    std::vector<const Slots*> all{&earlier, &clean_up_slots_};
    for (const Leaf& l : leaves_) all.push_back(&l.slots);
    if (!error)
      error = sides.match(refiner, refinement_.mesh, refinement_.corners, all, refinement_.context);
    clean_up_stats_ = refiner.stats();
    return error;
  }

  // Whether `leaf` has anything pending.
  bool has_pending(std::uint32_t leaf) const {
    return !leaves_[leaf].pending.empty() || !leaves_[leaf].pending_segments.empty();
  }
  // Whether the leaf has anything to do in a round. REQUIRES: the tasks that the round waits for
  // are done.
  bool has_work(std::uint32_t leaf, std::uint32_t round) const {
    bool any = has_pending(leaf);
    for_migrants_to(leaf, round, [&](const auto&) {
      any = true;
      return false;
    });
    return any;
  }

  // Bad triangles and encroached segments that wait for another round, or the clean-up.
  std::uint64_t pending() const {
    std::uint64_t count = 0;
    for (const Leaf& l : leaves_) count += l.pending.size() + l.pending_segments.size();
    return count;
  }

  // Statistics. REQUIRES: no task runs.
  std::uint64_t deferred() const { return deferred_.load(); }
  std::uint32_t rounds() const {
    return static_cast<std::uint32_t>(std::count(rounds_.begin(), rounds_.end(), true));
  }
  RefinerStats stats() const {
    RefinerStats sum = clean_up_stats_;
    for (const auto& w : workers_) sum += w->refiner.stats();
    return sum;
  }
  // Bytes at the peak.
  std::uint64_t bytes() const {
    std::uint64_t bytes = leaves_.capacity() * sizeof(Leaf) + held_.peak();
    for (const auto& w : workers_)
      bytes += w->refiner.bytes() + w->filler.bytes() + w->equaliser.bytes() + w->smoother.bytes();
    return bytes;
  }

 private:
  using LeafRefiner = Refiner<OwnsBox, AreaBound>;

  void took(std::uint64_t bytes) {
    held_.add(bytes);
    refinement_.context.held_bytes().add(bytes);
  }
  void gave(std::uint64_t bytes) {
    held_.remove(bytes);
    refinement_.context.held_bytes().remove(bytes);
  }

  template <class What>
  struct Migrant {
    std::uint32_t leaf;
    std::uint32_t round;  // of the task from which it migrates
    What what;
  };

  struct Leaf {
    Slots slots = {};
    std::vector<BadTriangle> pending = {};
    std::vector<SegmentEdge> pending_segments = {};
    std::vector<Migrant<BadTriangle>> migrants = {};
    std::vector<Migrant<SegmentEdge>> migrant_segments = {};
    std::uint64_t bytes() const {
      return slots.bytes() + pending.capacity() * sizeof(pending[0]) +
             pending_segments.capacity() * sizeof(pending_segments[0]) +
             migrants.capacity() * sizeof(migrants[0]) +
             migrant_segments.capacity() * sizeof(migrant_segments[0]);
    }
  };

  // The buffers of a running task, in cache lines that no other thread writes.
  struct alignas(128) Worker {
    LeafRefiner refiner;
    RowFiller<AreaBound> filler;
    Equaliser<OwnsBoxUnfrozen, AreaBound> equaliser;
    Smoother<OwnsBoxUnfrozen, AreaBound> smoother;
    std::thread::id last_user{};
  };

  // Lends a worker for the time of a task: each thread gets the one that it had last, whose buffers
  // are in its cache. A worker whose task threw is not lent again: its buffers may be incomplete.
  class Lease {
   public:
    explicit Lease(LeafTasks& tasks) : tasks_(tasks) {
      const std::lock_guard lock(tasks_.mutex_);
      if (tasks_.idle_.empty()) {
        tasks_.workers_.push_back(std::unique_ptr<Worker>(
            new Worker{{tasks_.refinement_, tasks_.quality_, tasks_.area_.again()},
                       {tasks_.refinement_, tasks_.quality_, tasks_.area_},
                       {tasks_.refinement_, tasks_.quality_, tasks_.area_.again()},
                       {tasks_.refinement_, tasks_.quality_, tasks_.area_.again()}}));
        tasks_.idle_.reserve(tasks_.workers_.size());  // so that giving back cannot fail
        tasks_.idle_.push_back(tasks_.workers_.back().get());
      }
      const auto self = std::this_thread::get_id();
      auto& idle = tasks_.idle_;
      auto chosen = std::find_if(idle.begin(), idle.end(),
                                 [&](const Worker* w) { return w->last_user == self; });
      if (chosen == idle.end()) --chosen;
      worker_ = *chosen;
      idle.erase(chosen);
      worker_->last_user = self;
    }
    ~Lease() {
      if (std::uncaught_exceptions() > exceptions_) return;
      const std::lock_guard lock(tasks_.mutex_);
      tasks_.idle_.push_back(worker_);
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Worker* operator->() const { return worker_; }
    Worker& operator*() const { return *worker_; }

   private:
    LeafTasks& tasks_;
    const int exceptions_ = std::uncaught_exceptions();
    Worker* worker_;
  };

  // The halos that overlap that of a leaf. The first ones are those of leaves before `frozen`.
  struct Halos {
    std::vector<Box> boxes;
    std::size_t frozen;
  };
  Halos halos_around(std::uint32_t leaf, std::uint32_t frozen) const {
    Halos halos{{}, 0};
    for (const std::uint32_t other : order_.overlapping(leaf)) {
      halos.boxes.push_back(tree_.leaves()[other].halo);
      if (other < frozen) std::swap(halos.boxes.back(), halos.boxes[halos.frozen++]);
    }
    return halos;
  }

  bool has_stages(const Box& box) const {
    if constexpr (AreaBound::kBoundsAreas)
      return in_stages_ && area_.has_slack_in(box, quality_.lattice);
    return false;
  }
  std::optional<Error> refine_in_stages(Worker& worker, std::uint32_t leaf) {
    const Halos halos = halos_around(leaf, 0);
    const Box& box = tree_.leaves()[leaf].halo;
    worker.equaliser.begin(OwnsBoxUnfrozen{box, &halos.boxes, 0}, box, 0, first_owner_);
    return weft::refine_in_stages(worker.refiner, worker.equaliser, leaves_[leaf].slots);
  }

  // Calls f for the triangles that migrate to this leaf from those that overlap it, as long as f
  // returns true.
  template <class F>
  void for_migrants_to(std::uint32_t leaf, std::uint32_t round, F&& f) const {
    if (round > LeafGraph::kMigrationRounds) return;
    for (const std::uint32_t other : order_.overlapping(leaf)) {
      // A triangle is due in the first task of this leaf after the task from which it migrates.
      const auto is_due = [&](const auto& h) {
        if (h.leaf != leaf) return false;
        return round ==
               (order_.before(other, leaf, LeafOrder::phase_of(h.round)) ? h.round : h.round + 1);
      };
      for (const auto& h : leaves_[other].migrants) {
        if (is_due(h) && !f(h.what)) return;
      }
      for (const auto& h : leaves_[other].migrant_segments) {
        if (is_due(h) && !f(h.what)) return;
      }
    }
  }

  // Lets a triangle migrate to the leaf that contains its next vertex, whose task owns the
  // surroundings.
  void migrate(std::uint32_t from, std::uint32_t round, const BadTriangle& bad, Point next) {
    Leaf& l = leaves_[from];
    const std::uint32_t to = tree_.leaf_at(next);
    if (may_migrate(from, round, to) && may_look_at(to, bad.triangle)) {
      l.migrants.push_back({to, round, bad});
    } else {
      l.pending.push_back(bad);
    }
  }
  void migrate(std::uint32_t from, std::uint32_t round, const SegmentEdge& s) {
    Leaf& l = leaves_[from];
    const Point a = refinement_.mesh.vertices[s.a];
    const Point b = refinement_.mesh.vertices[s.b];
    const std::uint32_t to = tree_.leaf_at({a.x + 0.5 * (b.x - a.x), a.y + 0.5 * (b.y - a.y)});
    if (may_migrate(from, round, to) && may_look_at(to, s.triangle)) {
      l.migrant_segments.push_back({to, round, s});
    } else {
      l.pending_segments.push_back(s);
    }
  }
  bool may_migrate(std::uint32_t from, std::uint32_t round, std::uint32_t to) const {
    return LeafGraph::migrates(round) && order_.overlap(from, to);
  }

  // Whether a leaf's task may read the vertices in a slot at any time: those of earlier owners are
  // never written, and those of a leaf only by its task.
  bool may_look_at(std::uint32_t leaf, std::uint32_t slot) const {
    const std::uint32_t owner = refinement_.mesh.owner_of_triangle(slot);
    return owner < first_owner_ || owner == first_owner_ + leaf ||
           order_.overlap(leaf, owner - first_owner_);
  }

  Point steiner_point_of(const BadTriangle& bad) const {
    const Triangle& t = refinement_.mesh.triangles[bad.triangle];
    return steiner_point(refinement_.mesh.vertices[t.vertex[0]],
                         refinement_.mesh.vertices[t.vertex[1]],
                         refinement_.mesh.vertices[t.vertex[2]], quality_);
  }
  Point centroid_of(std::uint32_t triangle) const {
    const Triangle& t = refinement_.mesh.triangles[triangle];
    return centroid(refinement_.mesh.vertices[t.vertex[0]], refinement_.mesh.vertices[t.vertex[1]],
                    refinement_.mesh.vertices[t.vertex[2]]);
  }

  const RefinementContext refinement_;
  const QualityBounds quality_;
  const AreaBound area_;
  const Quadtree& tree_;
  const LeafOrder& order_;
  const std::uint32_t first_owner_;
  const bool in_stages_;
  std::vector<Leaf> leaves_;
  Slots clean_up_slots_;
  HeldBytes held_;  // by the vectors of the leaves
  std::atomic<std::uint64_t> deferred_{0};
  RefinerStats clean_up_stats_;
  std::array<std::atomic<bool>, LeafGraph::kRounds> rounds_{};  // whether each found work

  std::mutex mutex_;  // guards the two below while tasks run
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Worker*> idle_;
};

}  // namespace weft
