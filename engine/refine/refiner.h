// SPDX-License-Identifier: Apache-2.0
// Delaunay refinement of a region of the mesh (the paper's Section 2; J. Ruppert 1995,
// J. R. Shewchuk 2002).
//
//   while there is a bad triangle t: too large, or with an angle below the bound   `run`, `refine`
//     p := the Steiner point of t (steiner_point.h, petal_search.h)                `insert_for`
//     grow the cavity of p: the triangles whose open circumdisk contains p         `grow`
//     if p encroaches upon a segment:       split that instead (lens.h), then try t again
//     if the cavity meets another task's:   defer t, the mesh stays as it was (ownership.h)
//     if the star would have an edge that
//     is too short, or a flat triangle:     refuse t, which stays as it is
//     else:                                 replace the cavity by the star of p, and queue the bad
//                                           triangles of the star                  `retriangulate`
//
//          e-------d                   e-------d
//         /|\      |\                 / \     / \      Left: the cavity of p, four triangles, and
//        / | \  t  | \               /   \   /   \     its ring a b c d e f (cavity.h).
//       /  |  \    |  \             /     \ /     \    Right: the star of p (star.h), a triangle
//      f   |   \ p |   c    ->     f-------p-------c   for each edge of the ring: two more than
//       \  |    \  |  /             \     / \     /    there were.
//        \ |     \ | /               \   /   \   /
//         \|      \|/                 \ /     \ /
//          a-------b                   a-------b
//
// No point location is needed: t belongs to the cavity of its own Steiner point. The cavity's slots
// are used again. The worst triangle comes first, last in first out among equals (bad_triangles.h).
//
//   Refiner<OwnsAll, ConstantArea> refiner(refinement, quality, ConstantArea(1e-3));
//   refiner.begin(slots, OwnsAll{}, box);
//   if (auto error = refiner.queue_all()) return error;   // the bad triangles
//   if (auto error = refiner.run()) return error;         // then all are refined or refused
//
// Tasks. Ownership is a compile-time parameter. Bad triangles that a task cannot refine are in
// `deferred()`, those that it makes outside its core in `migrants()`. A task names a triangle of
// another one by its slot and first vertex: only the slot's owner writes vertices, and the first
// one differs each time. So a task may check whether a triangle still exists before it knows that
// it owns it; it reads the flags after that. One Refiner serves many tasks, one after the other.
//
// Units: coordinates of the domain; bounds on areas are in their square. Errors: kCancelled,
// kDeadlineExceeded, kLimitExceeded (triangles), kBudgetExceeded (bytes), that of a source of
// memory that grants no more, kBadSizeValue; throws what MeshStore does. Thread-safety: one thread
// at a time; refiners of tasks that own disjoint vertices run at the same time on one mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/area_batch.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/bad_triangles.h"
#include "engine/refine/cavity.h"
#include "engine/refine/lens.h"
#include "engine/refine/ownership.h"
#include "engine/refine/petal.h"
#include "engine/refine/petal_search.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/refinement_stage.h"
#include "engine/refine/star.h"
#include "engine/refine/star_check.h"
#include "engine/refine/steiner_point.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/triangle_judge.h"

namespace weft {

template <class Ownership, class AreaBound>
class Refiner {
 public:
  // Stops once the mesh has `max_triangles`. REQUIRES: if there is such a limit, no other task
  // refines.
  Refiner(const RefinementContext& refinement, const QualityBounds& quality, AreaBound area,
          std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max())
      : mesh_(refinement.mesh),
        corners_(refinement.corners),
        regions_(refinement.regions),
        edge_limits_(refinement.edge_limits),
        strict_(quality),
        quality_(quality),
        area_(std::move(area)),
        context_(refinement.context),
        held_(refinement.context.held_bytes(), 0),
        other_bytes_(refinement.other_bytes),
        triangle_limit_(refinement.triangle_limit),
        poll_interval_(area_.poll_interval()),
        max_triangles_(max_triangles),
        star_(refinement.mesh),
        petal_search_(refinement.mesh),
        bad_(refinement.mesh) {}

  // Begins a task in `box`: new triangles and vertices go to `slots`.
  void begin(Slots& slots, const Ownership& ownership, const Box& box) {
    slots_ = &slots;
    area_.begin(box);
    quality_ = strict_;
    ownership_ = ownership;
    star_.begin(ownership, slots.owner());
    petal_search_.begin(ownership, slots.owner());
    bad_.clear();
    segments_.clear();
    deferred_.clear();
    deferred_segments_.clear();
    migrants_.clear();
  }

  // Queues a triangle that is pending from another task, if it still exists; defers it if it is not
  // owned.
  void queue(const BadTriangle& pending) {
    const Triangle& t = mesh_.triangles[pending.triangle];
    if (t.vertex[0] != pending.first_vertex) return;
    if (!owns(t)) {
      deferred_.push_back(pending);
    } else if (t.badness() != kGood) {
      mesh_.triangles[pending.triangle].set_deferred(false);
      bad_.push(pending.triangle, t.badness());
    }
  }
  void queue(const SegmentEdge& pending) { segments_.push_back(pending); }

  // From now on, the bounds are those of a stage (smoothing/stages.h).
  void set_stage(const RefinementStage& stage) {
    area_.set_slack(stage.slack);
    quality_ = stage.eased ? strict_.eased() : strict_;
  }
  // The same for one with less slack than the last: queues the triangles that are bad now, of this
  // task's slots and of `others`.
  void begin_stage(const RefinementStage& stage, const std::vector<std::uint32_t>& others) {
    const double before = quality_.sin2;
    set_stage(stage);
    const bool angles_hold = quality_.sin2 <= before;
    for_all_triangles([&](std::uint32_t t) { judge_again(t, angles_hold); });
    for (const std::uint32_t t : others) judge_again(t, angles_hold);
    judge_batch();
  }

  // Judges every triangle and queues the bad ones; splits segments down to the limits of their
  // markers. REQUIRES: all triangles lie in the slots of this task.
  std::optional<Error> queue_all() {
    for_all_triangles([&](std::uint32_t t) { judge(t); });
    split_long_segments();
    return stopped_;
  }

  enum class Placing {
    kPlaced,
    kAgain,  // not yet: segments were split for it, so t may not exist any more
    kRefused,
  };
  // Makes a point a vertex, if it keeps `clearance2`, squared, from all that it is joined to.
  // REQUIRES: it lies in triangle t, which this task owns, and is not a vertex.
  Placing place(std::uint32_t t, Point p, double clearance2) {
    tick();
    const Outcome outcome = insert_in_triangle(t, p, clearance2);
    if (outcome == Outcome::kInserted) return Placing::kPlaced;
    if (outcome != Outcome::kEncroaches) return Placing::kRefused;
    queue_encroached();
    return split_queued_segments() ? Placing::kAgain : Placing::kRefused;
  }
  // A triangle of the star of the point that was placed last, which is its first vertex.
  std::uint32_t placed() const { return star_.cavity().triangles()[0]; }

  // From now on, only `split` splits segments with these markers.
  void keep(std::vector<std::int32_t> markers) { kept_ = std::move(markers); }

  // Splits an edge on a straight segment at a point of it. Returns false if it no longer exists, or
  // if that cannot be. REQUIRES: this task owns all triangles around.
  bool split(const SegmentEdge& s, Point p) {
    tick();
    return is_current(s) && split_segment_near(s.triangle, s.edge, p, false) == Outcome::kInserted;
  }

  // Counts what somebody else has inserted in this task's slots.
  void count(std::uint64_t vertices, std::int64_t triangles) {
    insertions_ += vertices;
    added_ += triangles;
  }

  bool stopped() const { return stopped_.has_value(); }

  // The loop: refines until no triangle is queued, `max_triangles` are reached, or the context
  // stops it.
  std::optional<Error> run() {
    split_queued_segments();
    while (!full() && !stopped_) {
      const std::uint32_t t = bad_.pop();
      if (t == kNone) break;
      refine(t);
      tick();
    }
    if (!stopped_) stopped_ = poll();
    return stopped_;
  }

  // Whether there is no room for another insertion: queued triangles then stay bad.
  bool full() const {
    return max_triangles_ != std::numeric_limits<std::uint64_t>::max() &&
           context_.triangles() + static_cast<std::uint64_t>(added_) + kMaxGrowth > max_triangles_;
  }

  const std::vector<BadTriangle>& deferred() const { return deferred_; }
  const std::vector<SegmentEdge>& deferred_segments() const { return deferred_segments_; }
  // Some of these may no longer exist.
  const std::vector<BadTriangle>& migrants() const { return migrants_; }

  RefinerStats stats() const {
    return {insertions_, star_.exact_predicates() + petal_search_.exact_predicates() + exact_,
            bytes()};
  }
  std::uint64_t bytes() const {
    return star_.bytes() + petal_search_.bytes() + bad_.bytes() +
           segments_.capacity() * sizeof(segments_[0]) +
           deferred_.capacity() * sizeof(deferred_[0]);
  }

 private:
  using Growth = typename Star<Ownership>::Growth;

  static constexpr std::uint32_t kMaxGrowth = 2;  // triangles that an insertion adds
  static constexpr int kNudges = 4;     // of a point that splits a segment, to either side
  static constexpr int kMaxHidden = 8;  // arcs in a row, each of which hides the last

  enum class Outcome {
    kInserted,
    kEncroaches,  // star_.cavity().encroached() must be split first
    kNotOwned,
    kTooClose,  // an edge would be too short for the floor or for double precision
    kFlat,      // a triangle would not be counter-clockwise, or not Delaunay
    kKept,      // the segment stays as it is
  };

  void refine(std::uint32_t t) {
    Triangle& triangle = mesh_.triangles[t];
    if (Ownership::kRestricted && triangle.deferred()) [[unlikely]]
      return;
    if (triangle.badness() == kSkinny && corners_.exempts(mesh_, triangle)) {
      triangle.set_refusal(Refusal::kSmallInputAngle);
      return;
    }
    switch (insert_for(t)) {
      [[likely]] case Outcome::kInserted : return;
      case Outcome::kEncroaches:
        split_encroached(t);
        return;
      case Outcome::kNotOwned:
        defer(t);
        return;
      case Outcome::kTooClose:
      case Outcome::kFlat:
        triangle.set_refusal(refusal());
        return;
      case Outcome::kKept:  // of segments alone
        return;
    }
  }

  // Inserts t's Steiner point (steiner_point.h).
  Outcome insert_for(std::uint32_t t) {
    const Triangle& triangle = mesh_.triangles[t];
    const Point a = mesh_.vertices[triangle.vertex[0]];
    const Point b = mesh_.vertices[triangle.vertex[1]];
    const Point c = mesh_.vertices[triangle.vertex[2]];
    if (triangle.badness() == kSkinny) return insert_for_skinny(t, a, b, c);
    if (!quality_.lattice.exists())
      return insert_in_triangle(t, steiner_point(a, b, c, quality_), 0);
    const Point centre = steiner_point(a, b, c, 0.0);
    const LatticePoint nearest =
        area_.nearest_of_lattice(centre, region_bound(t), quality_.lattice);
    if (takes_lattice_point(a, b, c, centre, nearest)) [[likely]] {
      const Outcome outcome =
          insert_in_triangle(t, nearest.at, kLatticeClearance2 * nearest.spacing2);
      if (outcome != Outcome::kTooClose) [[likely]]
        return outcome;
    }
    return insert_in_triangle(t, centre, 0);
  }

  // Inserts a point at the best place in the petal of t = a, b, c (petal_search.h).
  Outcome insert_for_skinny(std::uint32_t t, Point a, Point b, Point c) {
    const Point standard = steiner_point(a, b, c, quality_);
    const Outcome outcome = grow(star_, t, standard);
    if (outcome != Outcome::kInserted) return outcome;
    const RingVerdict verdict = judge_star(star_, t, standard);
    if (!acceptable(verdict, standard)) return Outcome::kTooClose;
    const auto look_at = [&](Star<Ownership>& star, Point p) -> std::optional<RingVerdict> {
      if (grow(star, t, p) != Outcome::kInserted) return std::nullopt;
      return judge_star(star, t, p);
    };
    const auto best =
        petal_search_.run(star_, Petal(a, b, c, quality_), {standard, verdict}, quality_, look_at);
    retriangulate(slots_->add_vertex(mesh_, best.at), best.at, best.verdict.farthest2, true);
    return Outcome::kInserted;
  }

  // Why the star of a point was refused, by the edges that it would have had.
  [[gnu::noinline]] Refusal refusal() const {
    const auto& points = star_.ring().points;
    const auto end = points.begin() + star_.ring().size + 1;  // of an open ring, the last end
    const auto nearest = std::min_element(
        points.begin(), end,
        [](const RingPoint& a, const RingPoint& b) { return a.length2 < b.length2; });
    return nearest->length2 < quality_.min_edge2 ? Refusal::kEdgeFloor : Refusal::kPrecision;
  }

  // Splits the segments that t's Steiner point encroaches upon, and queues t again if it still
  // exists. If none can be split, t stays as it is, unless there is a place beside those that are
  // kept.
  void split_encroached(std::uint32_t t) {
    const std::uint32_t first_vertex = mesh_.triangles[t].vertex[0];
    queue_encroached();
    const bool split = split_queued_segments();
    Triangle& after = mesh_.triangles[t];
    if (after.badness() == kGood || after.vertex[0] != first_vertex) return;
    if (split || full()) {
      bad_.push(t, after.badness());
    } else if (segments_deferred_) {
      defer(t);
    } else {
      const Refusal why = segments_refused_;
      const Outcome outcome = why == Refusal::kKept ? insert_near_kept(t) : Outcome::kKept;
      if (outcome == Outcome::kNotOwned) defer(t);
      if (outcome != Outcome::kNotOwned && outcome != Outcome::kInserted) after.set_refusal(why);
    }
  }

  // Inserts a point for t, whose Steiner point encroaches upon nothing but segments that are kept:
  // that point, if it leaves the angles at these segments large enough, or else one in the middle
  // of a t that is too large.
  [[gnu::noinline]] Outcome insert_near_kept(std::uint32_t t) {
    near_kept_ = true;
    Outcome outcome = insert_for(t);
    if (AreaBound::kBoundsAreas && outcome == Outcome::kEncroaches &&
        mesh_.triangles[t].badness() != kSkinny) {
      const auto [p, clearance2] = middle_beside_segments(mesh_, mesh_.triangles[t]);
      outcome = insert_in_triangle(t, p, clearance2);
    }
    near_kept_ = false;
    return outcome;
  }

  // `clearance2` is the least admissible squared distance from p to the vertices of its star.
  Outcome insert_in_triangle(std::uint32_t t, Point p, double clearance2) {
    const Outcome outcome = grow(star_, t, p);
    if (outcome != Outcome::kInserted) return outcome;
    const RingVerdict verdict = judge_star(star_, t, p);
    if (verdict.nearest2 < clearance2 || !acceptable(verdict, p)) [[unlikely]]
      return Outcome::kTooClose;
    retriangulate(slots_->add_vertex(mesh_, p), p, verdict.farthest2, true);
    return Outcome::kInserted;
  }

  // Grows the star of a point for triangle t. Returns kInserted if the cavity is complete.
  Outcome grow(Star<Ownership>& star, std::uint32_t t, Point p) {
    // That of a flat triangle may be nowhere, and before the lens is narrow it encroaches.
    if (near_kept_ && !(std::max(std::fabs(p.x), std::fabs(p.y)) <= kMaxMagnitude)) [[unlikely]]
      return Outcome::kEncroaches;
    const Growth growth = star.grow_from_triangle(t, p, lens_of(t));
    return growth == Growth::kComplete     ? Outcome::kInserted
           : growth == Growth::kEncroaches ? Outcome::kEncroaches
                                           : Outcome::kNotOwned;
  }
  RingVerdict judge_star(Star<Ownership>& star, std::uint32_t t, Point p) {
    const Ring& ring = star.ring();
    return area_.judge(ring, 0, ring.size, p, region_bound(t), quality_, star.judged());
  }

  // The lens of the Steiner points of triangle t (lens.h).
  double lens_of(std::uint32_t t) const {
    if (near_kept_) [[unlikely]]  // no vertex may lie between an arc and its chord
      return corners_.has_arcs() ? kDiametralDisk : quality_.kept_lens;
    return mesh_.triangles[t].badness() == kSkinny ? quality_.lens : kDiametralDisk;
  }

  std::uint32_t apex_of(HalfEdge h) const {
    return mesh_.triangles[triangle_of(h)].vertex[edge_of(h)];
  }

  // Splits edge `edge` of triangle t, which lies on a segment. The next piece of the same segment
  // may be in line with the edge except for rounding; if the point is then on the wrong side of
  // that line, a triangle would be flat. So the point is moved by a few units in the last place.
  // `hidden` arcs wait for this one.
  Outcome split_segment(std::uint32_t t, std::uint32_t edge, int hidden = 0) {
    const Triangle& triangle = mesh_.triangles[t];
    const std::uint32_t a = triangle.vertex[kNext[edge]];
    const std::uint32_t b = triangle.vertex[kPrevious[edge]];
    if ((edge_limits_.keep_any() || !kept_.empty()) && is_kept(corners_.marker(mesh_, a, b)))
        [[unlikely]]
      return Outcome::kKept;
    const HalfEdge across = triangle.neighbor[edge];
    const double pieces = pieces_of(a, b);
    const Point p = corners_.split_point(
        mesh_, {a, b}, {triangle.vertex[edge], across != kNone ? apex_of(across) : kNone},
        pieces > 1 ? std::ceil(pieces / 2) / pieces : 0.5);
    const bool is_arc =
        corners_.has_arcs() && corners_.curvature(corners_.subsegment(mesh_, a, b)) != 0;
    return split_segment_near(t, edge, p, is_arc, hidden);
  }

  // Splits it at p, or at a point nearby if a triangle would be flat.
  Outcome split_segment_near(std::uint32_t t, std::uint32_t edge, Point p, bool is_arc,
                             int hidden = 0) {
    Outcome outcome = is_arc ? split_arc_at(t, edge, p, hidden) : split_segment_at(t, edge, p);
    if (outcome != Outcome::kFlat) [[likely]]
      return outcome;
    const Triangle& triangle = mesh_.triangles[t];
    const std::uint32_t a = triangle.vertex[kNext[edge]];
    const std::uint32_t b = triangle.vertex[kPrevious[edge]];
    const double x = mesh_.vertices[b].x - mesh_.vertices[a].x;
    const double y = mesh_.vertices[b].y - mesh_.vertices[a].y;
    const double unit =
        0x1p-52 * std::max(std::fabs(p.x), std::fabs(p.y)) / std::sqrt(x * x + y * y);
    for (int k = 1; k <= kNudges && outcome == Outcome::kFlat; ++k) {
      for (const double side : {k * unit, -k * unit}) {
        const Point nudged{p.x - side * y, p.y + side * x};
        outcome = is_arc ? try_arc_at(t, edge, nudged) : split_segment_at(t, edge, nudged);
        if (outcome != Outcome::kFlat) break;
      }
    }
    return outcome;
  }

  // The same for an arc, whose point lies off its chord. The triangle on the far side of the chord
  // stays if its circumdisk does not hold the point; else all is as for a straight segment.
  //
  // Where arcs touch, the chord of another one may hide the point from this one: then that one is
  // split instead. At the limit of double precision, two may hide each other.
  [[gnu::noinline]] Outcome split_arc_at(std::uint32_t t, std::uint32_t edge, Point p, int hidden) {
    const Outcome outcome = try_arc_at(t, edge, p);
    if (outcome != Outcome::kFlat || hidden == kMaxHidden) return outcome;
    const auto hiding = hiding_edge(mesh_, star_.cavity(), star_.ring(), quality_.precision2);
    return hiding ? split_segment(triangle_of(*hiding), edge_of(*hiding), hidden + 1) : outcome;
  }

  Outcome try_arc_at(std::uint32_t t, std::uint32_t edge, Point p) {
    const Triangle& triangle = mesh_.triangles[t];
    const HalfEdge across = triangle.neighbor[edge];
    if (!ownership_.owns(p)) return Outcome::kNotOwned;
    ++exact_;
    const double side = orientation_exact(mesh_.vertices[triangle.vertex[kNext[edge]]],
                                          mesh_.vertices[triangle.vertex[kPrevious[edge]]], p);
    if (side == 0) return split_segment_at(t, edge, p);
    if (side > 0)
      return across == kNone || holds(triangle_of(across), p)
                 ? split_segment_at(t, edge, p)
                 : split_segment_at(t, edge, p, star_.grow_from_segment(t, edge, p, true), across);
    const HalfEdge far = half_edge(t, edge);
    if (across == kNone)
      return holds(t, p) ? split_segment_at(t, edge, p)
                         : split_segment_at(t, edge, p, star_.grow_beyond(t, edge, p), far);
    const std::uint32_t u = triangle_of(across);
    const std::uint32_t j = edge_of(across);
    if (!owns(mesh_.triangles[u])) return Outcome::kNotOwned;
    return holds(t, p) ? split_segment_at(u, j, p)
                       : split_segment_at(u, j, p, star_.grow_from_segment(u, j, p, true), far);
  }

  // Whether p lies in the open circumdisk of triangle t.
  bool holds(std::uint32_t t, Point p) {
    ++exact_;
    const auto& v = mesh_.triangles[t].vertex;
    return in_circle_exact(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]], p);
  }

  Outcome split_segment_at(std::uint32_t t, std::uint32_t edge, Point p) {
    return split_segment_at(t, edge, p, star_.grow_from_segment(t, edge, p));
  }

  // `staying` is the edge as a triangle sees it that stays beside the new point, and loses its
  // segment; kNone if there is none. REQUIRES: the star of p was grown from edge `edge` of t.
  Outcome split_segment_at(std::uint32_t t, std::uint32_t edge, Point p, Growth growth,
                           HalfEdge staying = kNone) {
    if (growth == Growth::kNotOwned) return Outcome::kNotOwned;
    const Triangle& triangle = mesh_.triangles[t];
    const std::uint32_t a = triangle.vertex[kNext[edge]];
    const std::uint32_t b = triangle.vertex[kPrevious[edge]];
    const HalfEdge across = triangle.neighbor[edge];
    const bool closed = across != kNone;
    const Ring& ring = star_.ring();
    if (too_thin(mesh_, half_edge(t, edge), quality_.precision2) ||
        (closed && too_thin(mesh_, across, quality_.precision2)))
      return Outcome::kTooClose;
    const std::uint32_t subsegment = corners_.subsegment(mesh_, a, b);
    if (corners_.curvature(subsegment) != 0 &&
        hiding_edge(mesh_, star_.cavity(), ring, quality_.precision2)) [[unlikely]]
      return Outcome::kFlat;
    if (!corners_.needles().keep_apart(subsegment, p)) return Outcome::kTooClose;
    const std::uint32_t near_side = closed ? star_.cavity().far_end() : ring.size;
    RingVerdict verdict = judge_side(0, near_side, p, region_bound(t));
    if (closed) {
      const RingVerdict far =
          judge_side(near_side, ring.size, p, region_bound(triangle_of(across)));
      verdict.flat |= far.flat;
      verdict.too_close |= far.too_close;
      verdict.farthest2 = std::max(verdict.farthest2, far.farthest2);
    }
    if (!acceptable(verdict, p)) return verdict.too_close ? Outcome::kTooClose : Outcome::kFlat;
    if (!star_is_delaunay(mesh_, ring, 0, near_side, p) ||
        (closed && !star_is_delaunay(mesh_, ring, near_side, ring.size, p))) [[unlikely]]
      return Outcome::kFlat;

    const std::uint32_t near_region = triangle.region;
    const std::uint32_t far_region = closed ? mesh_.triangles[triangle_of(across)].region : 0;
    retriangulate(slots_->add_segment_vertex(mesh_, p, subsegment), p, verdict.farthest2, closed);
    star_.mark_segment(mesh_, near_side, closed, near_region, far_region);
    if (staying != kNone) [[unlikely]]
      mesh_.triangles[triangle_of(staying)].flags &= ~(1u << edge_of(staying));
    return Outcome::kInserted;
  }

  // The triangles of the star on one side of a segment: one alone, if there is an arc's chord.
  RingVerdict judge_side(std::uint32_t first, std::uint32_t last, Point p, double bound) {
    const Ring& ring = star_.ring();
    if (last - first > 1) [[likely]]
      return area_.judge(ring, first, last, p, bound, quality_, star_.judged());
    return judge_(ring.points[first], ring.points[last], p, bound, quality_, area_,
                  star_.judged()[first]);
  }

  // Replaces the cavity by the star of its point p, now a vertex. `farthest2` is the squared
  // distance to the farthest point of the ring.
  void retriangulate(std::uint32_t vertex, Point p, double farthest2, bool closed) {
    ++insertions_;
    if (ownership_.core_holds(p, farthest2)) [[likely]] {
      added_ += star_.make(
          mesh_, *slots_, vertex, closed,
          [this](std::uint32_t t, Badness badness, std::uint32_t) { bad_.push(t, badness); });
    } else {
      added_ += star_.make(mesh_, *slots_, vertex, closed,
                           [&](std::uint32_t t, Badness badness, std::uint32_t edge) {
                             queue_or_migrate(t, badness, vertex, p, edge);
                           });
    }
  }

  // Queues a bad triangle of the star of p, at an edge of the ring, or lets it migrate if it lies
  // outside the core.
  void queue_or_migrate(std::uint32_t t, Badness badness, std::uint32_t vertex, Point p,
                        std::uint32_t edge) {
    const RingPoint& a = star_.ring().points[edge];
    const RingPoint& b = star_.ring().points[edge + 1];
    if (ownership_.in_core(p.x + (a.x + b.x) * (1.0 / 3), p.y + (a.y + b.y) * (1.0 / 3))) {
      bad_.push(t, badness);
    } else {
      migrants_.push_back({t, vertex});
    }
  }

  // Queues the segments that the star's point encroaches upon.
  void queue_encroached() {
    segments_.insert(segments_.end(), star_.cavity().encroached().begin(),
                     star_.cavity().encroached().end());
  }

  // Splits the queued segments. Returns whether any was split.
  bool split_queued_segments() {
    bool any = false;
    segments_deferred_ = false;
    segments_refused_ = Refusal::kNone;
    while (!segments_.empty() && !full() && !stopped_) {
      tick();
      const SegmentEdge s = segments_.back();
      segments_.pop_back();
      if (!ownership_.owns(mesh_.vertices[s.a]) || !ownership_.owns(mesh_.vertices[s.b])) {
        defer_segment(s);
        continue;
      }
      if (!is_current(s)) {
        any = true;
        continue;
      }
      const Outcome outcome = split_segment(s.triangle, s.edge);
      any |= outcome == Outcome::kInserted;
      if (outcome == Outcome::kNotOwned) defer_segment(s);
      if (outcome == Outcome::kTooClose || outcome == Outcome::kFlat)
        segments_refused_ = std::max(segments_refused_, refusal());
      if (outcome == Outcome::kKept)
        segments_refused_ = std::max(segments_refused_, Refusal::kKept);
    }
    return any;
  }

  bool is_kept(std::int32_t marker) const {
    return edge_limits_.keep(marker) ||
           std::find(kept_.begin(), kept_.end(), marker) != kept_.end();
  }

  bool is_current(const SegmentEdge& s) const {
    const Triangle& t = mesh_.triangles[s.triangle];
    return t.vertex[kNext[s.edge]] == s.a && t.vertex[kPrevious[s.edge]] == s.b &&
           t.on_segment(s.edge);
  }

  // The parts that the limit of its marker asks of the edge a-b, which lies on a segment.
  double pieces_of(std::uint32_t a, std::uint32_t b) const {
    if (edge_limits_.empty()) [[likely]]
      return 1;
    return edge_limits_.pieces(corners_.marker(mesh_, a, b), mesh_.vertices[a], mesh_.vertices[b]);
  }

  // Splits segments that are longer than the limit of their marker, as often as is needed; those
  // that cannot be split stay.
  void split_long_segments() {
    if (edge_limits_.empty()) return;
    bool split = true;
    while (split && !stopped_) {
      for_all_triangles([&](std::uint32_t t) {
        const Triangle& triangle = mesh_.triangles[t];
        if (triangle.dead()) return;
        for (std::uint32_t edge = 0; edge < 3; ++edge) {
          const std::uint32_t a = triangle.vertex[kNext[edge]];
          const std::uint32_t b = triangle.vertex[kPrevious[edge]];
          if (triangle.on_segment(edge) && pieces_of(a, b) > 1)
            segments_.push_back({t, edge, a, b});
        }
      });
      split = split_queued_segments();
    }
  }

  // Whether the star of p may be made. Flat triangles arise only at the limit of double precision.
  bool acceptable(const RingVerdict& verdict, Point p) {
    if (verdict.too_close) [[unlikely]]
      return false;
    if (!verdict.flat) [[likely]]
      return true;
    if (near_kept_) return false;
    exact_ += star_.ring().size;
    return star_turns_left(mesh_, star_.ring(), p);
  }

  // Judges a triangle that was not made by an insertion here, and queues it if it is bad.
  void judge(std::uint32_t t) {
    const Badness badness = judge_(mesh_, t, region_bound(t), quality_, area_);
    mesh_.triangles[t].set_badness(badness);
    if (badness != kGood) bad_.push(t, badness);
  }

  // Judges a triangle that was good, or refused, before vertices moved and bounds changed. Bad ones
  // are pending elsewhere. `angles_hold`: the bound on angles is not above what it was.
  void judge_again(std::uint32_t t, bool angles_hold) {
    const Triangle& triangle = mesh_.triangles[t];
    if (triangle.dead() || triangle.deferred()) return;
    if (triangle.badness() != kGood) return;
    if (!angles_hold || triangle.refusal() != Refusal::kNone) return judge_or_migrate(t);
    if (batch_.add(mesh_, t)) judge_batch();
  }
  // Those within the bound are good: moves keep the bound on angles.
  void judge_batch() {
    batch_.take(area_, [this](std::uint32_t t, double doubled, double bound) {
      const auto& v = mesh_.triangles[t].vertex;
      if (!(doubled <= 2 * std::min(bound, region_bound(t))) ||
          area_.covers_finer(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]],
                             0.5 * doubled))
        judge_or_migrate(t);
    });
  }
  void judge_or_migrate(std::uint32_t t) {
    const auto& v = mesh_.triangles[t].vertex;
    const Point at = centroid(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]);
    if (ownership_.in_core(at.x, at.y)) return judge(t);
    const Badness badness = judge_(mesh_, t, region_bound(t), quality_, area_);
    mesh_.triangles[t].set_badness(badness);
    if (badness != kGood) migrants_.push_back({t, mesh_.triangles[t].vertex[0]});
  }

  template <class F>
  void for_all_triangles(F&& f) {
    slots_->for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last && !stopped_; ++t) {
        f(t);
        tick();
      }
    });
  }

  void defer(std::uint32_t t) {
    mesh_.triangles[t].set_deferred(true);
    deferred_.push_back({t, mesh_.triangles[t].vertex[0]});
  }
  void defer_segment(const SegmentEdge& s) {
    deferred_segments_.push_back(s);
    segments_deferred_ = true;
  }

  bool owns(const Triangle& t) const {
    return ownership_.owns(mesh_.vertices[t.vertex[0]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[1]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[2]]);
  }

  double region_bound(std::uint32_t t) const {
    return regions_[mesh_.triangles[t].region].max_area;
  }

  void tick() {
    if (--until_poll_ != 0) [[likely]]
      return;
    until_poll_ = poll_interval_;
    stopped_ = poll();
  }

  std::optional<Error> poll() {
    const std::uint64_t triangles = context_.add_triangles(std::exchange(added_, 0));
    if (const auto& bad = area_.bad_size()) return bad_size_error(*bad);
    held_.grow_to(bytes());  // its vectors never shrink
    const std::uint64_t held = mesh_.bytes() + context_.held_bytes().now() + other_bytes_;
    if (auto error = check_budget(context_, triangles, triangle_limit_, held)) return error;
    return context_.poll();
  }

  MeshStore& mesh_;
  const AcuteCorners& corners_;
  const std::vector<Region>& regions_;
  const EdgeLimits& edge_limits_;
  const QualityBounds strict_;
  QualityBounds quality_;  // of this stage
  AreaBound area_;
  ExecutionContext& context_;
  HeldBytes::Scope held_;
  const std::uint64_t other_bytes_;  // held by the run all the time
  const std::uint64_t triangle_limit_;
  const std::uint32_t poll_interval_;  // insertions
  const std::uint64_t max_triangles_;
  Slots* slots_ = nullptr;
  Ownership ownership_{};
  Star<Ownership> star_;
  PetalSearch<Ownership> petal_search_;
  TriangleJudge judge_;
  AreaBatch batch_;

  BadTriangles bad_;
  std::vector<std::int32_t> kept_;     // markers, besides those of edge_limits_
  std::vector<SegmentEdge> segments_;  // encroached upon; entries may be stale
  std::vector<BadTriangle> deferred_;
  std::vector<SegmentEdge> deferred_segments_;
  std::vector<BadTriangle> migrants_;
  bool near_kept_ = false;  // whether Steiner points may be as near to segments as angles permit
  bool segments_deferred_ = false;
  // Why segments of the last call of split_queued_segments were not split; precision takes
  // precedence over what the caller asked for.
  Refusal segments_refused_ = Refusal::kNone;
  std::optional<Error> stopped_;
  std::uint32_t until_poll_ = 1;
  std::int64_t added_ = 0;  // triangles that are not reported to the context yet
  std::uint64_t insertions_ = 0;
  std::uint64_t exact_ = 0;
};

}  // namespace weft
