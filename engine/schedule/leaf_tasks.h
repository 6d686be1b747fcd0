// SPDX-License-Identifier: GPL-3.0-or-later
// Refinement by leaves of the quadtree.
//
// A leaf's task owns the leaf's grown box (ownership.h) and refines the bad triangles whose
// centroids lie in the leaf. Tasks whose grown boxes overlap are in conflict and run one after the
// other, all others at the same time. The ORDER between two in conflict is fixed beforehand: by
// round, then by a greedy colouring of the conflicts in Morton order. So the mesh depends on the
// request alone, whatever the threads do.
//
// Rounds. In the first a task hands what it makes bad outside its leaf to the leaf there, and each
// leaf pulls what its neighbours have left for it, from those before it in the first round and from
// those after it in the second. From the second round on a task refines all that it owns. What no
// task could refine, because it reaches beyond the grown box, waits for the next round. About 11 %
// of the insertions are handed over, 0.5 % wait. A leaf with nothing left has no further rounds, so
// most end after the second.
//
// Thread-safety: `refine` may run at the same time for leaves that are not in conflict.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "engine/refine/refiner.h"
#include "engine/refine/slots.h"
#include "engine/schedule/quadtree.h"

namespace weft {

template <class AreaBound>
class LeafTasks {
 public:
  static constexpr std::uint32_t kRounds = 4;

  // Leaf l is owner l + 1 of slots; the clean-up is the owner after the last leaf.
  LeafTasks(const Setting& setting, const QualityBounds& quality, const AreaBound& area,
            const Quadtree& tree)
      : setting_(setting), quality_(quality), area_(area), tree_(tree) {
    auto conflicts = tree.conflicts();
    leaves_.resize(conflicts.size());
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
      leaves_[l].slots = Slots(l + 1);
      leaves_[l].conflicts = std::move(conflicts[l]);
    }
    colour();
    clean_up_slots_ = Slots(static_cast<std::uint32_t>(leaves_.size()) + 1);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(leaves_.size()); }
  const std::vector<std::uint32_t>& conflicts(std::uint32_t leaf) const {
    return leaves_[leaf].conflicts;
  }
  // Whether `leaf` comes before `other` within a round. REQUIRES: they are in conflict.
  bool before(std::uint32_t leaf, std::uint32_t other) const {
    return leaves_[leaf].colour < leaves_[other].colour;
  }
  const Slots& slots(std::uint32_t leaf) const { return leaves_[leaf].slots; }
  const Slots& clean_up_slots() const { return clean_up_slots_; }

  // A bad triangle of the prelude, for the leaf where its centroid lies.
  void seed(std::uint32_t triangle) {
    leaves_[tree_.leaf_at(centroid(triangle))].left.push_back(
        {triangle, setting_.mesh.triangles[triangle].vertex[0]});
  }

  // Whether a triangle's circumradius is below a quarter of the side of its leaf (leaf_radius.h).
  bool fits(std::uint32_t triangle) const {
    const Triangle& t = setting_.mesh.triangles[triangle];
    const Point a = setting_.mesh.vertices[t.vertex[0]];
    const Point b = setting_.mesh.vertices[t.vertex[1]];
    const Point c = setting_.mesh.vertices[t.vertex[2]];
    const double side = tree_.leaves()[tree_.leaf_at(centroid(triangle))].side();
    return circumradius2(a, b, c) <= side * side / 16;
  }

  std::optional<Error> refine(std::uint32_t leaf, std::uint32_t round) {
    Leaf& l = leaves_[leaf];
    if (!has_work(leaf, round)) return std::nullopt;
    rounds_[round].store(true, std::memory_order_relaxed);
    const Lease worker(*this);
    auto& refiner = worker->refiner;
    const Quadtree::Leaf& place = tree_.leaves()[leaf];
    refiner.begin(l.slots, OwnsBox{place.grown, round == 0 ? place.box : place.grown}, place.grown);
    for (const BadTriangle& t : l.left) refiner.queue(t);
    for_handed_to(leaf, round, [&](const BadTriangle& t) {
      refiner.queue(t);
      return true;
    });
    for (const auto& s : l.segments_left) refiner.queue_segment(s);
    auto error = refiner.run();
    l.left = refiner.deferred();
    l.segments_left = refiner.deferred_segments();
    deferred_.fetch_add(l.left.size() + l.segments_left.size(), std::memory_order_relaxed);
    for (const BadTriangle& t : refiner.handed_over()) hand_over(leaf, round, t);
    return error;
  }

  // Refines, with all of the mesh, what is left after the last round.
  std::optional<Error> clean_up() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr Box kEverywhere{-kInfinity, -kInfinity, kInfinity, kInfinity};
    const Lease worker(*this);
    auto& refiner = worker->refiner;
    refiner.begin(clean_up_slots_, OwnsBox{kEverywhere, kEverywhere}, tree_.box());
    for (const Leaf& l : leaves_) {
      for (const BadTriangle& t : l.left) refiner.queue(t);
      for (const auto& s : l.segments_left) refiner.queue_segment(s);
    }
    return refiner.run();
  }

  // Whether `leaf` has anything left for the rounds after the second.
  bool has_left(std::uint32_t leaf) const {
    return !leaves_[leaf].left.empty() || !leaves_[leaf].segments_left.empty();
  }

  // Bad triangles and encroached segments that wait for another round, or the clean-up.
  std::uint64_t left() const {
    std::uint64_t count = 0;
    for (const Leaf& l : leaves_) count += l.left.size() + l.segments_left.size();
    return count;
  }

  // Figures, once nothing runs.
  std::uint64_t deferred() const { return deferred_.load(); }
  std::uint32_t rounds() const {
    return static_cast<std::uint32_t>(std::count(rounds_.begin(), rounds_.end(), true));
  }
  std::uint64_t insertions() const {
    std::uint64_t count = 0;
    for (const auto& w : workers_) count += w->refiner.insertions();
    return count;
  }
  std::uint64_t exact_predicates() const {
    std::uint64_t count = 0;
    for (const auto& w : workers_) count += w->refiner.exact_predicates();
    return count;
  }
  std::uint64_t bytes() const {
    std::uint64_t bytes = leaves_.capacity() * sizeof(Leaf);
    for (const auto& w : workers_) bytes += w->refiner.bytes();
    for (const Leaf& l : leaves_) {
      bytes += l.slots.bytes() + l.conflicts.capacity() * sizeof(std::uint32_t) +
               l.left.capacity() * sizeof(BadTriangle) +
               l.handed_over.capacity() * sizeof(HandedOver);
    }
    return bytes;
  }

 private:
  struct HandedOver {
    std::uint32_t leaf;
    BadTriangle triangle;
  };

  using LeafRefiner = Refiner<OwnsBox, AreaBound>;

  struct Leaf {
    Slots slots;
    std::vector<std::uint32_t> conflicts;
    std::uint32_t colour = 0;
    std::vector<BadTriangle> left;
    std::vector<typename LeafRefiner::SegmentEdge> segments_left;
    std::vector<HandedOver> handed_over;  // in the first round
  };

  // The buffers of a thread at work.
  struct Worker {
    LeafRefiner refiner;
  };

  // Lends a worker for the time of a task.
  class Lease {
   public:
    explicit Lease(LeafTasks& tasks) : tasks_(tasks) {
      const std::lock_guard lock(tasks_.mutex_);
      if (tasks_.idle_.empty()) {
        tasks_.workers_.push_back(std::make_unique<Worker>(
            Worker{LeafRefiner(tasks_.setting_, tasks_.quality_, tasks_.area_.again())}));
        tasks_.idle_.push_back(tasks_.workers_.back().get());
      }
      worker_ = tasks_.idle_.back();
      tasks_.idle_.pop_back();
    }
    ~Lease() {
      const std::lock_guard lock(tasks_.mutex_);
      tasks_.idle_.push_back(worker_);
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Worker* operator->() const { return worker_; }

   private:
    LeafTasks& tasks_;
    Worker* worker_;
  };

  void colour() {
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
      std::vector<bool> used(leaves_[l].conflicts.size() + 1, false);
      for (const std::uint32_t other : leaves_[l].conflicts) {
        if (other < l && leaves_[other].colour < used.size()) used[leaves_[other].colour] = true;
      }
      const auto free = std::find(used.begin(), used.end(), false);
      leaves_[l].colour = static_cast<std::uint32_t>(free - used.begin());
    }
  }

  // Calls f for what neighbours have left for this leaf, as long as it returns true.
  template <class F>
  void for_handed_to(std::uint32_t leaf, std::uint32_t round, F&& f) const {
    if (round > 1) return;
    for (const std::uint32_t other : leaves_[leaf].conflicts) {
      if (before(other, leaf) != (round == 0)) continue;
      for (const HandedOver& h : leaves_[other].handed_over) {
        if (h.leaf == leaf && !f(h.triangle)) return;
      }
    }
  }

  bool has_work(std::uint32_t leaf, std::uint32_t round) const {
    bool any = has_left(leaf);
    for_handed_to(leaf, round, [&](const BadTriangle&) {
      any = true;
      return false;
    });
    return any;
  }

  void hand_over(std::uint32_t from, std::uint32_t round, const BadTriangle& bad) {
    const Triangle& t = setting_.mesh.triangles[bad.triangle];
    if (t.vertex[0] != bad.first_vertex || t.badness() == kGood) return;
    // Rounding may leave a centroid on the wrong side of a border: then it stays here.
    Leaf& l = leaves_[from];
    const std::uint32_t to = tree_.leaf_at(centroid(bad.triangle));
    if (round == 0 && std::binary_search(l.conflicts.begin(), l.conflicts.end(), to)) {
      l.handed_over.push_back({to, bad});
    } else {
      l.left.push_back(bad);
    }
  }

  Point centroid(std::uint32_t triangle) const {
    const Triangle& t = setting_.mesh.triangles[triangle];
    const Point a = setting_.mesh.vertices[t.vertex[0]];
    const Point b = setting_.mesh.vertices[t.vertex[1]];
    const Point c = setting_.mesh.vertices[t.vertex[2]];
    return {a.x + ((b.x - a.x) + (c.x - a.x)) * (1.0 / 3),
            a.y + ((b.y - a.y) + (c.y - a.y)) * (1.0 / 3)};
  }

  const Setting setting_;
  const QualityBounds quality_;
  const AreaBound area_;
  const Quadtree& tree_;
  std::vector<Leaf> leaves_;
  Slots clean_up_slots_;
  std::atomic<std::uint64_t> deferred_{0};
  std::array<std::atomic<bool>, kRounds> rounds_{};  // those that found work

  std::mutex mutex_;  // guards the two below while tasks run
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Worker*> idle_;
};

}  // namespace weft
