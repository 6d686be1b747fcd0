// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "checker/geometry/predicates.h"
#include "checker/geometry/ray.h"
#include "checker/geometry/sum.h"

namespace weft::check {
namespace {

constexpr std::uint32_t kUnset = 0xffffffffu;

// Holds the edge even if its ends are crossings, which are rounded by at most two units.
Box box_around(Vec2 p, Vec2 q) {
  Box box = box_of(p, q);
  const auto margin = [](double value) { return 0x1p-50 * std::fabs(value); };
  box.min_x -= margin(box.min_x);
  box.min_y -= margin(box.min_y);
  box.max_x += margin(box.max_x);
  box.max_y += margin(box.max_y);
  return box;
}

std::vector<Box> boxes_of(const std::vector<Arrangement::Edge>& edges, const VertexOrder& order) {
  std::vector<Box> boxes;
  boxes.reserve(edges.size());
  for (const Arrangement::Edge& edge : edges)
    boxes.push_back(box_around(order.at(edge.u), order.at(edge.v)));
  return boxes;
}

}  // namespace

Arrangement::Arrangement(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
                         const Contacts& contacts, std::size_t links)
    : vertices_(points, segments, contacts), tree_({}) {
  split(points, segments, contacts, links);
  tree_ = BoxTree(boxes_of(edges_, vertices_));
  sort_around_vertices();
  trace_faces();
  measure_faces();
}

// Cuts each segment at its vertices and merges the pieces that coincide.
void Arrangement::split(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
                        const Contacts& contacts, std::size_t links) {
  struct Cut {
    std::uint32_t segment, vertex;
    auto operator<=>(const Cut&) const = default;
  };
  std::vector<Cut> cuts;
  cuts.reserve(2 * segments.size() + contacts.touches.size() + 2 * contacts.crossings.size());
  for (std::uint32_t s = 0; s < segments.size(); ++s)
    for (const std::uint32_t end : segments[s]) cuts.push_back({s, vertices_.of_point(end)});
  for (const auto [segment, point] : contacts.touches)
    cuts.push_back({segment, vertices_.of_point(point)});
  for (std::uint32_t k = 0; k < contacts.crossings.size(); ++k) {
    cuts.push_back({contacts.crossings[k].first, vertices_.of_crossing(k)});
    cuts.push_back({contacts.crossings[k].second, vertices_.of_crossing(k)});
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());

  struct Piece {
    std::uint32_t u, v, segment, slot;  // slot: where in segment_edges_ its edge goes
    auto operator<=>(const Piece&) const = default;
  };
  std::vector<Piece> pieces;
  first_edge_.assign(segments.size() + 1, 0);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k].segment != cuts[k + 1].segment) continue;
    pieces.push_back({cuts[k].vertex, cuts[k + 1].vertex, cuts[k].segment,
                      static_cast<std::uint32_t>(pieces.size())});
    ++first_edge_[cuts[k].segment + 1];
  }
  std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
  segment_edges_.resize(pieces.size());
  std::sort(pieces.begin(), pieces.end());
  covers_.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    const auto end = static_cast<std::uint32_t>(covers_.size());
    if (edges_.empty() || edges_.back().u != piece.u || edges_.back().v != piece.v) {
      Vec2 from = points[segments[piece.segment][0]];
      Vec2 to = points[segments[piece.segment][1]];
      if (lexicographically_less(to, from)) std::swap(from, to);
      edges_.push_back({piece.u, piece.v, from, to, end, end});
    }
    if (piece.segment < links) {
      covers_.push_back(piece.segment);
      edges_.back().end_cover = end + 1;
    }
    segment_edges_[piece.slot] = static_cast<std::uint32_t>(edges_.size() - 1);
  }
}

std::uint32_t Arrangement::start(std::uint32_t half_edge) const {
  const Edge& edge = edges_[half_edge / 2];
  return half_edge % 2 == 0 ? edge.u : edge.v;
}

// Whether the half-edge's direction is in [0, 180) degrees.
bool Arrangement::points_up(std::uint32_t half_edge) const {
  const Edge& edge = edges_[half_edge / 2];
  const bool rises = edge.to.y >= edge.from.y;  // level: to the right, as from is smaller
  return rises == (half_edge % 2 == 0);
}

// Order of directions, counter-clockwise from that of x.
bool Arrangement::turns_before(std::uint32_t h, std::uint32_t g) const {
  const bool up_h = points_up(h);
  const bool up_g = points_up(g);
  if (up_h != up_g) return up_h;
  const Edge& e = edges_[h / 2];
  const Edge& f = edges_[g / 2];
  const int turn = cross_sign(e.from, e.to, f.from, f.to);
  return (h % 2 == g % 2 ? turn : -turn) > 0;
}

void Arrangement::sort_around_vertices() {
  const auto half_edges = static_cast<std::uint32_t>(2 * edges_.size());
  first_outgoing_.assign(vertices_.size() + 1, 0);
  for (std::uint32_t h = 0; h < half_edges; ++h) ++first_outgoing_[start(h) + 1];
  std::partial_sum(first_outgoing_.begin(), first_outgoing_.end(), first_outgoing_.begin());
  outgoing_.resize(half_edges);
  std::vector<std::uint32_t> next = first_outgoing_;
  for (std::uint32_t h = 0; h < half_edges; ++h) outgoing_[next[start(h)]++] = h;
  for (std::uint32_t v = 0; v < vertices_.size(); ++v)
    std::sort(outgoing_.begin() + first_outgoing_[v], outgoing_.begin() + first_outgoing_[v + 1],
              [this](std::uint32_t h, std::uint32_t g) { return turns_before(h, g); });
}

void Arrangement::trace_faces() {
  const auto half_edges = static_cast<std::uint32_t>(outgoing_.size());
  std::vector<std::uint32_t> slot(half_edges);
  for (std::uint32_t k = 0; k < half_edges; ++k) slot[outgoing_[k]] = k;

  // Loops: at the end of a half-edge, the first one clockwise from the half-edge continues the same
  // face on the left.
  std::vector<std::uint32_t> loop(half_edges, kUnset);
  std::uint32_t loops = 0;
  for (std::uint32_t first = 0; first < half_edges; ++first) {
    if (loop[first] != kUnset) continue;
    std::uint32_t h = first;
    while (loop[h] == kUnset) {
      loop[h] = loops;
      const std::uint32_t back = h ^ 1u;
      const std::uint32_t at = start(back);
      const std::uint32_t k = slot[back];
      h = outgoing_[(k == first_outgoing_[at] ? first_outgoing_[at + 1] : k) - 1];
    }
    ++loops;
  }

  // Components: each vertex leads to the smallest of its component.
  std::vector<std::uint32_t> smallest(vertices_.size());
  std::iota(smallest.begin(), smallest.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (smallest[v] != v) v = smallest[v] = smallest[smallest[v]];
    return v;
  };
  for (const Edge& edge : edges_) {
    const std::uint32_t u = find(edge.u);
    const std::uint32_t v = find(edge.v);
    smallest[std::max(u, v)] = std::min(u, v);
  }

  // At its smallest vertex, the outer loop of a component has the direction -x on its left. All
  // directions there are in (-90, 90] degrees, so the loop leaves by the last of those that point
  // up, or by the last of all.
  std::vector<std::uint32_t> outer_loop_of(vertices_.size(), kUnset);
  std::vector<std::uint32_t> face_of_loop(loops, kUnset);
  std::vector<char> is_outer(loops, 0);
  for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
    if (find(v) != v) continue;
    const auto around = half_edges_at(v);
    std::uint32_t last = around.back();
    for (const std::uint32_t h : around)
      if (points_up(h)) last = h;
    outer_loop_of[v] = loop[last];
    is_outer[loop[last]] = 1;
  }
  std::uint32_t faces = 1;
  for (std::uint32_t l = 0; l < loops; ++l)
    if (!is_outer[l]) face_of_loop[l] = faces++;
  faces_.resize(faces);

  // The outer loop bounds the face that surrounds the component. A ray to the left of the smallest
  // vertex meets only components with smaller vertices, which have their faces already.
  face_.assign(half_edges, 0);
  for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
    if (outer_loop_of[v] == kUnset) continue;
    const auto hit = nearest_to_the_left(*this, tree_, vertices_.at(v)).half_edge;
    face_of_loop[outer_loop_of[v]] = hit ? face_of_loop[loop[*hit]] : 0;
  }
  for (std::uint32_t h = 0; h < half_edges; ++h) face_[h] = face_of_loop[loop[h]];
}

void Arrangement::measure_faces() {
  // Areas are measured from a vertex of each face, so that the area of a tiny face is not lost in
  // the rounding of triangles that reach far away.
  std::vector<std::uint32_t> origin(faces_.size(), kUnset);
  std::vector<Sum> twice_area(faces_.size());
  for (std::uint32_t h = 0; h < outgoing_.size(); ++h) {
    const std::uint32_t face = face_[h];
    if (origin[face] == kUnset) origin[face] = start(h);
    const Vec2 p = vertices_.at(start(h));
    const Vec2 q = vertices_.at(start(h ^ 1u));
    twice_area[face].add(cross_from(vertices_.at(origin[face]), p, q));
    faces_[face].perimeter += std::hypot(q.x - p.x, q.y - p.y);
  }
  for (std::size_t f = 0; f < faces_.size(); ++f)
    faces_[f].area = static_cast<double>(twice_area[f].total() / 2);
}

Arrangement::Place Arrangement::locate(Vec2 p) const {
  const RayHit hit = nearest_to_the_left(*this, tree_, p);
  if (hit.on_edge) return {face_[2 * *hit.on_edge], hit.on_edge};
  return {hit.half_edge ? face_[*hit.half_edge] : 0, std::nullopt};
}

}  // namespace weft::check
