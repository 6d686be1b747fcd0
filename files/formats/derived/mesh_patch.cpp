// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "files/base/text.h"
#include "files/formats/derived/mesh_domain.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

using Side = std::pair<std::uint32_t, std::uint32_t>;  // the lower vertex first

Side side_of(std::uint32_t a, std::uint32_t b) {
  return std::minmax(a, b);
}
Point at(std::span<const double> coordinates, std::size_t vertex) {
  return {coordinates[2 * vertex], coordinates[2 * vertex + 1]};
}

// Per vertex: whether a ray from it to the right crosses the segments an odd number of times. A
// line sweeps upward over the vertices, and over the segments that cross it.
std::vector<bool> vertices_inside(const MeshView& mesh, const Domain& polygons) {
  struct Rising {
    Point low, high;
  };
  std::vector<Rising> segments;
  for (const Domain::Segment& segment : polygons.segments) {
    const Point a = polygons.points[segment.a], b = polygons.points[segment.b];
    if (a.y != b.y) segments.push_back(a.y < b.y ? Rising{a, b} : Rising{b, a});
  }
  std::sort(segments.begin(), segments.end(),
            [](const Rising& s, const Rising& t) { return s.low.y < t.low.y; });
  std::vector<std::uint32_t> upward(mesh.vertex_count());
  std::iota(upward.begin(), upward.end(), 0);
  std::sort(upward.begin(), upward.end(), [&](std::uint32_t v, std::uint32_t w) {
    return at(mesh.coordinates, v).y < at(mesh.coordinates, w).y;
  });
  std::vector<bool> inside(upward.size());
  std::vector<Rising> crossed;
  std::size_t next = 0;
  for (const std::uint32_t v : upward) {
    const Point p = at(mesh.coordinates, v);
    for (; next < segments.size() && segments[next].low.y <= p.y; ++next)
      crossed.push_back(segments[next]);
    std::erase_if(crossed, [&](const Rising& s) { return s.high.y <= p.y; });
    inside[v] = std::count_if(crossed.begin(), crossed.end(),
                              [&](const auto& s) {
                                return (s.high.x - s.low.x) * (p.y - s.low.y) >
                                       (s.high.y - s.low.y) * (p.x - s.low.x);
                              }) %
                    2 ==
                1;
  }
  return inside;
}

// Which edges are sides of triangles within, and of others.
class Edges {
 public:
  Edges(const Mesh& mesh, const std::vector<bool>& within)
      : edges_(mesh.view()), beside_(edges_.size()) {
    for (std::size_t side = 0; side < mesh.triangles.size(); ++side)
      beside_[edges_.of_side(side)] |= within[side / 3] ? kWithin : kOther;
  }

  const MeshEdges& all() const { return edges_; }
  bool is_inner(std::size_t e) const { return beside_[e] == kWithin; }
  bool is_outline(std::size_t e) const { return beside_[e] == (kWithin | kOther); }

 private:
  static constexpr std::uint8_t kWithin = 1;
  static constexpr std::uint8_t kOther = 2;

  MeshEdges edges_;
  std::vector<std::uint8_t> beside_;
};

// The triangles within, and their edges on segments: those of the outline have its marker.
Mesh mesh_within(const Mesh& mesh, const std::vector<bool>& within, const Edges& edges,
                 std::int32_t marker) {
  Mesh part;
  part.coordinates = mesh.coordinates;
  part.names = mesh.names;
  for (std::size_t t = 0; t < within.size(); ++t) {
    if (!within[t]) continue;
    part.triangles.insert(part.triangles.end(), &mesh.triangles[3 * t], &mesh.triangles[3 * t] + 3);
    part.regions.push_back(mesh.regions[t]);
  }
  const auto add = [&](std::size_t e, std::int32_t of) {
    part.edges.insert(part.edges.end(), {edges.all().low(e), edges.all().high(e)});
    part.edge_markers.push_back(of);
  };
  for (std::size_t i = 0; i < mesh.edge_markers.size(); ++i)
    if (const std::size_t e = edges.all().of_input_edge(i); edges.is_inner(e))
      add(e, mesh.edge_markers[i]);
  for (std::size_t e = 0; e < edges.all().size(); ++e)
    if (edges.is_outline(e)) add(e, marker);
  return part;
}

std::int32_t unused_marker(const Mesh& mesh) {
  std::int32_t marker = 1;
  const std::set<std::int32_t> used(mesh.edge_markers.begin(), mesh.edge_markers.end());
  while (used.contains(marker) || mesh.names.markers.contains(marker)) ++marker;
  return marker;
}

// Which old vertices the rest has, or nobody has.
std::vector<bool> vertices_that_stay(const Mesh& mesh, const MeshPatch& patch) {
  std::vector<bool> stays(mesh.coordinates.size() / 2, true);
  for (std::size_t t = 0; t < patch.within.size(); ++t)
    for (std::size_t k = 0; patch.within[t] && k < 3; ++k) stays[mesh.triangles[3 * t + k]] = false;
  for (std::size_t t = 0; t < patch.within.size(); ++t)
    for (std::size_t k = 0; !patch.within[t] && k < 3; ++k) stays[mesh.triangles[3 * t + k]] = true;
  return stays;
}

// Puts a patch back, step by step.
class Joiner {
 public:
  Joiner(const Mesh& mesh, const MeshPatch& patch, const MeshView& made)
      : mesh_(mesh),
        patch_(patch),
        made_(made),
        edges_(mesh, patch.within),
        stays_(vertices_that_stay(mesh, patch)) {}

  Result<PatchedMesh> run(const std::function<Point(Point)>& place) {
    number_vertices(place);
    if (auto ok = check_outline(); !ok) return tl::unexpected(ok.error());
    add_triangles();
    add_edges();
    joined_.mesh.names = mesh_.names;
    return std::move(joined_);
  }

 private:
  void number_vertices(const std::function<Point(Point)>& place) {
    std::vector<std::uint32_t> stays_as(made_.vertex_count(), PatchedMesh::kNew);
    for (std::size_t i = 0; i + 1 < made_.input_points.size(); i += 2) {
      const std::uint32_t old = patch_.vertices[made_.input_points[i + 1]];
      if (stays_[old]) stays_as[made_.input_points[i]] = old;
    }
    std::vector<std::uint32_t> added;
    for (std::uint32_t v = 0; v < stays_as.size(); ++v)
      if (stays_as[v] == PatchedMesh::kNew) added.push_back(v);
    number_.resize(stays_.size());
    of_made_ = stays_as;
    auto next = added.begin();
    const auto add = [&](Point p, std::uint32_t old) {
      joined_.mesh.coordinates.insert(joined_.mesh.coordinates.end(), {p.x, p.y});
      joined_.old_vertex.push_back(old);
      return static_cast<std::uint32_t>(joined_.old_vertex.size() - 1);
    };
    const auto add_made = [&] {
      of_made_[*next] = add(place(at(made_.coordinates, *next)), PatchedMesh::kNew);
      ++next;
    };
    for (std::uint32_t v = 0; v < stays_.size(); ++v) {
      if (stays_[v])
        number_[v] = add(at(mesh_.coordinates, v), v);
      else if (next != added.end())
        add_made();
    }
    while (next != added.end()) add_made();
    for (std::size_t v = 0; v < stays_as.size(); ++v)
      if (stays_as[v] != PatchedMesh::kNew) of_made_[v] = number_[stays_as[v]];
  }

  Result<void> check_outline() const {
    std::set<Side> outline;
    for (std::size_t e = 0; e < edges_.all().size(); ++e)
      if (edges_.is_outline(e))
        outline.insert(side_of(number_[edges_.all().low(e)], number_[edges_.all().high(e)]));
    for (std::size_t e = 0; e < made_.edge_count(); ++e)
      if (made_.edge_markers[e] == patch_.outline &&
          outline.erase(side_of(of_made_[made_.edges[2 * e]], of_made_[made_.edges[2 * e + 1]])) ==
              0)
        return fail(ExitCode::kUnreadableInput,
                    "the outline of the patch did not stay: the edge from " +
                        text_of(of_made_[made_.edges[2 * e]]) + " to " +
                        text_of(of_made_[made_.edges[2 * e + 1]]) + " is new");
    if (outline.empty()) return {};
    return fail(ExitCode::kUnreadableInput,
                "the outline of the patch did not stay: the edge from " +
                    text_of(outline.begin()->first) + " to " + text_of(outline.begin()->second) +
                    " is gone");
  }
  std::string text_of(std::uint32_t vertex) const {
    const Point p = at(joined_.mesh.coordinates, vertex);
    return coordinates(p.x, p.y);
  }

  void add_triangles() {
    Mesh& mesh = joined_.mesh;
    for (std::size_t t = 0; t < patch_.within.size(); ++t) {
      if (patch_.within[t]) continue;
      for (std::size_t k = 0; k < 3; ++k)
        mesh.triangles.push_back(number_[mesh_.triangles[3 * t + k]]);
      mesh.regions.push_back(mesh_.regions[t]);
    }
    for (const std::uint32_t v : made_.triangles) mesh.triangles.push_back(of_made_[v]);
    mesh.regions.insert(mesh.regions.end(), made_.regions.begin(), made_.regions.end());
  }

  void add_edges() {
    Mesh& mesh = joined_.mesh;
    std::vector<double> bulges;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::int32_t marker, double bulge) {
      mesh.edges.insert(mesh.edges.end(), {a, b});
      mesh.edge_markers.push_back(marker);
      bulges.push_back(bulge);
    };
    for (std::size_t e = 0; e < mesh_.edge_markers.size(); ++e)
      if (!edges_.is_inner(edges_.all().of_input_edge(e)))
        add(number_[mesh_.edges[2 * e]], number_[mesh_.edges[2 * e + 1]], mesh_.edge_markers[e],
            mesh_.edge_bulges.empty() ? 0 : mesh_.edge_bulges[e]);
    for (std::size_t e = 0; e < made_.edge_count(); ++e)
      if (made_.edge_markers[e] != patch_.outline)
        add(of_made_[made_.edges[2 * e]], of_made_[made_.edges[2 * e + 1]], made_.edge_markers[e],
            e < made_.edge_bulges.size() ? made_.edge_bulges[e] : 0);
    if (std::any_of(bulges.begin(), bulges.end(), [](double bulge) { return bulge != 0; }))
      mesh.edge_bulges = std::move(bulges);
  }

  const Mesh& mesh_;
  const MeshPatch& patch_;
  const MeshView& made_;
  const Edges edges_;                   // of the old mesh
  const std::vector<bool> stays_;       // per old vertex
  std::vector<std::uint32_t> number_;   // the new one, of old vertices that stay
  std::vector<std::uint32_t> of_made_;  // the new number of each vertex of the patch
  PatchedMesh joined_;
};

// Finds the triangle around a point among those within, by the cells of a grid.
class Locator {
 public:
  Locator(const Mesh& mesh, const std::vector<bool>& within) : mesh_(mesh) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < within.size(); ++t)
      for (std::size_t k = 0; within[t] && k < 3; ++k, ++count) {
        const Point p = at(mesh.coordinates, mesh.triangles[3 * t + k]);
        low_ = count == 0 ? p : Point{std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = count == 0 ? p : Point{std::max(high_.x, p.x), std::max(high_.y, p.y)};
      }
    cells_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(count) / 3)) + 1;
    triangles_.resize(cells_ * cells_);
    for (std::size_t t = 0; t < within.size(); ++t) {
      if (!within[t]) continue;
      std::array<std::size_t, 2> x{cells_, 0}, y{cells_, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        const Point p = at(mesh.coordinates, mesh.triangles[3 * t + k]);
        const auto [i, j] = cell_of(p);
        x = {std::min(x[0], i), std::max(x[1], i)};
        y = {std::min(y[0], j), std::max(y[1], j)};
      }
      for (std::size_t j = y[0]; j <= y[1]; ++j)
        for (std::size_t i = x[0]; i <= x[1]; ++i) triangles_[j * cells_ + i].push_back(t);
    }
  }

  // Weights of its corners; those of a triangle nearly around p are cut to 0 and 1.
  struct Found {
    std::size_t triangle = 0;
    std::array<double, 3> weight{};
  };
  Found find(Point p) const {
    const auto [i, j] = cell_of(p);
    Found best;
    double inmost = -std::numeric_limits<double>::infinity();
    for (std::size_t ring = 0; ring < cells_; ++ring) {
      for (std::size_t y = j - std::min(j, ring); y <= std::min(j + ring, cells_ - 1); ++y)
        for (std::size_t x = i - std::min(i, ring); x <= std::min(i + ring, cells_ - 1); ++x)
          for (const std::size_t t : triangles_[y * cells_ + x]) {
            const std::array<double, 3> weight = weights(t, p);
            const double least = *std::min_element(weight.begin(), weight.end());
            if (least > inmost) best = {t, weight}, inmost = least;
          }
      if (inmost > -std::numeric_limits<double>::infinity()) break;
    }
    double sum = 0;
    for (double& weight : best.weight) sum += weight = std::max(weight, 0.0);
    for (double& weight : best.weight) weight /= sum;
    return best;
  }

 private:
  std::array<std::size_t, 2> cell_of(Point p) const {
    const auto cell = [&](double x, double low, double high) {
      const double width = high - low;  // finite and not 0, or there is one cell that counts
      const double share = width > 0 && std::isfinite(width) ? (x - low) / width : 0;
      return static_cast<std::size_t>(
          std::clamp(share * static_cast<double>(cells_), 0.0, static_cast<double>(cells_ - 1)));
    };
    return {cell(p.x, low_.x, high_.x), cell(p.y, low_.y, high_.y)};
  }
  std::array<double, 3> weights(std::size_t t, Point p) const {
    std::array<Point, 3> corner;
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = at(mesh_.coordinates, mesh_.triangles[3 * t + k]);
    const auto area = [](Point a, Point b, Point c) {
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const double whole = area(corner[0], corner[1], corner[2]);
    return {area(p, corner[1], corner[2]) / whole, area(corner[0], p, corner[2]) / whole,
            area(corner[0], corner[1], p) / whole};
  }

  const Mesh& mesh_;
  Point low_, high_;
  std::size_t cells_ = 1;  // per row and per column
  std::vector<std::vector<std::size_t>> triangles_;
};

}  // namespace

std::vector<bool> triangles_within(const MeshView& mesh, const Domain& polygons) {
  const std::vector<bool> inside = vertices_inside(mesh, polygons);
  std::vector<bool> within(mesh.triangle_count());
  for (std::size_t t = 0; t < within.size(); ++t)
    within[t] = inside[mesh.triangles[3 * t]] && inside[mesh.triangles[3 * t + 1]] &&
                inside[mesh.triangles[3 * t + 2]];
  return within;
}

Result<MeshPatch> cut_patch(const std::string& name, const Mesh& mesh, std::vector<bool> within) {
  const auto count = static_cast<std::size_t>(std::count(within.begin(), within.end(), true));
  if (count == 0 || count == within.size())
    return fail(ExitCode::kUsage, name + ": " +
                                      (count == 0 ? "no triangle is" : "all triangles are") +
                                      " within the polygon");
  MeshPatch patch{.outline = unused_marker(mesh), .within = std::move(within)};
  const Edges edges(mesh, patch.within);
  patch.domain = domain_of_mesh(name, mesh_within(mesh, patch.within, edges, patch.outline).view());
  std::map<std::pair<double, double>, std::uint32_t> vertex_at;
  for (std::size_t e = 0; e < edges.all().size(); ++e) {
    if (!edges.is_outline(e)) continue;
    ++patch.sides;
    for (const std::uint32_t v : {edges.all().low(e), edges.all().high(e)}) {
      const Point p = at(mesh.coordinates, v);
      const auto [found, is_new] = vertex_at.insert({{p.x, p.y}, v});
      if (!is_new && found->second != v)
        return fail(ExitCode::kUnreadableInput,
                    name + ": vertices " + std::to_string(found->second) + " and " +
                        std::to_string(v) + " are both at " + coordinates(p.x, p.y));
    }
  }
  for (std::size_t v = 0; v < mesh.coordinates.size() / 2; ++v) {
    const Point p = at(mesh.coordinates, v);
    vertex_at.insert({{p.x, p.y}, static_cast<std::uint32_t>(v)});
  }
  for (const Point p : patch.domain.points) patch.vertices.push_back(vertex_at.at({p.x, p.y}));
  return patch;
}

Result<PatchedMesh> put_back(const Mesh& mesh, const MeshPatch& patch, const MeshView& made,
                             const std::function<Point(Point)>& place) {
  return Joiner(mesh, patch, made).run(place);
}

std::vector<double> PatchedMesh::carried(const Mesh& old, const MeshPatch& patch,
                                         const std::vector<double>& values) const {
  const Locator locator(old, patch.within);
  std::vector<double> result(old_vertex.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (old_vertex[v] != kNew) {
      result[v] = values[old_vertex[v]];
      continue;
    }
    const auto [triangle, weight] = locator.find(at(mesh.coordinates, v));
    for (std::size_t k = 0; k < 3; ++k)
      result[v] += weight[k] * values[old.triangles[3 * triangle + k]];
  }
  return result;
}

}  // namespace weft::files
