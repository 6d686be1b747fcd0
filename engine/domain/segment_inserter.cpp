// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/segment_inserter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/domain/crossing.h"
#include "engine/domain/snapping.h"

namespace weft {
namespace {

// Whether ab and cd cross in a point interior to both.
bool properly_cross(Point a, Point b, Point c, Point d) {
  return orientation_exact(a, b, c) * orientation_exact(a, b, d) < 0 &&
         orientation_exact(c, d, a) * orientation_exact(c, d, b) < 0;
}

void merge(Arrangement::Constraint& into, const Arrangement::Constraint& other) {
  into.segment = std::min(into.segment, other.segment);
  if (other.marker_segment < into.marker_segment) {
    into.marker_segment = other.marker_segment;
    into.marker = other.marker;
  }
  into.odd = into.odd != other.odd;
}

}  // namespace

SegmentInserter::SegmentInserter(const Pslg& pslg, Triangulation& triangulation,
                                 std::uint64_t max_splits, Pacer& pacer)
    : pslg_(pslg), t_(triangulation), max_splits_(max_splits), pacer_(pacer) {
  double largest = 0;
  for (const Point p : pslg.points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  surely_apart_ = 2 * snap_distance({largest, 0}, {0, 0});
  constraints_.reserve(pslg.segments.size());
}

void SegmentInserter::insert_all() {
  for (std::uint32_t i = 0; i < pslg_.segments.size(); ++i) {
    const Segment& s = pslg_.segments[i];
    const Piece whole{
        t_.vertex_of(s.a), t_.vertex_of(s.b), {i, s.marker, s.marker != 0 ? i : kNone, true}};
    if (whole.u != whole.v) insert(whole);
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      insert(piece);
    }
  }
}

// Looks from both ends in turn, so that a hub of many segments does not cost its degree each time.
void SegmentInserter::insert(const Piece& piece) {
  pacer_.step();
  if (const Edge edge = t_.find_edge(piece.u, piece.v); edge.face != kNone) {
    // The edge is there, but may pass by a vertex within the snapping distance, a corner of the
    // needle beside it.
    for (const Edge& side : {edge, t_.mirror(edge)}) {
      const Vertex apex = t_.apex(side);
      if (apex != Triangulation::kInfinite && touches(apex, piece))
        return push_through(apex, piece);
    }
    return remember(edge, piece);
  }
  LineProbe from_u(t_, piece.u, piece.v);
  LineProbe from_v(t_, piece.v, piece.u);
  for (bool u_is_next = true;; u_is_next = !u_is_next) {
    pacer_.step();
    LineProbe& probe = u_is_next ? from_u : from_v;
    switch (probe.turn()) {
      case LineProbe::Sees::kNothingYet:
      case LineProbe::Sees::kEdge:
        break;
      case LineProbe::Sees::kVertex:
        return push_through(probe.vertex(), piece);
      case LineProbe::Sees::kCrossing:
        return walk(probe, piece);
    }
  }
}

// Follows the piece through the triangles that it crosses, up to the first thing in its way.
void SegmentInserter::walk(const LineProbe& probe, const Piece& piece) {
  const Point a = at(probe.from());
  const Point b = at(probe.to());

  Edge edge = probe.edge();
  Vertex right = t_.right(edge);
  Vertex left = t_.left(edge);
  if (touches(right, piece)) return push_through(right, piece);
  if (touches(left, piece)) return push_through(left, piece);
  for (;;) {
    pacer_.step();
    if (t_.constraint(edge) != kNone) return cross(edge, piece);
    const Edge next = t_.mirror(edge);
    const Vertex w = t_.apex(next);
    if (w == probe.to()) return remember(t_.insert_edge(probe.from(), w, probe.edge()), piece);
    const int side = orientation(a, b, at(w));
    if (side == 0 || touches(w, piece)) return push_through(w, piece);
    // w replaces the end on its side; the next edge crossed is opposite to the one replaced.
    Vertex& replaced = side > 0 ? left : right;
    edge = {next.face, t_.index(next.face, replaced)};
    replaced = w;
  }
}

bool SegmentInserter::splits_cleanly(Edge edge, Point p) const {
  const Edge mirror = t_.mirror(edge);
  if (t_.apex(edge) == kNone || t_.apex(mirror) == kNone) return false;
  const Point r = at(t_.right(edge));
  const Point l = at(t_.left(edge));
  const Point near = at(t_.apex(edge));
  const Point far = at(t_.apex(mirror));
  return orientation(near, r, p) > 0 && orientation(near, p, l) > 0 && orientation(far, p, r) > 0 &&
         orientation(far, l, p) > 0 && in_circle(near, r, l, p) > 0 && in_circle(far, l, r, p) > 0;
}

// Makes the piece and the constrained edge that it crosses meet in a vertex.
void SegmentInserter::cross(Edge edge, const Piece& piece) {
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  const auto [a, b] = segment(piece.constraint);
  const auto [c, d] = segment(constraints_[t_.constraint(edge)]);
  const double snap = std::max(snap_distance(a, b), snap_distance(c, d));
  if (properly_cross(a, b, c, d) && meet_at(crossing_point(a, b, c, d), snap, edge, piece)) return;
  // Rounding has bent the two, so that they cross elsewhere than their segments, if these do.
  const Point p = crossing_point(at(piece.u), at(piece.v), at(right), at(left));
  if (!meet_at(p, snap, edge, piece)) meet_in_new_vertex(p, edge, piece);
}

// Declines where one of the two would not advance.
bool SegmentInserter::meet_at(Point p, double snap, Edge edge, const Piece& piece) {
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  const Constraint& other = constraints_[t_.constraint(edge)];
  std::array<Vertex, 4> nearest{piece.u, piece.v, right, left};
  std::stable_sort(nearest.begin(), nearest.end(), [this, p](Vertex v, Vertex w) {
    return distance(at(v), p) < distance(at(w), p);
  });
  for (const Vertex w : nearest) {
    if (distance(at(w), p) > snap) break;
    if (is_end(w, edge) ? !advances(at(w), piece.u, piece.v, piece.constraint)
                        : !advances(at(w), right, left, other))
      continue;
    meet_in_end(w, edge, piece);
    return true;
  }
  if (!advances(p, piece.u, piece.v, piece.constraint) || !advances(p, right, left, other))
    return false;
  meet_in_new_vertex(p, edge, piece);
  return true;
}

// w is an end of one of the two; the other one is led through it.
void SegmentInserter::meet_in_end(Vertex w, Edge edge, const Piece& piece) {
  if (is_end(w, edge)) return push_through(w, piece);
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  push(piece.u, piece.v, piece.constraint);
  push_through(w, {right, left, unconstrain(edge)});
}

void SegmentInserter::meet_in_new_vertex(Point p, Edge edge, const Piece& piece) {
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  const auto id = static_cast<std::uint32_t>(pslg_.points.size()) + crossings_;
  Vertex w;
  if (splits_cleanly(edge, p)) {
    // As if p lay on the edge. The general way gives the same; this one spares the triangles
    // around a long edge from losing its constraint and getting it back.
    count_split();
    insert_on(edge, p, id, w);
  } else {
    const std::uint32_t hint = edge.face;
    const Constraint other = unconstrain(edge);
    w = insert_crossing(p, id, hint);
    push_through(w, {right, left, other});
  }
  if (t_.id(w) == id) ++crossings_;
  push_through(w, piece);
  pacer_.require(estimated_bytes(pslg_.points.size() + crossings_, constraints_.size()));
}

// Inserts p, or finds the vertex that is there already.
SegmentInserter::Vertex SegmentInserter::insert_crossing(Point p, std::uint32_t id,
                                                         std::uint32_t hint) {
  const Triangulation::Place place = t_.locate(p, hint);
  if (place.at == Triangulation::At::kVertex) return t_.apex(place.edge);
  if (place.at != Triangulation::At::kEdge || t_.constraint(place.edge) == kNone)
    return t_.insert(p, id, place);
  Vertex w;
  insert_on(place.edge, p, id, w);
  return w;
}

// Splits a constrained edge, whose halves may come to differ.
void SegmentInserter::insert_on(Edge edge, Point p, std::uint32_t id, Vertex& w) {
  const Vertex right = t_.right(edge);
  const Constraint constraint = constraints_[t_.constraint(edge)];
  w = t_.insert(p, id, {Triangulation::At::kEdge, edge});
  t_.constrain(t_.find_edge(right, w), static_cast<std::uint32_t>(constraints_.size()));
  constraints_.push_back(constraint);
}

void SegmentInserter::push(Vertex u, Vertex v, const Constraint& constraint) {
  if (u != v) pieces_.push_back({u, v, constraint});
}

// u to w comes first.
void SegmentInserter::push_through(Vertex w, const Piece& piece) {
  count_split();
  push(w, piece.v, piece.constraint);
  push(piece.u, w, piece.constraint);
}

// The piece has become an edge.
void SegmentInserter::remember(Edge edge, const Piece& piece) {
  if (const std::uint32_t constraint = t_.constraint(edge); constraint != kNone)
    return merge(constraints_[constraint], piece.constraint);
  t_.constrain(edge, static_cast<std::uint32_t>(constraints_.size()));
  constraints_.push_back(piece.constraint);
}

SegmentInserter::Constraint SegmentInserter::unconstrain(Edge edge) {
  const Constraint constraint = constraints_[t_.constraint(edge)];
  t_.unconstrain(edge);
  return constraint;
}

void SegmentInserter::count_split() {
  if (++splits_ > max_splits_)
    throw Stopped{{ErrorCode::kLimitExceeded, "domain.segments",
                   "the segments cross and overlap more than " + std::to_string(max_splits_) +
                       " times, which is the limit"}};
}

bool SegmentInserter::touches(Vertex w, const Piece& piece) const {
  const auto [a, b] = segment(piece.constraint);
  const Point p = at(w);
  const double ux = b.x - a.x, uy = b.y - a.y;
  const double area = ux * (p.y - a.y) - uy * (p.x - a.x);
  if (area * area > surely_apart_ * surely_apart_ * (ux * ux + uy * uy)) [[likely]]
    return false;
  return distance_to_line(p, a, b) <= snap_distance(a, b) &&
         advances(at(w), piece.u, piece.v, piece.constraint);
}

bool SegmentInserter::advances(Point p, Vertex u, Vertex v, const Constraint& constraint) const {
  const auto [a, b] = segment(constraint);
  const auto [low, high] = std::minmax({progress(at(u), a, b), progress(at(v), a, b)});
  const double here = progress(p, a, b);
  return low < here && here < high;
}

std::pair<Point, Point> SegmentInserter::segment(const Constraint& constraint) const {
  const Segment& s = pslg_.segments[constraint.segment];
  return {pslg_.points[s.a], pslg_.points[s.b]};
}

}  // namespace weft
