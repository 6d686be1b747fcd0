// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/stitch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "files/base/text.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/overlapping_mesh.h"
#include "files/formats/domain.h"

namespace weft::files {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Point at(const Mesh& mesh, std::uint32_t vertex) {
  return {mesh.coordinates[2 * std::size_t{vertex}], mesh.coordinates[2 * std::size_t{vertex} + 1]};
}
double distance(Point a, Point b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

// The distance from p to the inside of a segment; infinite if the nearest place is an end.
double distance_inside(Point p, Point a, Point b) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double share = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
  if (!(share > 0 && share < 1)) return std::numeric_limits<double>::infinity();
  return distance(p, {a.x + share * x, a.y + share * y});
}

// The edges of the boundary, in the order of their vertices, and these vertices.
struct Outline {
  Outline(const Mesh& mesh, const MeshEdges& all) {
    for (std::size_t e = 0; e < all.size(); ++e)
      if (all.on_boundary(e)) edges.push_back({all.low(e), all.high(e)});
    for (const auto& [a, b] : edges) vertices.insert(vertices.end(), {a, b});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t v : vertices) places.push_back(at(mesh, v));
  }

  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> vertices;
  std::vector<Point> places;  // of these
};

// Finds what of an outline is near a point, by the cells of a grid.
class Near {
 public:
  // `reach` is the farthest that is near.
  Near(const Mesh& mesh, const Outline& outline, double reach)
      : mesh_(mesh), outline_(outline), reach_(reach) {
    double length = 0;
    for (const auto& [a, b] : outline.edges) length += distance(at(mesh, a), at(mesh, b));
    cell_ = std::max(length / static_cast<double>(std::max<std::size_t>(outline.edges.size(), 1)),
                     4 * reach);
    if (!outline.places.empty()) origin_ = outline.places[0];
    for (std::uint32_t i = 0; i < outline.vertices.size(); ++i)
      vertices_[cell_of(outline.places[i])].push_back(i);
    for (std::uint32_t e = 0; e < outline.edges.size(); ++e) add_edge(e);
  }

  // The vertex nearest to p, and another that is near, too; kNone if there is none.
  std::array<std::uint32_t, 2> vertices(Point p) const {
    std::array<std::uint32_t, 2> found{kNone, kNone};
    double nearest = std::numeric_limits<double>::infinity();
    for_cells(p, [&](const Cell& cell) {
      const auto entry = vertices_.find(cell);
      if (entry == vertices_.end()) return;
      for (const std::uint32_t i : entry->second) {
        const double d = distance(p, outline_.places[i]);
        if (!(d <= reach_)) continue;
        if (d < nearest) {
          found = {outline_.vertices[i], found[0]};
          nearest = d;
        } else {
          found[1] = outline_.vertices[i];
        }
      }
    });
    return found;
  }

  // An edge that p lies on, and at whose ends it is not; kNone if there is none.
  std::uint32_t edge_through(Point p) const {
    std::uint32_t found = kNone;
    for_cells(p, [&](const Cell& cell) {
      const auto entry = edges_.find(cell);
      if (entry == edges_.end()) return;
      for (const std::uint32_t e : entry->second) {
        const auto& [a, b] = outline_.edges[e];
        if (distance_inside(p, at(mesh_, a), at(mesh_, b)) <= reach_) found = std::min(found, e);
      }
    });
    return found;
  }

 private:
  using Cell = std::pair<std::int64_t, std::int64_t>;

  Cell cell_of(Point p) const {
    constexpr double kMax = 0x1p61;  // cells; farther points are near nothing
    const auto count = [&](double x) {
      const double cells = std::floor(x / cell_);  // NaN if both are too large or too small
      return static_cast<std::int64_t>(std::fabs(cells) < kMax ? cells : kMax);
    };
    return {count(p.x - origin_.x), count(p.y - origin_.y)};
  }
  // Those whose points may be within reach of p.
  template <class F>
  void for_cells(Point p, F&& act) const {
    const auto [i, j] = cell_of(p);
    for (std::int64_t x = i - 1; x <= i + 1; ++x)
      for (std::int64_t y = j - 1; y <= j + 1; ++y) act(Cell{x, y});
  }
  // Into every cell that one of its points, a cell apart, lies in.
  void add_edge(std::uint32_t e) {
    const Point a = at(mesh_, outline_.edges[e][0]), b = at(mesh_, outline_.edges[e][1]);
    const double steps = std::ceil(distance(a, b) / cell_);
    for (double step = 0; step <= steps; ++step) {
      const double share = steps > 0 ? step / steps : 0;
      std::vector<std::uint32_t>& in =
          edges_[cell_of({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)})];
      if (in.empty() || in.back() != e) in.push_back(e);
    }
  }

  const Mesh& mesh_;
  const Outline& outline_;
  const double reach_;
  double cell_ = 1;
  Point origin_;
  std::map<Cell, std::vector<std::uint32_t>> vertices_;  // by their indices in the outline
  std::map<Cell, std::vector<std::uint32_t>> edges_;
};

double extent_of(const Mesh& first, const Mesh& second) {
  double low[2], high[2];
  std::fill_n(low, 2, std::numeric_limits<double>::infinity());
  std::fill_n(high, 2, -std::numeric_limits<double>::infinity());
  for (const Mesh* mesh : {&first, &second})
    for (std::size_t i = 0; i < mesh->coordinates.size(); ++i) {
      low[i % 2] = std::min(low[i % 2], mesh->coordinates[i]);
      high[i % 2] = std::max(high[i % 2], mesh->coordinates[i]);
    }
  return std::max(high[0] - low[0], high[1] - low[1]);
}

// Joins two meshes, step by step.
class Stitcher {
 public:
  Stitcher(const Mesh& first, const Mesh& second, const StitchOptions& options)
      : first_(first),
        second_(second),
        names_(options.names),
        tolerance_(options.tolerance > 0 ? options.tolerance : 1e-9 * extent_of(first, second)),
        first_edges_(first.view()),
        second_edges_(second.view()),
        first_outline_(first, first_edges_),
        second_outline_(second, second_edges_) {}

  Result<StitchedMesh> run() {
    if (auto ok = match_vertices(); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_no_vertex_on_an_edge(); !ok) return tl::unexpected(ok.error());
    add_vertices();
    add_triangles();
    add_edges();
    if (domain_of_overlapping("", made_.mesh.view()))
      return refuse(names_[0] + " and " + names_[1] + " overlap");
    return std::move(made_);
  }

 private:
  static tl::unexpected<Error> refuse(std::string message) {
    return fail(ExitCode::kUnreadableInput, std::move(message));
  }
  std::string vertex_text(int which, std::uint32_t vertex) const {
    const Point p = at(which == 0 ? first_ : second_, vertex);
    return names_[static_cast<std::size_t>(which)] + ": vertex " + std::to_string(vertex) + " at " +
           coordinates(p.x, p.y);
  }

  Result<void> match_vertices() {
    const Near near(first_, first_outline_, tolerance_);
    made_.vertices.assign(second_.coordinates.size() / 2, kNone);
    std::map<std::uint32_t, std::uint32_t> taken;  // vertices of the first
    for (std::size_t i = 0; i < second_outline_.vertices.size(); ++i) {
      const std::uint32_t v = second_outline_.vertices[i];
      const auto [match, other] = near.vertices(second_outline_.places[i]);
      if (match == kNone) continue;
      if (other != kNone)
        return refuse(vertex_text(1, v) + " lies within " + shortest(tolerance_) +
                      " of two vertices of " + names_[0] + ", " + std::to_string(match) + " and " +
                      std::to_string(other));
      const auto [entry, is_new] = taken.insert({match, v});
      if (!is_new)
        return refuse(vertex_text(0, match) + " lies within " + shortest(tolerance_) +
                      " of two vertices of " + names_[1] + ", " + std::to_string(entry->second) +
                      " and " + std::to_string(v));
      made_.vertices[v] = match;
      ++made_.common_vertices;
    }
    if (made_.common_vertices > 0) return {};
    return refuse(names_[0] + " and " + names_[1] +
                  " have no vertex of their outlines in common, within " + shortest(tolerance_));
  }

  Result<void> check_no_vertex_on_an_edge() const {
    const Near near_first(first_, first_outline_, tolerance_);
    for (std::size_t i = 0; i < second_outline_.vertices.size(); ++i) {
      const std::uint32_t v = second_outline_.vertices[i];
      if (made_.vertices[v] != kNone) continue;
      const std::uint32_t e = near_first.edge_through(second_outline_.places[i]);
      if (e != kNone)
        return refuse(vertex_text(1, v) + " lies on an edge of " + names_[0] + ", " +
                      edge_text(first_outline_.edges[e]) + ", where that has no vertex");
    }
    const Near near_second(second_, second_outline_, tolerance_);
    std::vector<bool> is_common(first_.coordinates.size() / 2, false);
    for (const std::uint32_t match : made_.vertices)
      if (match != kNone) is_common[match] = true;
    for (std::size_t i = 0; i < first_outline_.vertices.size(); ++i) {
      const std::uint32_t v = first_outline_.vertices[i];
      if (is_common[v]) continue;
      const std::uint32_t e = near_second.edge_through(first_outline_.places[i]);
      if (e != kNone)
        return refuse(vertex_text(0, v) + " lies on an edge of " + names_[1] + ", " +
                      edge_text(second_outline_.edges[e]) + ", where that has no vertex");
    }
    return {};
  }
  static std::string edge_text(const std::array<std::uint32_t, 2>& edge) {
    return std::to_string(edge[0]) + " to " + std::to_string(edge[1]);
  }

  void add_vertices() {
    Mesh& mesh = made_.mesh;
    mesh.coordinates = first_.coordinates;
    for (std::uint32_t v = 0; v < made_.vertices.size(); ++v) {
      if (made_.vertices[v] != kNone) continue;
      made_.vertices[v] = static_cast<std::uint32_t>(mesh.coordinates.size() / 2);
      const Point p = at(second_, v);
      mesh.coordinates.insert(mesh.coordinates.end(), {p.x, p.y});
    }
  }

  void add_triangles() {
    Mesh& mesh = made_.mesh;
    mesh.triangles = first_.triangles;
    mesh.regions = first_.regions;
    for (const std::uint32_t v : second_.triangles) mesh.triangles.push_back(made_.vertices[v]);
    const auto number = numbers_of_second(NameKind::kRegion, first_.regions, second_.regions);
    for (const std::int32_t region : second_.regions) mesh.regions.push_back(number.at(region));
  }

  void add_edges() {
    Mesh& mesh = made_.mesh;
    mesh.edges = first_.edges;
    mesh.edge_markers = first_.edge_markers;
    std::set<std::pair<std::uint32_t, std::uint32_t>> listed, boundary;
    for (std::size_t i = 0; i + 1 < mesh.edges.size(); i += 2)
      listed.insert(std::minmax(mesh.edges[i], mesh.edges[i + 1]));
    for (const auto& [a, b] : first_outline_.edges) boundary.insert({a, b});
    for (const auto& [a, b] : second_outline_.edges)
      if (boundary.contains(std::minmax(made_.vertices[a], made_.vertices[b])))
        ++made_.common_edges;
    const auto number =
        numbers_of_second(NameKind::kMarker, first_.edge_markers, second_.edge_markers);
    std::vector<double> bulges = first_.edge_bulges;
    bulges.resize(first_.edge_markers.size(), 0);
    for (std::size_t e = 0; e < second_.edge_markers.size(); ++e) {
      const std::uint32_t a = made_.vertices[second_.edges[2 * e]];
      const std::uint32_t b = made_.vertices[second_.edges[2 * e + 1]];
      if (listed.contains(std::minmax(a, b))) continue;
      mesh.edges.insert(mesh.edges.end(), {a, b});
      mesh.edge_markers.push_back(number.at(second_.edge_markers[e]));
      bulges.push_back(second_.edge_bulges.empty() ? 0 : second_.edge_bulges[e]);
    }
    if (std::any_of(bulges.begin(), bulges.end(), [](double bulge) { return bulge != 0; }))
      mesh.edge_bulges = std::move(bulges);
  }

  // The new number of each number of the second mesh; adds the names of both to the new mesh.
  std::map<std::int32_t, std::int32_t> numbers_of_second(NameKind kind,
                                                         const std::vector<std::int32_t>& first,
                                                         const std::vector<std::int32_t>& second) {
    NameTable& names = made_.mesh.names.table(kind);
    names = first_.names.table(kind);
    const NameTable& more = second_.names.table(kind);
    std::set<std::int32_t> used(first.begin(), first.end());
    used.insert(second.begin(), second.end());
    for (const NameTable* table : {&std::as_const(names), &more})
      for (const auto& [id, name] : *table) used.insert(id);
    std::set<std::int32_t> all(second.begin(), second.end());
    for (const auto& [id, name] : more) all.insert(id);
    std::map<std::int32_t, std::int32_t> number;
    std::int32_t next = 1;
    for (const std::int32_t id : all) {
      const auto name = more.find(id);
      number[id] = id;
      if (name == more.end()) continue;
      const auto same = std::find_if(names.begin(), names.end(), [&](const auto& entry) {
        return entry.second == name->second;
      });
      if (same != names.end()) {
        number[id] = same->first;
      } else {
        if (names.contains(id)) {
          while (used.contains(next)) ++next;
          used.insert(next);
          number[id] = next;
        }
        names[number[id]] = name->second;
      }
    }
    return number;
  }

  const Mesh& first_;
  const Mesh& second_;
  const std::array<std::string, 2>& names_;
  const double tolerance_;
  const MeshEdges first_edges_;
  const MeshEdges second_edges_;
  const Outline first_outline_;
  const Outline second_outline_;
  StitchedMesh made_;
};

}  // namespace

Result<StitchedMesh> stitch(const Mesh& first, const Mesh& second, const StitchOptions& options) {
  return Stitcher(first, second, options).run();
}

}  // namespace weft::files
