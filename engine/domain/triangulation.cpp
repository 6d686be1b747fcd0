// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/domain/hilbert.h"

namespace weft {
namespace {

// A biased randomised insertion order (Amenta, Choi, Rote, "Incremental constructions con BRIO",
// 2003): rounds of doubling size, each along the Hilbert curve. The round comes from a hash of the
// rank, so the order is the same on every run.
constexpr unsigned kRounds = 13;
unsigned insertion_round(std::uint64_t rank) {
  std::uint64_t h = (rank + 1) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  h ^= h >> 31;
  const auto ones = static_cast<unsigned>(__builtin_ctzll(~h));
  return ones < kRounds - 1 ? kRounds - 1 - ones : 0;
}

bool before(Point p, Point q) {
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

// For p on the line through a and b: whether it lies strictly between them.
bool between(Point a, Point b, Point p) {
  return a.x != b.x ? (a.x < p.x) == (p.x < b.x) && p.x != a.x && p.x != b.x
                    : (a.y < p.y) == (p.y < b.y) && p.y != a.y && p.y != b.y;
}

}  // namespace

void Triangulation::build(const std::vector<Point>& points, std::uint32_t a, std::uint32_t b,
                          std::uint32_t c) {
  id_ = hilbert_order(points, pacer_);
  const auto n = static_cast<std::uint32_t>(points.size());
  points_.resize(n);
  vertex_of_point_.resize(n);
  face_of_.assign(n, kNone);
  for (Vertex v = 0; v < n; ++v) {
    points_[v] = points[id_[v]];
    vertex_of_point_[id_[v]] = v;
  }
  faces_.reserve(2 * std::size_t{n});

  // The order of insertion: by round, and in a round along the curve.
  std::array<std::uint32_t, kRounds + 1> start{};
  std::vector<std::uint8_t> round(n);
  for (Vertex v = 0; v < n; ++v) {
    round[v] = static_cast<std::uint8_t>(insertion_round(v));
    ++start[round[v] + 1];
  }
  for (unsigned r = 0; r < kRounds; ++r) start[r + 1] += start[r];
  std::vector<Vertex> sequence(n);
  for (Vertex v = 0; v < n; ++v) sequence[start[round[v]]++] = v;

  // The first triangle, and the three faces around it.
  Vertex u = vertex_of_point_[a], v = vertex_of_point_[b], w = vertex_of_point_[c];
  if (orientation(at(u), at(v), at(w)) < 0) std::swap(v, w);
  faces_.push_back({{u, v, w}, {}});
  faces_.push_back({{w, v, kInfinite}, {}});
  faces_.push_back({{u, w, kInfinite}, {}});
  faces_.push_back({{v, u, kInfinite}, {}});
  for (int i = 0; i < 3; ++i) {
    const auto f = static_cast<std::uint32_t>(i + 1);
    link(0, i, pack(f, 2));
    link(f, 1, pack(static_cast<std::uint32_t>(ccw(i) + 1), 0));
  }
  face_of_[u] = face_of_[v] = face_of_[w] = 0;
  Vertex last = u;
  for (const Vertex next : sequence) {
    pacer_.step();
    if (face_of_[next] != kNone) continue;
    Vertex near = last;
    for (Vertex back = next, tries = 0; back-- > 0 && tries < 16; ++tries)
      if (face_of_[back] != kNone) {
        near = back;
        break;
      }
    insert_delaunay(next, face_of_[near]);
    if (face_of_[next] != kNone) last = next;
  }
  constraints_.assign(faces_.size(), {{kNone, kNone, kNone}});
}

inline bool Triangulation::conflicts(const Face& face, Point p) const {
  const Vertex a = face.vertex[0], b = face.vertex[1], c = face.vertex[2];
  if (c == kInfinite || b == kInfinite || a == kInfinite) [[unlikely]] {
    const int i = a == kInfinite ? 0 : b == kInfinite ? 1 : 2;
    const Point q = at(face.vertex[ccw(i)]), r = at(face.vertex[cw(i)]);
    const int side = orientation(q, r, p);
    return side > 0 || (side == 0 && between(q, r, p));
  }
  const Point q = at(a), r = at(b), s = at(c);
  const int side = in_circle(q, r, s, p);
  if (side != 0) [[likely]]
    return side > 0;
  return perturbed(q, r, s, p) > 0;
}

// Inserts v into the Delaunay triangulation, or makes it stand for the vertex that is there.
void Triangulation::insert_delaunay(Vertex v, std::uint32_t start) {
  const Point p = points_[v];
  Vertex coincident = kNone;
  const std::uint32_t first = find_conflict(p, start, coincident);
  if (coincident != kNone) {
    vertex_of_point_[id_[v]] = coincident;
    if (id_[v] < id_[coincident]) std::swap(id_[v], id_[coincident]);
    return;
  }
  // The faces in conflict hang together as a tree; the border comes out counter-clockwise.
  dead_.clear();
  border_.clear();
  stack_.clear();
  dead_.push_back(first);
  {
    const Face& f = faces_[first];
    stack_.push_back(f.neighbor[2]);
    stack_.push_back(f.neighbor[1]);
    stack_.push_back(f.neighbor[0]);
  }
  while (!stack_.empty()) {
    const std::uint32_t h = stack_.back();
    stack_.pop_back();
    const Face& f = faces_[h >> 2];
    const int i = static_cast<int>(h & 3);
    if (conflicts(f, p)) {
      dead_.push_back(h >> 2);
      stack_.push_back(f.neighbor[cw(i)]);
      stack_.push_back(f.neighbor[ccw(i)]);
    } else {
      border_.push_back({f.vertex[cw(i)], h});
    }
  }
  const std::size_t count = border_.size();
  while (dead_.size() < count) {
    dead_.push_back(static_cast<std::uint32_t>(faces_.size()));
    faces_.push_back({});
  }
  std::uint32_t previous = dead_[count - 1];
  std::uint32_t current = dead_[0];
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t next = k + 1 < count ? dead_[k + 1] : dead_[0];
    const Vertex a = border_[k].from;
    const Vertex b = k + 1 < count ? border_[k + 1].from : border_[0].from;
    const std::uint32_t outside = border_[k].outside;
    faces_[current] = {{v, a, b}, {outside, pack(next, 2), pack(previous, 1)}};
    faces_[outside >> 2].neighbor[outside & 3] = pack(current, 0);
    if (a != kInfinite) face_of_[a] = current;
    previous = current;
    current = next;
  }
  face_of_[v] = dead_[0];
}

// Walks to a face in conflict with p: one that contains it, or outside one whose edge it sees. Of
// each face it knows the edge that it came across; which of the other two to cross is hard to
// foresee, so both are tested, and there is no branch on the choice.
std::uint32_t Triangulation::find_conflict(Point p, std::uint32_t start, Vertex& coincident) const {
  Edge e{start, 0};
  if (is_infinite(start)) e.i = index(start, kInfinite);
  if (orientation(at(right(e)), at(left(e)), p) < 0) {
    e = mirror(e);
    if (apex(e) == kInfinite) return e.face;
  } else if (apex(e) == kInfinite) {
    if (orientation(at(right(e)), at(left(e)), p) > 0) return start;
    e = mirror(e);
  }
  Point r = at(right(e)), l = at(left(e));
  for (;;) {
    pacer_.step();
    const Face& face = faces_[e.face];
    const Point q = at(face.vertex[e.i]);
    const double lx = l.x - p.x, ly = l.y - p.y, qx = q.x - p.x, qy = q.y - p.y, rx = r.x - p.x,
                 ry = r.y - p.y;
    const double lq = lx * qy, ql = ly * qx, qr = qx * ry, rq = qy * rx;
    const double of_left = lq - ql, of_right = qr - rq;
    bool beyond_left = of_left < 0, beyond_right = of_right < 0;
    if ((std::fabs(of_left) <= kOrientationError * (std::fabs(lq) + std::fabs(ql))) |
        (std::fabs(of_right) <= kOrientationError * (std::fabs(qr) + std::fabs(rq)))) [[unlikely]] {
      for (const Vertex v : face.vertex)
        if (at(v) == p) {
          coincident = v;
          return e.face;
        }
      beyond_left = orientation_exact(l, q, p) < 0;
      beyond_right = orientation_exact(q, r, p) < 0;
    }
    if (!(beyond_left | beyond_right)) return e.face;
    e = unpack(face.neighbor[beyond_left ? ccw(e.i) : cw(e.i)]);
    r = beyond_left ? q : r;
    l = beyond_left ? l : q;
    if (faces_[e.face].vertex[e.i] == kInfinite) return e.face;
  }
}

// Source: CGAL's Triangulation_2::side_of_oriented_circle.
int Triangulation::perturbed(Point a, Point b, Point c, Point p) const {
  const Point* sorted[4] = {&a, &b, &c, &p};
  std::sort(sorted, sorted + 4, [](const Point* q, const Point* r) { return before(*q, *r); });
  for (int i = 3; i > 0; --i) {
    if (sorted[i] == &p) return -1;
    int side = 0;
    if (sorted[i] == &c) side = orientation(a, b, p);
    if (sorted[i] == &b) side = orientation(a, p, c);
    if (sorted[i] == &a) side = orientation(p, b, c);
    if (side != 0) return side;
  }
  return -1;
}

std::uint32_t Triangulation::new_face() {
  faces_.push_back({});
  constraints_.push_back({{kNone, kNone, kNone}});
  return static_cast<std::uint32_t>(faces_.size() - 1);
}

void Triangulation::constrain(Edge e, std::uint32_t constraint) {
  const Edge m = mirror(e);
  constraints_[e.face].edge[e.i] = constraint;
  constraints_[m.face].edge[m.i] = constraint;
}

Triangulation::Edge Triangulation::find_edge(Vertex u, Vertex v) const {
  Edge turning[2];
  const Vertex center[2] = {u, v};
  const Vertex other[2] = {v, u};
  for (int k = 0; k < 2; ++k)
    turning[k] = {face_of_[center[k]], index(face_of_[center[k]], center[k])};
  const std::uint32_t first[2] = {turning[0].face, turning[1].face};
  for (int k = 0;; k ^= 1) {
    // The face of `turning` has its center as vertex i.
    auto& [f, i] = turning[k];
    const Face& face = faces_[f];
    if (face.vertex[ccw(i)] == other[k]) return {f, cw(i)};
    const std::uint32_t h = face.neighbor[ccw(i)];  // the edge at vertices cw(i) and i
    f = h >> 2;
    i = ccw(static_cast<int>(h & 3));
    if (f == first[k]) return {};
  }
}

// Replaces edge a-b of the faces abc and bad by c-d.
void Triangulation::flip(Edge e) {
  const std::uint32_t t = e.face;
  const int i = e.i;
  const auto [s, j] = mirror(e);
  Face& ft = faces_[t];
  Face& fs = faces_[s];
  const Vertex a = ft.vertex[ccw(i)], b = ft.vertex[cw(i)], c = ft.vertex[i], d = fs.vertex[j];
  const std::uint32_t ca = ft.neighbor[cw(i)], bc = ft.neighbor[ccw(i)];
  const std::uint32_t ad = fs.neighbor[ccw(j)], db = fs.neighbor[cw(j)];
  OnEdges& ct = constraints_[t];
  OnEdges& cs = constraints_[s];
  const std::uint32_t on_ca = ct.edge[cw(i)], on_bc = ct.edge[ccw(i)];
  const std::uint32_t on_ad = cs.edge[ccw(j)], on_db = cs.edge[cw(j)];
  ft.vertex[i] = a;
  ft.vertex[ccw(i)] = d;
  ft.vertex[cw(i)] = c;
  fs.vertex[j] = b;
  fs.vertex[ccw(j)] = c;
  fs.vertex[cw(j)] = d;
  link(t, ccw(i), ca);
  link(t, cw(i), ad);
  link(s, ccw(j), db);
  link(s, cw(j), bc);
  ct.edge[ccw(i)] = on_ca;
  ct.edge[cw(i)] = on_ad;
  cs.edge[ccw(j)] = on_db;
  cs.edge[cw(j)] = on_bc;
  if (a != kInfinite) face_of_[a] = t;
  if (d != kInfinite) face_of_[d] = t;
  if (c != kInfinite) face_of_[c] = t;
  if (b != kInfinite) face_of_[b] = s;
}

// C. Lawson's flips until every edge without a constraint is Delaunay again.
void Triangulation::restore(std::vector<std::uint32_t>& suspects) {
  while (!suspects.empty()) {
    pacer_.step();
    const Edge e = unpack(suspects.back());
    suspects.pop_back();
    if (constraint(e) != kNone) continue;
    const Edge m = mirror(e);
    Edge side = e, other = m;
    if (apex(side) == kInfinite) std::swap(side, other);
    if (apex(side) == kInfinite || !conflicts(faces_[other.face], at(apex(side)))) continue;
    flip(e);
    for (const Edge f : {e, m}) {
      suspects.push_back(pack(f.face, ccw(f.i)));
      suspects.push_back(pack(f.face, cw(f.i)));
    }
  }
}

void Triangulation::unconstrain(Edge e) {
  constrain(e, kNone);
  stack_.assign(1, pack(e.face, e.i));
  restore(stack_);
}

// Digs along the segment by flips at u, and repairs what is left on both sides.
// Source: Triangle's constrainededge() and delaunayfixup(). Here a half-edge goes from vertex
// ccw(i) to cw(i).
Triangulation::Edge Triangulation::insert_edge(Vertex u, Vertex v, Edge first) {
  const auto origin_previous = [this](Edge e) {
    const Edge m = mirror(e);
    return Edge{m.face, ccw(m.i)};
  };
  const Point a = at(u), b = at(v);
  Edge e = first;
  flip(e);
  for (;;) {
    pacer_.step();
    const Vertex far = right(e);
    const Edge other = origin_previous(e);
    if (far == v) {
      fix_up(e, false);
      fix_up(other, true);
      return find_edge(u, v);
    }
    // Of e, what a fix-up leaves: the edge between far and u, seen from the side that is dug next.
    if (orientation(a, b, at(far)) > 0) {
      fix_up(other, true);
      e = {e.face, cw(e.i)};
    } else {
      fix_up(e, false);
      e = other;
    }
    flip(e);
  }
}

void Triangulation::fix_up(Edge e, bool left_side) {
  stack_.assign(1, pack(e.face, e.i));
  while (!stack_.empty()) {
    pacer_.step();
    e = unpack(stack_.back());
    stack_.pop_back();
    const Edge near{e.face, ccw(e.i)};
    const Edge far = mirror(near);
    if (apex(far) == kInfinite || constraint(near) != kNone) continue;
    const Point n = at(apex(near)), l = at(right(near)), r = at(left(near)), f = at(apex(far));
    if ((left_side ? orientation(n, l, f) : orientation(f, r, n)) <= 0) continue;
    if (orientation(r, l, f) > 0 && !conflicts(faces_[far.face], n)) continue;
    flip(near);
    stack_.push_back(pack(far.face, far.i));
    stack_.push_back(pack(e.face, cw(e.i)));
  }
}

// The visibility walk with a random choice, as constraints may lead a plain one in circles.
Triangulation::Place Triangulation::locate(Point p, std::uint32_t start) const {
  std::uint32_t random = 2463534242u;
  std::uint32_t f = start;
  if (is_infinite(f)) f = faces_[f].neighbor[index(f, kInfinite)] >> 2;
  for (;;) {
    pacer_.step();
    random ^= random << 13;
    random ^= random >> 17;
    random ^= random << 5;
    const Face& face = faces_[f];
    int side[3];
    for (int i = 0; i < 3; ++i)
      side[i] = orientation(at(face.vertex[ccw(i)]), at(face.vertex[cw(i)]), p);
    int i = static_cast<int>(random % 3);
    int tried = 0;
    while (tried < 3 && side[i] >= 0) {
      ++tried;
      i = ccw(i);
    }
    if (tried == 3) {
      for (int k = 0; k < 3; ++k)
        if (at(face.vertex[k]) == p) return {At::kVertex, {f, k}};
      for (int k = 0; k < 3; ++k)
        if (side[k] == 0) return {At::kEdge, {f, k}};
      return {At::kFace, {f, 0}};
    }
    const Edge next = unpack(face.neighbor[i]);
    if (apex(next) == kInfinite) return {At::kOutside, next};
    f = next.face;
  }
}

Triangulation::Vertex Triangulation::insert(Point p, std::uint32_t id, const Place& place) {
  const auto v = static_cast<Vertex>(points_.size());
  points_.push_back(p);
  id_.push_back(id);
  face_of_.push_back(kNone);
  const std::uint32_t f = place.edge.face;
  stack_.clear();
  const auto split_face = [this, v](std::uint32_t face) {
    const Face old = faces_[face];
    const OnEdges on = constraints_[face];
    const std::uint32_t part[3] = {face, new_face(), new_face()};
    for (int i = 0; i < 3; ++i) {
      const Vertex a = old.vertex[ccw(i)], b = old.vertex[cw(i)];
      Face& to = faces_[part[i]];
      to.vertex[0] = v;
      to.vertex[1] = a;
      to.vertex[2] = b;
      to.neighbor[1] = pack(part[ccw(i)], 2);
      to.neighbor[2] = pack(part[cw(i)], 1);
      constraints_[part[i]] = {{on.edge[i], kNone, kNone}};
      if (a != kInfinite) face_of_[a] = part[i];
    }
    for (int i = 0; i < 3; ++i) link(part[i], 0, old.neighbor[i]);
    face_of_[v] = face;
  };
  if (place.at != At::kEdge) {
    split_face(f);
    Edge e{f, 0};
    for (int i = 0; i < 3; ++i) {
      stack_.push_back(pack(e.face, 0));
      e.face = faces_[e.face].neighbor[1] >> 2;
    }
    restore(stack_);
    return v;
  }
  // Splits the near face, which leaves a flat one at the edge, and flips that away.
  const std::uint32_t on = constraint(place.edge);
  const Vertex from = right(place.edge), to = left(place.edge);
  if (on != kNone) constrain(place.edge, kNone);
  split_face(f);
  flip(find_edge(from, to));
  if (on != kNone) {
    constrain(find_edge(from, v), on);
    constrain(find_edge(v, to), on);
  }
  const std::uint32_t around = face_of_[v];
  Edge turn{around, index(around, v)};
  do {
    stack_.push_back(pack(turn.face, turn.i));
    const Edge n = mirror({turn.face, ccw(turn.i)});
    turn = {n.face, ccw(n.i)};
  } while (turn.face != around);
  restore(stack_);
  return v;
}

}  // namespace weft
