// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/simplified_domain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "checker/domain/tolerance.h"

namespace weft::check {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

class Reader {
 public:
  Reader(const Domain& original, const Mesh& mesh, const HalfEdges& half_edges)
      : original_(original), mesh_(mesh), half_edges_(half_edges) {}

  SimplifiedDomain read() {
    find_spokes();
    find_corners();
    read_segments();
    read_regions();
    result_.mesh = mesh_;
    result_.mesh.input_points.clear();
    for (std::uint32_t v = 0; v < point_.size(); ++v)
      if (point_[v] != kNone) result_.mesh.input_points.push_back({v, point_[v]});
    result_.domain.fill = Fill::kUnion;
    result_.domain.areas.emplace_back();
    return std::move(result_);
  }

 private:
  // The listed edges at each vertex; those that name no edge of the mesh are left out.
  void find_spokes() {
    const std::size_t count = mesh_.vertices.size();
    first_.assign(count + 1, 0);
    for (std::uint32_t e = 0; e < mesh_.edges.size(); ++e) {
      const Mesh::Edge& edge = mesh_.edges[e];
      const auto h =
          edge.a < count && edge.b < count ? half_edges_.find(edge.a, edge.b) : std::nullopt;
      is_border_.push_back(h && !half_edges_.has_twin(*h) ? 1 : 0);
      is_edge_.push_back(h ? 1 : 0);
      if (h) ++first_[edge.a + 1], ++first_[edge.b + 1];
    }
    for (std::size_t v = 1; v <= count; ++v) first_[v] += first_[v - 1];
    spokes_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t e = 0; e < mesh_.edges.size(); ++e)
      if (is_edge_[e])
        for (const std::uint32_t v : {mesh_.edges[e].a, mesh_.edges[e].b}) spokes_[next[v]++] = e;
  }

  std::uint32_t degree(std::uint32_t v) const {
    return static_cast<std::uint32_t>(first_[v + 1] - first_[v]);
  }
  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const {
    return mesh_.edges[e].a == v ? mesh_.edges[e].b : mesh_.edges[e].a;
  }

  bool runs_straight_on(std::uint32_t v, double tolerance) const {
    if (degree(v) != 2) return false;
    const std::uint32_t e = spokes_[first_[v]], f = spokes_[first_[v] + 1];
    if (mesh_.edges[e].marker != mesh_.edges[f].marker || is_border_[e] != is_border_[f])
      return false;
    const Vec2 p = mesh_.vertices[other_end(e, v)], q = mesh_.vertices[other_end(f, v)];
    return !(p == q) && Track(p, q).carries(mesh_.vertices[v], tolerance);
  }

  void find_corners() {
    const double tolerance = on_segment_tolerance(original_);
    std::vector<Vec2> known = original_.points;
    std::sort(known.begin(), known.end(), lexicographically_less);
    point_.assign(mesh_.vertices.size(), kNone);
    const auto add = [&](std::uint32_t v) {
      point_[v] = static_cast<std::uint32_t>(result_.domain.points.size());
      result_.domain.points.push_back(mesh_.vertices[v]);
    };
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      const bool is_point =
          std::binary_search(known.begin(), known.end(), mesh_.vertices[v], lexicographically_less);
      if (is_point || (degree(v) > 0 && !runs_straight_on(v, tolerance))) add(v);
    }
    // A ring without a corner: any will do.
    std::vector<char> seen(mesh_.vertices.size(), 0);
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
      if (point_[v] != kNone) mark_from(v, seen);
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (degree(v) == 0 || seen[v]) continue;
      add(v);
      mark_from(v, seen);
    }
  }

  void mark_from(std::uint32_t v, std::vector<char>& seen) const {
    seen[v] = 1;
    for (std::size_t s = first_[v]; s < first_[v + 1]; ++s)
      walk(v, spokes_[s], [&](std::uint32_t w) { seen[w] = 1; });
  }

  // Visits the vertices from v along an edge up to the next corner, which it returns, with the last
  // edge.
  template <class Visit>
  std::pair<std::uint32_t, std::uint32_t> walk(std::uint32_t v, std::uint32_t e,
                                               Visit&& visit) const {
    const std::uint32_t start = v;
    while (true) {
      v = other_end(e, v);
      visit(v);
      if (point_[v] != kNone || v == start) return {v, e};
      const std::size_t s = first_[v];
      e = spokes_[s] == e ? spokes_[s + 1] : spokes_[s];
    }
  }

  void read_segments() {
    std::vector<char> done(mesh_.edges.size(), 0);
    Domain& domain = result_.domain;
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (point_[v] == kNone) continue;
      for (std::size_t s = first_[v]; s < first_[v + 1]; ++s) {
        const std::uint32_t e = spokes_[s];
        if (done[e]) continue;
        done[e] = 1;
        const auto [end, last] = walk(v, e, [](std::uint32_t) {});
        done[last] = 1;
        domain.segments.push_back({point_[v], point_[end]});
        domain.markers.push_back(mesh_.edges[e].marker);
        domain.segment_areas.push_back(is_border_[e] ? 1 : 0);
      }
    }
  }

  // The largest bound on areas that the original has for a region; none if a part of it has none.
  std::optional<double> bound_of(std::int32_t region) const {
    double bound = 0;
    const auto add = [&](const std::optional<double>& max_area) {
      bound = std::max(bound, max_area.value_or(std::numeric_limits<double>::infinity()));
    };
    for (const RegionSeed& seed : original_.regions)
      if (seed.id == region) add(seed.max_area);
    for (const Area& area : original_.areas)
      if (area.region == region) add(area.max_area);
    if (!(bound > 0) || std::isinf(bound)) return std::nullopt;
    return bound;
  }

  void read_regions() {
    std::vector<char> listed(half_edges_.size(), 0);
    for (std::uint32_t e = 0; e < mesh_.edges.size(); ++e) {
      if (!is_edge_[e]) continue;
      const auto h = half_edges_.find(mesh_.edges[e].a, mesh_.edges[e].b);
      listed[*h] = 1;
      if (half_edges_.has_twin(*h)) listed[half_edges_.twin(*h)] = 1;
    }
    std::vector<char> seen(mesh_.triangles.size(), 0);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (seen[t]) continue;
      seen[t] = 1;
      stack.push_back(t);
      while (!stack.empty()) {
        const std::uint32_t now = stack.back();
        stack.pop_back();
        for (std::uint32_t h = 3 * now; h < 3 * now + 3; ++h) {
          if (listed[h] || !half_edges_.has_twin(h)) continue;
          const std::uint32_t beyond = half_edges_.twin(h) / 3;
          if (seen[beyond]) continue;
          seen[beyond] = 1;
          stack.push_back(beyond);
        }
      }
      const auto [a, b, c] = mesh_.triangles[t];
      const Vec2 p = mesh_.vertices[a], q = mesh_.vertices[b], r = mesh_.vertices[c];
      const std::int32_t region = t < mesh_.regions.size() ? mesh_.regions[t] : 0;
      result_.domain.regions.push_back(
          {{(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3}, region, bound_of(region)});
    }
  }

  const Domain& original_;
  const Mesh& mesh_;
  const HalfEdges& half_edges_;
  std::vector<std::size_t> first_;     // per vertex: of its spokes
  std::vector<std::uint32_t> spokes_;  // listed edges
  std::vector<char> is_edge_;          // per listed edge: whether the mesh has it
  std::vector<char> is_border_;        // per listed edge
  std::vector<std::uint32_t> point_;   // per vertex: in result_.domain, kNone if it is no corner
  SimplifiedDomain result_;
};

}  // namespace

SimplifiedDomain simplified_domain(const Domain& original, const Mesh& mesh,
                                   const HalfEdges& half_edges) {
  return Reader(original, mesh, half_edges).read();
}

}  // namespace weft::check
