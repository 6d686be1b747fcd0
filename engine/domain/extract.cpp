// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/extract.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/domain/face.h"
#include "engine/domain/triangulation/hilbert.h"

namespace weft {
namespace {

// The triangles that stay, along a Hilbert curve through their centroids.
std::vector<std::uint32_t> kept_triangles(const Arrangement& a, const Carving& carving,
                                          StopPoller& poller) {
  const auto count = static_cast<std::size_t>(
      a.triangles.size() -
      static_cast<std::size_t>(std::count(carving.region.begin(), carving.region.end(), kNone)));
  // Whether a triangle stays is hard to predict, so there is no branch on it: triangles that do not
  // stay are overwritten.
  std::vector<std::uint32_t> kept(count + 1);
  for (std::uint32_t t = 0, next = 0; t < a.triangles.size(); ++t) {
    poller.step();
    kept[next] = t;
    next += carving.region[t] != kNone;
  }
  kept.resize(count);
  std::vector<Point> centroids;
  centroids.reserve(count);
  for (const std::uint32_t t : kept) {
    poller.step();
    const auto& v = a.triangles[t].vertex;
    const Point p = a.vertices[v[0]], q = a.vertices[v[1]], r = a.vertices[v[2]];
    centroids.push_back({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
  }
  std::vector<std::uint32_t> order = hilbert_order(centroids, poller);
  for (std::uint32_t& i : order) i = kept[i];
  return order;
}

}  // namespace

Domain extract(const Arrangement& a, Carving&& carving, StopPoller& poller) {
  const std::vector<std::uint32_t> kept = kept_triangles(a, carving, poller);
  std::vector<std::uint32_t> triangle_number(a.triangles.size() + 1, kNone);
  std::vector<std::uint32_t> vertex_number(a.vertices.size(), kNone);
  for (std::uint32_t i = 0; i < kept.size(); ++i) {
    poller.step();
    triangle_number[kept[i]] = i;
    for (const std::uint32_t v : a.triangles[kept[i]].vertex) vertex_number[v] = 0;
  }

  Domain domain;
  domain.vertices.reserve(a.vertices.size());
  domain.input_point.reserve(a.vertices.size());
  for (std::uint32_t v = 0; v < a.vertices.size(); ++v) {
    poller.step();
    if (vertex_number[v] == kNone) continue;
    vertex_number[v] = static_cast<std::uint32_t>(domain.vertices.size());
    domain.vertices.push_back(a.vertices[v]);
    domain.input_point.push_back(a.input_point[v]);
  }

  // The last entries of these two stand for no constraint and no neighbour. Which edges carry a
  // constraint, and which of them come first, is hard to predict, so there is no branch on it.
  const auto no_constraint = static_cast<std::uint32_t>(a.constraints.size());
  const auto no_triangle = static_cast<std::uint32_t>(a.triangles.size());
  std::vector<std::uint32_t> subsegment_number(a.constraints.size() + 1, kNone);
  std::vector<std::uint32_t> constraint(a.constraints.size() + 1);  // per subsegment
  std::uint32_t subsegments = 0;
  domain.subsegments.resize(a.constraints.size() + 1);
  domain.triangles.reserve(kept.size());
  for (const std::uint32_t t : kept) {
    poller.step();
    const Arrangement::Triangle& from = a.triangles[t];
    Domain::Triangle to;
    for (int i = 0; i < 3; ++i) {
      to.vertex[i] = vertex_number[from.vertex[i]];
      to.neighbor[i] = triangle_number[std::min(from.neighbor[i], no_triangle)];
    }
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t c = std::min(from.constraint[i], no_constraint);
      const std::uint32_t known = subsegment_number[c];
      const std::uint32_t is_new = (known == kNone) & (c != no_constraint);
      to.subsegment[i] = known ^ ((known ^ subsegments) & (0 - is_new));
      subsegment_number[c] = to.subsegment[i];
      constraint[subsegments] = c;
      domain.subsegments[subsegments].a = to.vertex[ccw(i)];
      domain.subsegments[subsegments].b = to.vertex[cw(i)];
      subsegments += is_new;
    }
    to.region = carving.region[t];
    domain.triangles.push_back(to);
  }
  domain.subsegments.resize(subsegments);
  for (std::uint32_t s = 0; s < subsegments; ++s) {
    poller.step();
    domain.subsegments[s].segment = a.constraints[constraint[s]].segment;
    domain.subsegments[s].marker = a.constraints[constraint[s]].marker;
  }
  domain.regions = std::move(carving.regions);
  domain.merging = a.merging;
  domain.overlap = carving.overlap;
  domain.outside = carving.outside;
  return domain;
}

}  // namespace weft
