// SPDX-License-Identifier: Apache-2.0
#include "checker/models/model_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "checker/edges/half_edges.h"
#include "checker/report.h"

namespace weft::check {
namespace {

constexpr double kGravity = 9.81;                                        // m/s^2
constexpr double kMetresPerDegree = 6371008.8 * std::numbers::pi / 180;  // on the mean sphere

constexpr Grade kNone = Grade::kNone, kAdvice = Grade::kAdvice, kFault = Grade::kFault;

struct RuleRow {
  std::string_view name;
  std::array<Grade, 4> grades;  // by model
};

constexpr std::array<RuleRow, kModelRules> kRows = {{
    //                     ADCIRC   SCHISM   TELEMAC  Delft3D
    {"conformity", {kFault, kFault, kFault, kFault}},
    {"idle-vertex", {kFault, kFault, kFault, kAdvice}},
    {"pinched-vertex", {kFault, kFault, kFault, kNone}},
    {"one-part", {kAdvice, kAdvice, kAdvice, kNone}},
    {"open-ring", {kFault, kFault, kNone, kNone}},
    {"open-island", {kAdvice, kAdvice, kNone, kNone}},
    {"short-open", {kFault, kFault, kAdvice, kNone}},
    {"valence", {kAdvice, kAdvice, kNone, kNone}},
    {"channel", {kAdvice, kAdvice, kAdvice, kNone}},
    {"dead-corner", {kAdvice, kNone, kAdvice, kNone}},
    {"orthogonality", {kNone, kNone, kNone, kFault}},
    {"short-link", {kNone, kNone, kNone, kAdvice}},
}};

Vec2 middle(Vec2 p, Vec2 q) {
  return {(p.x + q.x) / 2, (p.y + q.y) / 2};
}
Vec2 minus(Vec2 p, Vec2 q) {
  return {p.x - q.x, p.y - q.y};
}
double dot(Vec2 p, Vec2 q) {
  return p.x * q.x + p.y * q.y;
}
double cross(Vec2 p, Vec2 q) {
  return p.x * q.y - p.y * q.x;
}
double length(Vec2 p) {
  return std::hypot(p.x, p.y);
}

// The centre of a cell, as Delft3D-FM has it: that of the circle through its corners if the cell
// contains it, otherwise where the line to there from the mean of the corners leaves the cell.
Vec2 cell_center(const std::array<Vec2, 3>& corner) {
  std::size_t at = 0;  // the largest angle
  for (std::size_t i = 1; i < 3; ++i)
    if (length(minus(corner[(i + 1) % 3], corner[(i + 2) % 3])) >
        length(minus(corner[(at + 1) % 3], corner[(at + 2) % 3])))
      at = i;
  const Vec2 b = minus(corner[(at + 1) % 3], corner[at]);
  const Vec2 c = minus(corner[(at + 2) % 3], corner[at]);
  const double scale = 2 * cross(b, c);
  const Vec2 circle = {(dot(b, b) * c.y - dot(c, c) * b.y) / scale,
                       (dot(c, c) * b.x - dot(b, b) * c.x) / scale};
  Vec2 center = circle;
  if (dot(b, c) < 0) {
    const Vec2 mean = {(b.x + c.x) / 3, (b.y + c.y) / 3};
    const Vec2 side = minus(c, b), way = minus(circle, mean);
    const double along = cross(minus(b, mean), side) / cross(way, side);
    center = {mean.x + along * way.x, mean.y + along * way.y};
  }
  return {corner[at].x + center.x, corner[at].y + center.y};
}

class Judge {
 public:
  explicit Judge(const ModelInput& input)
      : input_(input), mesh_(input.mesh), edges_(input.mesh), marker_(edges_.size(), 0) {}

  ModelReport run() {
    Findings conformity(0);
    if (edges_.judge_conformity(conformity)) {
      for (const Mesh::Edge& edge : mesh_.edges) {
        const auto h = edges_.find(edge.a, edge.b);
        if (!h) continue;
        marker_[*h] = edge.marker;
        if (edges_.has_twin(*h)) marker_[edges_.twin(*h)] = edge.marker;
      }
      judge_vertices();
      judge_parts();
      judge_rings();
      judge_triangles();
      judge_edges();
    } else {
      report_.totals[static_cast<std::size_t>(ModelRule::kConformity)] =
          conformity.total(Rule::kConformity);
    }
    std::stable_sort(report_.findings.begin(), report_.findings.end(),
                     [](const auto& a, const auto& b) { return a.rule < b.rule; });
    return std::move(report_);
  }

 private:
  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  bool is_border(std::uint32_t h) const { return !edges_.has_twin(h); }
  bool is_open(std::uint32_t h) const {
    return is_border(h) && std::find(input_.open_markers.begin(), input_.open_markers.end(),
                                     marker_[h]) != input_.open_markers.end();
  }
  Vec2 at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  Vec2 middle_of(std::uint32_t h) const { return middle(at(edges_.start(h)), at(edges_.end(h))); }

  void add(ModelRule rule, Vec2 place, double measure = 0) {
    if (report_.totals[static_cast<std::size_t>(rule)]++ < ModelReport::kListed)
      report_.findings.push_back({rule, place, measure});
  }

  void judge_vertices() {
    std::vector<std::uint32_t> triangles(mesh_.vertices.size(), 0);
    std::vector<std::uint32_t> borders(mesh_.vertices.size(), 0);  // that start here
    on_land_.assign(mesh_.vertices.size(), false);
    for (std::uint32_t h = 0; h < edges_.size(); ++h) {
      ++triangles[edges_.start(h)];
      if (!is_border(h)) continue;
      ++borders[edges_.start(h)];
      if (!is_open(h)) on_land_[edges_.start(h)] = on_land_[edges_.end(h)] = true;
    }
    for (std::uint32_t v = 0; v < triangles.size(); ++v) {
      if (triangles[v] == 0) add(ModelRule::kIdleVertex, at(v));
      if (borders[v] > 1) add(ModelRule::kPinchedVertex, at(v));
      if (triangles[v] > kMaxValence) add(ModelRule::kValence, at(v), triangles[v]);
      report_.max_valence = std::max(report_.max_valence, triangles[v]);
    }
  }

  // One finding for each part but the largest.
  void judge_parts() {
    struct Part {
      std::uint32_t first = 0;
      std::uint32_t triangles = 0;
    };
    std::vector<Part> parts;
    std::vector<bool> seen(mesh_.triangles.size(), false);
    std::vector<std::uint32_t> open;
    for (std::uint32_t first = 0; first < seen.size(); ++first) {
      if (seen[first]) continue;
      parts.push_back({first, 0});
      seen[first] = true;
      open.assign(1, first);
      while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        ++parts.back().triangles;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
          if (is_border(h) || seen[edges_.twin(h) / 3]) continue;
          seen[edges_.twin(h) / 3] = true;
          open.push_back(edges_.twin(h) / 3);
        }
      }
    }
    report_.parts = static_cast<std::uint32_t>(parts.size());
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Part& a, const Part& b) { return a.triangles < b.triangles; });
    for (auto part = parts.begin(); part != parts.end(); ++part)
      if (part != largest) add(ModelRule::kOnePart, middle_of(3 * part->first), part->triangles);
  }

  void judge_rings() {
    std::vector<bool> seen(edges_.size(), false);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (!is_border(first) || seen[first]) continue;
      ring.clear();
      for (std::uint32_t h = first; !seen[h];) {
        seen[h] = true;
        ring.push_back(h);
        h = next(h);
        while (!is_border(h)) h = next(edges_.twin(h));
      }
      judge_ring(ring);
    }
  }

  void judge_ring(const std::vector<std::uint32_t>& ring) {
    const std::size_t n = ring.size();
    const auto continues = [&](std::size_t i) {  // the piece of the border before
      return marker_[ring[i % n]] == marker_[ring[(i + n - 1) % n]];
    };
    std::size_t start = 0;
    while (start < n && continues(start)) ++start;
    if (start == n) {
      if (is_open(ring[0])) add(ModelRule::kOpenRing, middle_of(ring[0]));
      return;
    }
    double area = 0;
    const Vec2 origin = at(edges_.start(ring[0]));
    for (const std::uint32_t h : ring)
      area += cross(minus(at(edges_.start(h)), origin), minus(at(edges_.end(h)), origin));
    for (std::size_t i = start; i < start + n;) {
      const std::uint32_t h = ring[i % n];
      std::size_t count = 1;
      while (count < n && continues(i + count)) ++count;
      i += count;
      if (!is_open(h)) continue;
      if (count < 2) add(ModelRule::kShortOpen, middle_of(h));
      if (area < 0) add(ModelRule::kOpenIsland, middle_of(h));
    }
  }

  int borders_of(std::uint32_t t) const {
    return is_border(3 * t) + is_border(3 * t + 1) + is_border(3 * t + 2);
  }

  void judge_triangles() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      int land = 0;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) land += is_border(h) && !is_open(h);
      if (land < 2) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      add(ModelRule::kDeadCorner,
          {(at(a).x + at(b).x + at(c).x) / 3, (at(a).y + at(b).y + at(c).y) / 3});
    }
  }

  // Metres from `origin`.
  Vec2 flat(Vec2 p, Vec2 origin) const {
    const Vec2 from = minus(p, origin);
    if (!input_.lonlat) return from;
    return {from.x * kMetresPerDegree * std::cos(origin.y * std::numbers::pi / 180),
            from.y * kMetresPerDegree};
  }

  void judge_edges() {
    for (std::uint32_t h = 0; h < edges_.size(); ++h) {
      if (edges_.has_twin(h) && edges_.twin(h) < h) continue;
      judge_length(h);
      if (!edges_.has_twin(h)) continue;
      if (on_land_[edges_.start(h)] && on_land_[edges_.end(h)] && borders_of(h / 3) < 2 &&
          borders_of(edges_.twin(h) / 3) < 2)
        add(ModelRule::kChannel, middle_of(h));
      judge_link(h);
    }
  }

  void judge_length(std::uint32_t h) {
    const std::uint32_t a = edges_.start(h), b = edges_.end(h);
    const double metres = length(flat(at(b), at(a)));
    if (!report_.shortest_edge || metres < *report_.shortest_edge) report_.shortest_edge = metres;
    if (input_.depths.empty()) return;
    const double depth = std::max(input_.depths[a], input_.depths[b]);
    if (!(depth > 0)) return;
    const double seconds = metres / std::sqrt(kGravity * depth);
    if (!report_.time_step || seconds < report_.time_step->seconds)
      report_.time_step = {seconds, middle_of(h), metres, depth};
  }

  void judge_link(std::uint32_t h) {
    const Vec2 origin = middle_of(h);
    std::array<Vec2, 2> center;
    double side = 0;  // of squares of the cells' areas, their mean
    for (const std::size_t i : {0, 1}) {
      const auto& triangle = mesh_.triangles[(i == 0 ? h : edges_.twin(h)) / 3];
      std::array<Vec2, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) corner[k] = flat(at(triangle[k]), origin);
      center[i] = cell_center(corner);
      const double area = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0])) / 2;
      side += std::sqrt(std::abs(area)) / 2;
    }
    const Vec2 link = minus(center[1], center[0]);
    if (const double ratio = length(link) / side; !(ratio >= kMinLink))
      add(ModelRule::kShortLink, origin, ratio);
    const Vec2 edge = minus(flat(at(edges_.end(h)), origin), flat(at(edges_.start(h)), origin));
    const double lengths = length(link) * length(edge);
    const double cosine = lengths > 0 ? std::abs(dot(link, edge)) / lengths : 0;
    report_.max_cosine = std::max(report_.max_cosine, cosine);
    if (cosine > kMaxCosine) add(ModelRule::kOrthogonality, origin, cosine);
  }

  const ModelInput& input_;
  const Mesh& mesh_;
  HalfEdges edges_;
  std::vector<std::int32_t> marker_;  // by half-edge; 0: none
  std::vector<bool> on_land_;         // by vertex
  ModelReport report_;
};

}  // namespace

Grade grade(Model model, ModelRule rule) {
  return kRows[static_cast<std::size_t>(rule)].grades[static_cast<std::size_t>(model)];
}

std::string_view model_rule_name(ModelRule rule) {
  return kRows[static_cast<std::size_t>(rule)].name;
}

ModelReport judge_for_models(const ModelInput& input) {
  return Judge(input).run();
}

}  // namespace weft::check
