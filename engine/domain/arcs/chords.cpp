// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/chords.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"
#include "engine/domain/arcs/arc_meeting.h"
#include "engine/domain/arcs/flat_arcs.h"
#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/arrangement/merging.h"
#include "engine/domain/tolerance.h"

namespace weft {
namespace {

using TreePoint = boost::geometry::model::d2::point_xy<double>;
using TreeBox = boost::geometry::model::box<TreePoint>;
template <class Shape>
using Tree = boost::geometry::index::rtree<std::pair<Shape, std::uint32_t>,
                                           boost::geometry::index::quadratic<16>>;

TreeBox box_around(const ArcPiece& piece, double margin) {
  Box box;
  box.add(piece.from);
  box.add(piece.to);
  margin += 0.5 * std::fabs(piece.bulge) * length(piece.to - piece.from);
  return {{box.min_x - margin, box.min_y - margin}, {box.max_x + margin, box.max_y + margin}};
}

// No coordinate of an arc is larger.
double extent_of(Point a, Point b, double bulge) {
  return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)}) +
         length(b - a) * std::max(1.0, std::fabs(bulge));
}

double least_tolerance_of(const Pslg& pslg) {
  double largest = largest_coordinate(pslg.points);
  for (const Arc& arc : pslg.arcs) {
    const Segment& s = pslg.segments[arc.segment];
    largest = std::max(largest, extent_of(pslg.points[s.a], pslg.points[s.b], arc.bulge));
  }
  return kMergeFraction * largest;
}

// Per point, the first one that is at the same place.
std::vector<std::uint32_t> first_of_equal(const std::vector<Point>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Point p = points[i], q = points[j];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : i < j;
  });
  std::vector<std::uint32_t> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] =
        k > 0 && points[order[k]] == points[order[k - 1]] ? first[order[k - 1]] : order[k];
  return first;
}

class ArcCutter {
 public:
  ArcCutter(const Pslg& pslg, double max_turn, StopPoller& poller)
      : pslg_(pslg),
        max_turn_(max_turn),
        poller_(poller),
        least_tolerance_(least_tolerance_of(pslg)),
        tolerance_(std::max(pslg.snap, least_tolerance_)) {}

  Chords run() {
    Merging merging{.tolerance = tolerance_};
    points_ = merge_points(pslg_.points, merging, poller_);
    first_ = first_of_equal(points_);
    add_segments();
    settle_all();
    cut_to_turns();
    settle_all();
    return result();
  }

 private:
  // A list of the segments that a piece is part of.
  struct Owner {
    std::uint32_t segment;
    std::uint32_t next;
  };

  static constexpr std::uint64_t kBytesPerPiece = 350;  // with its place in the tree

  void settle_all() {
    while (!queue_.empty()) {
      std::vector<std::uint32_t> round;
      std::swap(round, queue_);
      for (const std::uint32_t piece : round) {
        poller_.step();
        if (exists_[piece]) settle(piece);
      }
    }
  }

  // Afterwards hulls count. Before, arcs are cut where they meet others, and nowhere else.
  void cut_to_turns() {
    hulls_count_ = true;
    const auto count = static_cast<std::uint32_t>(pieces_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      poller_.step();
      if (!exists_[i] || pieces_[i].bulge == 0) continue;
      const ArcPiece p = pieces_[i];
      remove(i);
      add_equal_turns(p.a, p.b, p.bulge, owners_of_[i]);
    }
  }

  void add_segments() {
    bulges_ = bulges_of(pslg_);
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      if (first_[i] == i) corners_.insert({{points_[i].x, points_[i].y}, i});
    for (const Point p : pslg_.holes) seeds_.insert({{p.x, p.y}, 0});
    for (const RegionSeed& region : pslg_.regions) seeds_.insert({{region.at.x, region.at.y}, 0});
    for (std::uint32_t s = 0; s < pslg_.segments.size(); ++s) {
      poller_.step();
      const auto [a, b] = ends_of(s);
      if (bulges_[s] == 0) add(a, b, 0, owner(s, kNone));
    }
    for (std::uint32_t s = 0; s < pslg_.segments.size(); ++s)
      if (bulges_[s] != 0) add_arc(s);
  }

  std::array<std::uint32_t, 2> ends_of(std::uint32_t segment) const {
    return {first_[pslg_.segments[segment].a], first_[pslg_.segments[segment].b]};
  }
  std::uint32_t owner(std::uint32_t segment, std::uint32_t next) {
    owners_.push_back({segment, next});
    return static_cast<std::uint32_t>(owners_.size() - 1);
  }

  bool is_owner(std::uint32_t owners, std::uint32_t segment) const {
    while (owners != kNone && owners_[owners].segment != segment) owners = owners_[owners].next;
    return owners != kNone;
  }

  // An arc of more than 180 degrees is halved as it was before its ends were merged: they may be
  // one vertex now, and its middle need not be.
  void add_arc(std::uint32_t segment) {
    const auto [a, b] = ends_of(segment);
    const double bulge = bulges_[segment];
    const std::uint32_t owners = owner(segment, kNone);
    if (std::fabs(bulge) <= 1) return add(a, b, bulge, owners);
    const std::uint32_t middle = vertex_at(middle_of_arc(
        pslg_.points[pslg_.segments[segment].a], pslg_.points[pslg_.segments[segment].b], bulge));
    add(a, middle, half_bulge(bulge), owners);
    add(middle, b, half_bulge(bulge), owners);
  }

  void add_equal_turns(std::uint32_t a, std::uint32_t b, double bulge, std::uint32_t owners) {
    const double turn = turn_of(std::fabs(bulge));
    const double count = std::max(1.0, std::ceil(turn / max_turn_ * (1 - 1e-9)));
    const auto [cosine, sine] = cosine_and_sine(turn / (4 * count));
    const double part = count == 1 ? bulge : std::copysign(sine / cosine, bulge);
    std::uint32_t from = a;
    for (double i = 1; i <= count; ++i) {
      poller_.step();
      const std::uint32_t to =
          i == count ? b : vertex_at(at_fraction(points_[a], points_[b], bulge, i / count));
      add(from, to, part, owners);
      from = to;
    }
  }

  // The vertex nearest to a point, if it is within the tolerance, or else a new one.
  std::uint32_t vertex_at(Point p) {
    std::vector<std::pair<TreePoint, std::uint32_t>> near;
    corners_.query(boost::geometry::index::nearest(TreePoint(p.x, p.y), 1),
                   std::back_inserter(near));
    if (!near.empty() && length(points_[near[0].second] - p) < tolerance_) return near[0].second;
    points_.push_back(p);
    const auto vertex = static_cast<std::uint32_t>(points_.size() - 1);
    corners_.insert({{p.x, p.y}, vertex});
    return vertex;
  }

  void add(std::uint32_t a, std::uint32_t b, double bulge, std::uint32_t owners) {
    if (a == b) return;
    if (pieces_.size() >= kMaxSplits)
      throw Stopped{{ErrorCode::kLimitExceeded, "domain.arcs",
                     "the arcs have more than " + std::to_string(kMaxSplits) + " pieces"}};
    const auto piece = static_cast<std::uint32_t>(pieces_.size());
    if (std::has_single_bit(pieces_.size())) poller_.require(2 * kBytesPerPiece * pieces_.size());
    pieces_.push_back(ArcPiece(a, b, points_[a], points_[b], bulge));
    owners_of_.push_back(owners);
    exists_.push_back(1);
    tree_.insert({box_around(pieces_.back(), 0), piece});
    if (bulge != 0) queue_.push_back(piece);
  }

  void remove(std::uint32_t piece) {
    tree_.remove({box_around(pieces_[piece], 0), piece});
    exists_[piece] = 0;
  }

  void cut(std::uint32_t piece, std::uint32_t vertex) {
    remove(piece);
    const ArcPiece p = pieces_[piece];
    const Point at = points_[vertex];
    if (p.bulge == 0) {
      for (const auto& [a, b] : {std::pair(p.a, vertex), {vertex, p.b}}) {
        if (a != b) queue_.push_back(static_cast<std::uint32_t>(pieces_.size()));  // it may be bent
        add(a, b, 0, owners_of_[piece]);
      }
      return;
    }
    add(p.a, vertex, bulge_from_tangent(tangent_at_start(p.from, p.to, p.bulge), at - p.from),
        owners_of_[piece]);
    add(vertex, p.b, -bulge_from_tangent(-tangent_at_end(p.from, p.to, p.bulge), at - p.to),
        owners_of_[piece]);
  }

  // Cuts the piece at a vertex that it passes, unless what it is part of has been led through that:
  // of two vertices nearly across an arc, either could bring it back to the other for ever.
  bool lead(std::uint32_t piece, std::uint32_t vertex) {
    for (std::uint32_t o = owners_of_[piece]; o != kNone; o = owners_[o].next)
      if (led_.contains({owners_[o].segment, vertex})) return false;
    for (std::uint32_t o = owners_of_[piece]; o != kNone; o = owners_[o].next)
      led_.emplace(owners_[o].segment, vertex);
    cut(piece, vertex);
    return true;
  }

  // What keeps the piece from being halved further is named.
  void halve(std::uint32_t piece, std::uint32_t other) {
    const ArcPiece& p = pieces_[piece];
    constexpr double kShortest = 16;  // tolerances
    if (length(p.to - p.from) < kShortest * tolerance_) throw_too_near(piece, other, p.from);
    cut(piece, vertex_at(middle_of_arc(p.from, p.to, p.bulge)));
  }

  [[noreturn]] void throw_too_near(std::uint32_t piece, std::uint32_t other, Point at) const {
    const std::uint32_t segment = owners_[owners_of_[piece]].segment;
    const std::string place = "(" + std::to_string(at.x) + ", " + std::to_string(at.y) + ")";
    const std::string neighbour =
        other == kNone ? "a seed or another vertex"
                       : "segment " + std::to_string(owners_[owners_of_[other]].segment);
    throw Stopped{{ErrorCode::kBadOption, "domain.segments[" + std::to_string(segment) + "]",
                   "the arc of segment " + std::to_string(segment) + " and " + neighbour +
                       " are too near to each other at " + place + " to be kept apart" +
                       (tolerance_ > least_tolerance_ ? "; try a smaller snap distance" : ""),
                   at}};
  }

  // Cuts a piece, or what it meets, and queues it again if it still exists; does nothing if it
  // meets nothing. What straight pieces meet that is no arc is left to the arrangement.
  void settle(std::uint32_t piece) {
    std::vector<std::uint32_t> others = near(tree_, piece);
    const bool is_straight = pieces_[piece].bulge == 0;
    std::erase_if(others, [&](std::uint32_t other) {
      return other == piece || (is_straight && pieces_[other].bulge == 0);
    });
    // Contacts before all else, or the pieces would halve each other.
    const bool met =
        (hulls_count_ &&
         std::ranges::any_of(others,
                             [&](std::uint32_t other) { return trim_contact(piece, other); })) ||
        (!is_straight && meets_point(piece)) ||
        std::ranges::any_of(others, [&](std::uint32_t other) { return resolve(piece, other); });
    if (met && exists_[piece]) queue_.push_back(piece);
  }

  // Copies: what is queried changes.
  template <class Shape>
  std::vector<std::uint32_t> near(const Tree<Shape>& tree, std::uint32_t piece) const {
    std::vector<std::pair<Shape, std::uint32_t>> found;
    tree.query(boost::geometry::index::intersects(box_around(pieces_[piece], 2 * tolerance_)),
               std::back_inserter(found));
    std::vector<std::uint32_t> values;
    for (const auto& [shape, value] : found) values.push_back(value);
    std::sort(values.begin(), values.end());
    return values;
  }

  bool meets_point(std::uint32_t piece) {
    const ArcPiece p = pieces_[piece];
    for (const std::uint32_t v : near(corners_, piece)) {
      if (v == p.a || v == p.b ||
          std::min(length(points_[v] - p.from), length(points_[v] - p.to)) < 2 * tolerance_)
        continue;
      if (p.is_near(points_[v], 2 * tolerance_) && lead(piece, v)) return true;
      if (!hulls_count_ || !p.hull_is_near(points_[v], 2 * tolerance_)) continue;
      halve(piece, kNone);
      return true;
    }
    if (!hulls_count_) return false;
    std::vector<std::pair<TreePoint, std::uint32_t>> seeds;
    seeds_.query(boost::geometry::index::intersects(box_around(p, 2 * tolerance_)),
                 std::back_inserter(seeds));
    for (const auto& [at, unused] : seeds) {
      const Point seed{at.x(), at.y()};
      if (!p.hull_is_near(seed, 2 * tolerance_) || p.is_near(seed, 2 * tolerance_)) continue;
      halve(piece, kNone);
      return true;
    }
    return false;
  }

  // Two pieces that leave a common vertex together end at one distance from it. Returns whether one
  // had to be cut.
  bool trim_contact(std::uint32_t i, std::uint32_t j) {
    const ArcPiece p = pieces_[i], q = pieces_[j];
    const std::uint32_t contact = common_vertex(p, q);
    if (contact == kNone || !leave_together(p, q, contact) || is_trimmed(p, q)) return false;
    const bool first = length(p.to - p.from) > length(q.to - q.from);
    const ArcPiece& longer = first ? p : q;
    const ArcPiece& shorter = first ? q : p;
    const std::uint32_t v =
        vertex_at(at_distance(points_[contact], longer.tangent_from(contact),
                              contact == longer.a ? longer.curvature : -longer.curvature,
                              length(shorter.to - shorter.from)));
    if (v == longer.a || v == longer.b) return false;
    cut(first ? i : j, v);
    return true;
  }

  // The only one; kNone if there is none, or two.
  static std::uint32_t common_vertex(const ArcPiece& p, const ArcPiece& q) {
    const bool start = p.a == q.a || p.a == q.b, end = p.b == q.a || p.b == q.b;
    return start == end ? kNone : start ? p.a : p.b;
  }

  // To the rounding of the coordinates.
  bool is_trimmed(const ArcPiece& p, const ArcPiece& q) const {
    const double difference = length(p.to - p.from) - length(q.to - q.from);
    return std::fabs(difference) <= 0x1p-50 / kMergeFraction * least_tolerance_;
  }

  // Returns whether the two met. REQUIRES: no vertex is near to the hull of the first.
  bool resolve(std::uint32_t i, std::uint32_t j) {
    const ArcPiece p = pieces_[i], q = pieces_[j];
    const std::uint32_t common = common_vertex(p, q);
    if (hulls_count_ && common != kNone && leave_together(p, q, common)) return false;
    if ((p.a == q.a && p.b == q.b) || (p.a == q.b && p.b == q.a)) return resolve_twins(i, j);
    for (const std::uint32_t v : {p.a, p.b}) {
      if (v == q.a || v == q.b || !q.is_near(points_[v], tolerance_)) continue;
      if (lead(j, v)) return true;
    }
    if (hulls_count_ && !hulls_meet(p, q)) return false;
    const auto crossing = crossing_of(p, q, 4 * tolerance_);
    if (crossing && !(common != kNone && touch_up_to(p, q, common, *crossing))) {
      const std::uint32_t v = vertex_at(*crossing);
      if (v != p.a && v != p.b) lead(i, v);
      if (v != q.a && v != q.b) lead(j, v);
      if (!exists_[i] || !exists_[j]) return true;
    }
    if (!hulls_count_) return false;
    const double p_height = p.height(), q_height = q.height();
    if (p_height >= 0.5 * q_height) halve(i, j);
    if (q_height >= 0.5 * p_height && q_height > 0) halve(j, i);
    return true;
  }

  // Whether two pieces that leave a vertex together have not parted before `at`.
  bool touch_up_to(const ArcPiece& p, const ArcPiece& q, std::uint32_t vertex, Point at) const {
    if (!leave_together(p, q, vertex)) return false;
    const Point half =
        at_distance(points_[vertex], p.tangent_from(vertex),
                    vertex == p.a ? p.curvature : -p.curvature, 0.5 * length(at - points_[vertex]));
    return q.is_near(half, 4 * tolerance_);
  }

  // Two pieces with both ends in common.
  bool resolve_twins(std::uint32_t i, std::uint32_t j) {
    const ArcPiece p = pieces_[i], q = pieces_[j];
    const double other = p.a == q.a ? q.bulge : -q.bulge;
    if (0.5 * std::fabs(p.bulge - other) * length(p.to - p.from) < 2 * tolerance_) {
      std::uint32_t owners = owners_of_[i];
      for (std::uint32_t o = owners_of_[j]; o != kNone; o = owners_[o].next)
        if (!is_owner(owners_of_[i], owners_[o].segment))
          owners = owner(owners_[o].segment, owners);
      owners_of_[i] = owners;
      remove(j);
      return true;
    }
    if (!hulls_count_) return false;
    if (p.bulge != 0) halve(i, j);
    if (q.bulge != 0) halve(j, i);
    return true;
  }

  Chords result() {
    Chords chords{.pslg = pslg_, .segment = {}};
    chords.pslg.arcs.clear();
    chords.pslg.points.insert(chords.pslg.points.end(), points_.begin() + first_.size(),
                              points_.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> parts;  // segment, piece
    std::vector<bool> is_a_point(pslg_.segments.size(), true);
    for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) {
      if (!exists_[piece]) continue;
      for (std::uint32_t o = owners_of_[piece]; o != kNone; o = owners_[o].next) {
        parts.emplace_back(owners_[o].segment, piece);
        is_a_point[owners_[o].segment] = false;
      }
    }
    for (std::uint32_t s = 0; s < pslg_.segments.size(); ++s)
      if (is_a_point[s]) parts.emplace_back(s, kNone);
    std::sort(parts.begin(), parts.end());
    chords.pslg.segments.clear();
    for (const auto& [segment, piece] : parts) {
      Segment s = pslg_.segments[segment];
      if (piece != kNone) {
        s.a = pieces_[piece].a;
        s.b = pieces_[piece].b;
      }
      if (piece != kNone && pieces_[piece].bulge != 0)
        chords.pslg.arcs.push_back(
            {static_cast<std::uint32_t>(chords.pslg.segments.size()), pieces_[piece].bulge});
      chords.pslg.segments.push_back(s);
      chords.segment.push_back(segment);
    }
    return chords;
  }

  const Pslg& pslg_;
  const double max_turn_;
  StopPoller& poller_;
  const double least_tolerance_;
  const double tolerance_;
  std::vector<Point> points_;         // after merging, then new ones
  std::vector<std::uint32_t> first_;  // per point of the input
  std::vector<double> bulges_;        // per segment of the input
  std::vector<ArcPiece> pieces_;
  std::vector<std::uint32_t> owners_of_;  // per piece
  std::vector<char> exists_;              // per piece
  std::vector<Owner> owners_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> led_;  // segment, vertex
  std::vector<std::uint32_t> queue_;                       // pieces that may meet something
  bool hulls_count_ = false;
  Tree<TreeBox> tree_;       // of pieces
  Tree<TreePoint> corners_;  // vertices
  Tree<TreePoint> seeds_;
};

}  // namespace

Chords cut_arcs(const Pslg& pslg, double max_turn, StopPoller& poller) {
  return ArcCutter(pslg, max_turn, poller).run();
}

void restore_arcs(const Chords& chords, const Pslg& input, Domain& domain, StopPoller& poller) {
  const std::vector<double> bulges = bulges_of(chords.pslg);
  domain.curvatures.assign(domain.subsegments.size(), 0);
  for (std::size_t i = 0; i < domain.subsegments.size(); ++i) {
    poller.step();
    Subsegment& s = domain.subsegments[i];
    const std::uint32_t piece = s.segment;
    s.segment = chords.segment[piece];
    const double bulge = bulges[piece];
    if (bulge == 0) continue;
    const Segment& ends = chords.pslg.segments[piece];
    const std::uint32_t a = domain.input_point[s.a], b = domain.input_point[s.b];
    const bool forward = a == ends.a && b == ends.b;
    if (!forward && !(a == ends.b && b == ends.a))
      throw Stopped{{ErrorCode::kBadOption, "domain.segments[" + std::to_string(s.segment) + "]",
                     "merging has led the arc of segment " + std::to_string(s.segment) +
                         " through another vertex; a smaller snap distance keeps them apart",
                     domain.vertices[s.a]}};
    domain.curvatures[i] =
        curvature_of(length(domain.vertices[s.b] - domain.vertices[s.a]), forward ? bulge : -bulge);
  }
  for (std::uint32_t& point : domain.input_point)
    if (point != kNone && point >= input.points.size()) point = kNone;
  if (domain.outside.segments > 0) domain.outside.first = chords.segment[domain.outside.first];
}

}  // namespace weft
