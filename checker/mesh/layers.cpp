// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "checker/text.h"

namespace weft::check {
namespace {

double distance(Vec2 p, Vec2 q) {
  return std::hypot(q.x - p.x, q.y - p.y);
}

// Of p from the line through a and b.
double distance_to_line(Vec2 p, Vec2 a, Vec2 b) {
  return std::fabs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / distance(a, b);
}

bool ends_layers(const HalfEdges& half_edges, const std::vector<bool>& is_layer, std::uint32_t h) {
  return is_layer[h / 3] && half_edges.has_twin(h) && !is_layer[half_edges.twin(h) / 3];
}

class ColumnJudge {
 public:
  // Of all layers that are like `rows`, which may meet.
  ColumnJudge(const Mesh& mesh, const HalfEdges& half_edges, const LayerRows& rows,
              const std::vector<LayerRows>& layers, const std::vector<bool>& is_layer,
              Findings& findings)
      : mesh_(mesh), findings_(findings) {
    double sum = 0, height = rows.first;
    heights_.push_back(0);
    for (std::uint32_t i = 0; i < rows.rows; ++i, height *= rows.ratio)
      heights_.push_back(sum += height);
    for (const Vec2 p : mesh.vertices)
      rounding_ = std::max({rounding_, std::fabs(p.x), std::fabs(p.y)});
    rounding_ *= 0x1p-44;
    for (const Mesh::Edge& edge : mesh.edges) {
      const bool is_wall = std::any_of(layers.begin(), layers.end(), [&](const LayerRows& other) {
        return other.marker == edge.marker && other.first == rows.first &&
               other.ratio == rows.ratio && other.rows == rows.rows && other.region == rows.region;
      });
      if (!is_wall) continue;
      wall_[edge.a].push_back(edge.b);
      wall_[edge.b].push_back(edge.a);
    }
    for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
      if (!is_layer[h / 3] || mesh.regions[h / 3] != rows.region) continue;
      near_[half_edges.start(h)].insert(half_edges.end(h));
      near_[half_edges.end(h)].insert(half_edges.start(h));
      if (!ends_layers(half_edges, is_layer, h)) continue;
      tips_.insert(half_edges.start(h));
      tips_.insert(half_edges.end(h));
    }
  }

  // Of the region's vertices, those in columns of these rows.
  void add_columns(std::set<std::uint32_t>& found) {
    for (const std::uint32_t tip : tips_) {
      if (wall_.contains(tip)) {  // a point
        found.insert(tip);
        continue;
      }
      // Where rows are equally high and columns equally far apart, diagonals may look like columns.
      std::vector<std::uint32_t> shortest;
      for (const std::uint32_t below : near_.at(tip)) {
        const auto column = column_through(tip, below);
        if (!column) continue;
        found.insert(column->begin(), column->end());
        if (shortest.empty() || length(*column) < length(shortest)) shortest = *column;
      }
      if (!shortest.empty()) judge_thickness(tip, shortest.back());
    }
  }

 private:
  double length(const std::vector<std::uint32_t>& column) const {
    return distance(mesh_.vertices[column.front()], mesh_.vertices[column.back()]);
  }

  // From the tip to the wall.
  std::optional<std::vector<std::uint32_t>> column_through(std::uint32_t tip,
                                                           std::uint32_t below) const {
    const std::size_t top = heights_.size() - 1;
    const Vec2 p = mesh_.vertices[tip], q = mesh_.vertices[below];
    const double all = distance(p, q) * heights_[top] / (heights_[top] - heights_[top - 1]);
    const double length = distance(p, q);
    std::vector<std::uint32_t> column{tip, below};
    for (std::size_t i = top - 1; i-- > 0;) {
      const double way = all * (1 - heights_[i] / heights_[top]) / length;
      const Vec2 at{p.x + way * (q.x - p.x), p.y + way * (q.y - p.y)};
      // What rounding moved `below`, the way multiplies.
      const double tolerance = 1e-9 * all + (1 + way) * rounding_;
      const auto& near = near_.at(column.back());
      const auto next = std::min_element(near.begin(), near.end(), [&](auto u, auto v) {
        return distance(mesh_.vertices[u], at) < distance(mesh_.vertices[v], at);
      });
      if (distance(mesh_.vertices[*next], at) > tolerance) return std::nullopt;
      column.push_back(*next);
    }
    const bool passes_a_tip = std::any_of(column.begin() + 1, column.end(),
                                          [this](std::uint32_t v) { return tips_.contains(v); });
    if (passes_a_tip || !wall_.contains(column.back())) return std::nullopt;
    return column;
  }

  void judge_thickness(std::uint32_t tip, std::uint32_t base) {
    const Vec2 at = mesh_.vertices[tip];
    for (const std::uint32_t along : wall_.at(base)) {
      const double thickness = distance_to_line(at, mesh_.vertices[base], mesh_.vertices[along]);
      if (thickness <= heights_.back() * (1 + 1e-9) + rounding_) continue;
      findings_.add(Rule::kLayers, [&] {
        return say("layers at ", mesh_.vertices[base], " are ", thickness, " thick, they may be ",
                   heights_.back());
      });
    }
  }

  const Mesh& mesh_;
  Findings& findings_;
  std::vector<double> heights_;  // of the rows' ends, from 0 on
  double rounding_ = 0;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> wall_;  // ends of edges
  std::unordered_map<std::uint32_t, std::set<std::uint32_t>> near_;     // along layers' edges
  std::set<std::uint32_t> tips_;
};

}  // namespace

std::vector<bool> judge_layers(const Mesh& mesh, const HalfEdges& half_edges,
                               const ListedEdges& listed, const std::vector<LayerRows>& layers,
                               Findings& findings) {
  std::vector<bool> is_layer(mesh.triangles.size());
  if (layers.empty()) return is_layer;
  const auto region_of = [&](std::uint32_t t) {
    return mesh.regions.empty() ? 0 : mesh.regions[t];
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    is_layer[t] = std::any_of(layers.begin(), layers.end(),
                              [&](const LayerRows& rows) { return rows.region == region_of(t); });
  std::set<std::uint32_t> in_columns;
  for (const LayerRows& rows : layers) {
    for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
      if (mesh.edges[i].marker != rows.marker || !listed.half_edge[i]) continue;
      const std::uint32_t t = *listed.half_edge[i] / 3;
      if (region_of(t) == rows.region) continue;
      findings.add(Rule::kLayers, [&] {
        return say("triangle ", t, " has an edge with marker ", rows.marker,
                   ", but is not of the region ", rows.region, " of its layers");
      });
    }
    if (!mesh.regions.empty())
      ColumnJudge(mesh, half_edges, rows, layers, is_layer, findings).add_columns(in_columns);
  }
  std::set<std::uint32_t> outside;
  for (std::uint32_t h = 0; h < half_edges.size(); ++h)
    if (is_layer[h / 3] && !in_columns.contains(half_edges.start(h)) &&
        outside.insert(half_edges.start(h)).second)
      findings.add(Rule::kLayers, [&] {
        return say("vertex ", half_edges.start(h), " at ", mesh.vertices[half_edges.start(h)],
                   " of layers is in no column of their rows");
      });
  return is_layer;
}

Mesh without_regions_of_layers(const Mesh& mesh, const HalfEdges& half_edges,
                               const ListedEdges& listed, std::vector<bool> is_layer) {
  Mesh result = mesh;
  std::vector<std::uint32_t> reached;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (!is_layer[t]) reached.push_back(t);
  while (!reached.empty()) {
    const std::uint32_t t = reached.back();
    reached.pop_back();
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (!half_edges.has_twin(h) || listed.listed[h]) continue;
      const std::uint32_t beyond = half_edges.twin(h) / 3;
      if (!is_layer[beyond]) continue;
      is_layer[beyond] = false;
      result.regions[beyond] = result.regions[t];
      reached.push_back(beyond);
    }
  }
  return result;
}

ListedEdges with_edges_of_layers(const HalfEdges& half_edges, ListedEdges listed,
                                 const std::vector<bool>& is_layer) {
  for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
    if (!is_layer[h / 3]) continue;
    listed.listed[h] = true;
    if (half_edges.has_twin(h)) listed.listed[half_edges.twin(h)] = true;
  }
  return listed;
}

void add_lines_of_layers(const Mesh& mesh, const HalfEdges& half_edges,
                         const std::vector<bool>& is_layer, SegmentsOfVertices& segments) {
  std::multimap<std::uint32_t, std::uint32_t> line;  // half-edges by their starts
  for (std::uint32_t h = 0; h < half_edges.size(); ++h)
    if (ends_layers(half_edges, is_layer, h)) line.emplace(half_edges.start(h), h);
  // The half-edge that goes straight on from the end of another.
  const auto next_of = [&](std::uint32_t h) -> std::optional<std::uint32_t> {
    const auto [begin, end] = line.equal_range(half_edges.end(h));
    for (auto next = begin; next != end; ++next) {
      const Vec2 a = mesh.vertices[half_edges.start(h)], b = mesh.vertices[half_edges.end(h)],
                 c = mesh.vertices[half_edges.end(next->second)];
      const bool is_ahead = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) > 0;
      if (is_ahead && distance_to_line(c, a, b) <= 1e-6 * distance(b, c)) return next->second;
    }
    return std::nullopt;
  };
  std::set<std::uint32_t> continued;
  for (const auto& [start, h] : line)
    if (const auto next = next_of(h)) continued.insert(*next);
  std::uint32_t segment = 0;
  for (const auto& [vertex, s] : segments) segment = std::max(segment, s + 1);
  for (const auto& [start, first] : line) {
    if (continued.contains(first)) continue;
    segments.emplace_back(start, segment);
    for (std::optional<std::uint32_t> h = first; h; h = next_of(*h))
      segments.emplace_back(half_edges.end(*h), segment);
    ++segment;
  }
  std::sort(segments.begin(), segments.end());
}

}  // namespace weft::check
