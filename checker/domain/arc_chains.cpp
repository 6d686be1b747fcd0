// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/arc_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <unordered_map>
#include <utility>

#include "checker/domain/arc_gaps.h"
#include "checker/domain/arc_path.h"
#include "checker/domain/mesh_points.h"
#include "checker/domain/segment_steps.h"
#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/circular_arc.h"
#include "checker/geometry/sum.h"

namespace weft::check {
namespace {

class ChainFinder {
 public:
  ChainFinder(const Domain& domain, const Mesh& mesh, const ListedEdges& listed)
      : domain_(domain), mesh_(mesh), listed_(listed), points_(domain.points) {
    const double extent = extent_of(domain);
    merging_ = std::max(domain.snap, 0x1p-40 * extent);
    tight_ = kOffArc * extent;
    result_.tolerance = std::max(tight_, kMaxBend * merging_ * (1 + kMergingSlack));
    find_arcs();
    find_junctions();
  }

  ArcChains find() {
    std::vector<ArcStep> steps = steps_along_arcs();
    leave_to_the_flattest(steps);
    std::sort(steps.begin(), steps.end(), [](const ArcStep& s, const ArcStep& t) {
      return std::pair{s.arc, s.edge} < std::pair{t.arc, t.edge};
    });
    for (std::uint32_t k = 0; k < arcs_.size(); ++k) {
      const auto begin = std::partition_point(steps.begin(), steps.end(),
                                              [&](const ArcStep& s) { return s.arc < k; });
      const auto end =
          std::partition_point(begin, steps.end(), [&](const ArcStep& s) { return s.arc == k; });
      follow(arcs_[k], {begin, end});
    }
    cut_gaps(domain_, tight_, points_, pieces_);
    write_straight_domain();
    return std::move(result_);
  }

 private:
  // From its lexicographically smaller end.
  struct PlacedArc {
    std::uint32_t segment;
    std::uint32_t from, to;                       // points
    std::optional<std::uint32_t> at_from, at_to;  // mesh vertices
    bool is_merged = false;                       // whether a vertex is not where its end is
  };

  void find_arcs() {
    const std::vector<double> bulges = bulges_of(domain_);
    result_.curves.resize(bulges.size());
    NearFeatures near;
    near.merging_distance = merging_;
    near.may_move.assign(domain_.points.size(), 0);
    for (std::uint32_t s = 0; s < bulges.size(); ++s) {
      if (bulges[s] == 0) continue;
      auto [from, to] = domain_.segments[s];
      const bool swap = lexicographically_less(domain_.points[to], domain_.points[from]);
      if (swap) std::swap(from, to);
      near.may_move[from] = near.may_move[to] = 1;
      const double bulge = swap ? -bulges[s] : bulges[s];
      result_.curves[s].emplace(domain_.points[from], domain_.points[to], bulge);
      arcs_.push_back({s, from, to, {}, {}});
    }
    const auto images = images_of_points(domain_, near, mesh_);
    for (PlacedArc& arc : arcs_) {
      arc.at_from = images[arc.from];
      arc.at_to = images[arc.to];
      for (const std::uint32_t end : {arc.from, arc.to})
        arc.is_merged = arc.is_merged ||
                        (images[end] && !(mesh_.vertices[*images[end]] == domain_.points[end]));
    }
  }

  void find_junctions() {
    std::vector<std::uint32_t> degree(mesh_.vertices.size(), 0);
    for (std::size_t i = 0; i < mesh_.edges.size(); ++i) {
      if (!listed_.half_edge[i]) continue;
      ++degree[mesh_.edges[i].a];
      ++degree[mesh_.edges[i].b];
    }
    const InputPoints given(domain_, mesh_);
    is_junction_.assign(degree.size(), 0);
    for (std::uint32_t v = 0; v < degree.size(); ++v)
      is_junction_[v] = degree[v] != 2 || given.has(mesh_.vertices[v]);
  }

  std::vector<ArcStep> steps_along_arcs() const {
    std::vector<Box> boxes;
    boxes.reserve(arcs_.size());
    for (const PlacedArc& arc : arcs_) {
      constexpr int kPieces = 32;
      Box box = box_of(domain_.points[arc.from], domain_.points[arc.to]);
      for (int k = 1; k < kPieces; ++k) {
        const Vec2 p = curve(arc).at(curve(arc).turn() * k / kPieces);
        box.add(box_of(p, p));
      }
      const double sagitta =
          curve(arc).radius() * std::pow(std::sin(curve(arc).turn() / (4 * kPieces)), 2) * 2;
      boxes.push_back(box.grown(2 * sagitta + result_.tolerance));
    }
    const BoxTree tree(std::move(boxes));
    std::vector<ArcStep> steps;
    for (std::uint32_t i = 0; i < mesh_.edges.size(); ++i) {
      if (!listed_.half_edge[i]) continue;
      const Vec2 p = mesh_.vertices[mesh_.edges[i].a];
      tree.visit(box_of(p, p), [&](std::uint32_t k) {
        if (const std::optional<ArcStep> step = step_of(i, k)) steps.push_back(*step);
      });
    }
    return steps;
  }

  std::optional<ArcStep> step_of(std::uint32_t edge, std::uint32_t k) const {
    const PlacedArc& arc = arcs_[k];
    std::uint32_t a = mesh_.edges[edge].a, b = mesh_.edges[edge].b;
    const auto from_angle = angle_on(arc, a), to_angle = angle_on(arc, b);
    if (!from_angle || !to_angle || *from_angle == *to_angle) return std::nullopt;
    const Vec2 p = mesh_.vertices[a], q = mesh_.vertices[b];
    ArcStep step{k, *from_angle, *to_angle, a, b, edge, 0, 0};
    if (step.to_angle < step.from_angle) {
      std::swap(step.from_angle, step.to_angle);
      std::swap(step.from, step.to);
    }
    const double turn = step.to_angle - step.from_angle;
    if (turn > std::numbers::pi) return std::nullopt;
    step.off = std::max(std::fabs(curve(arc).distance(p)), std::fabs(curve(arc).distance(q)));
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    step.height = length / 2 * std::tan(turn / 4);
    const Vec2 side = curve(arc).side(mesh_.vertices[step.from], mesh_.vertices[step.to], length);
    if (cross_from(p, q, side) > 0) step.height = -step.height;
    return step;
  }

  const CircularArc& curve(const PlacedArc& arc) const { return *result_.curves[arc.segment]; }

  // nullopt if the vertex is not on the arc.
  std::optional<double> angle_on(const PlacedArc& arc, std::uint32_t v) const {
    if (v == arc.at_from) return 0;
    if (v == arc.at_to) return curve(arc).turn();
    const Vec2 p = mesh_.vertices[v];
    if (std::fabs(curve(arc).distance(p)) > result_.tolerance) return std::nullopt;
    const double angle = curve(arc).angle(p), slack = result_.tolerance / curve(arc).radius();
    if (angle < -slack || angle > curve(arc).turn() + slack) return std::nullopt;
    return angle;
  }

  // Of several arcs and segments that an edge may be part of.
  void leave_to_the_flattest(std::vector<ArcStep>& steps) const {
    Domain straight;
    straight.points = domain_.points;
    const std::vector<double> bulges = bulges_of(domain_);
    for (std::size_t s = 0; s < bulges.size(); ++s)
      if (bulges[s] == 0) straight.segments.push_back(domain_.segments[s]);
    std::vector<double> flattest(mesh_.edges.size(), std::numeric_limits<double>::infinity());
    for (const Step& step :
         steps_along_segments(straight, mesh_, listed_,
                              std::vector<double>(straight.segments.size(), result_.tolerance)))
      flattest[step.edge] = 0;
    for (const ArcStep& step : steps)
      if (std::fabs(step.height) < std::fabs(flattest[step.edge]))
        flattest[step.edge] = step.height;
    std::erase_if(steps, [&](const ArcStep& step) {
      return std::fabs(step.height - flattest[step.edge]) > result_.tolerance;
    });
  }

  void follow(const PlacedArc& arc, std::span<const ArcStep> steps) {
    const auto path_within = [&](double tolerance) {
      return arc_path(steps, tolerance, curve(arc).turn(), arc.at_from, arc.at_to);
    };
    const auto gap_of = [](const std::vector<ArcStop>& path) {
      double gap = 0;
      for (std::size_t k = 1; k < path.size(); ++k)
        if (path[k].step == nullptr) gap += path[k].angle - path[k - 1].angle;
      return gap;
    };
    std::vector<ArcStop> path = path_within(tight_);
    double tolerance = tight_;
    if (gap_of(path) > 0) {
      std::vector<ArcStop> wider = path_within(result_.tolerance);
      if (gap_of(wider) < gap_of(path) && (arc.is_merged || is_bent(arc, wider))) {
        path = std::move(wider);
        tolerance = result_.tolerance;
      }
    }
    add_pieces(arc, path, tolerance);
  }

  // Whether something that is not on the arc draws the path to itself.
  bool is_bent(const PlacedArc& arc, const std::vector<ArcStop>& path) const {
    return std::any_of(path.begin(), path.end(), [&](const ArcStop& stop) {
      return stop.vertex && is_junction_[*stop.vertex] &&
             std::fabs(curve(arc).distance(mesh_.vertices[*stop.vertex])) > tight_;
    });
  }

  void add_pieces(const PlacedArc& arc, const std::vector<ArcStop>& path, double tolerance) {
    std::uint32_t last = arc.from;
    for (std::size_t k = 1; k < path.size(); ++k) {
      const ArcStop& stop = path[k];
      const std::uint32_t next = k + 1 == path.size() ? arc.to : point_of(*stop.vertex);
      pieces_.push_back({arc.segment, &curve(arc), last, next, path[k - 1].angle, stop.angle,
                         stop.step == nullptr});
      if (stop.step != nullptr) add_chord(arc, *stop.step, tolerance);
      last = next;
    }
  }

  void add_chord(const PlacedArc& arc, const ArcStep& step, double tolerance) {
    ArcChains::Chord chord{arc.segment,     step.edge,     step.from, step.to,
                           step.from_angle, step.to_angle, {}};
    const Vec2 p = mesh_.vertices[step.from], q = mesh_.vertices[step.to];
    constexpr double kMaxWithHull = 1.1;  // radians; longer edges are wrong
    const double height = chord.turn() < kMaxWithHull ? CircularArc::height(p, q, chord.turn()) : 0;
    if (height > 2 * tolerance) chord.hull = Hull{p, q, curve(arc).side(p, q, height - tolerance)};
    result_.chords.push_back(chord);
  }

  std::uint32_t point_of(std::uint32_t vertex) {
    const auto [at, is_new] = point_of_.emplace(vertex, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(mesh_.vertices[vertex]);
    return at->second;
  }

  // The segments stay in their order.
  void write_straight_domain() {
    std::vector<SegmentPiece> pieces;
    auto piece = pieces_.begin();
    const std::vector<double> bulges = bulges_of(domain_);
    for (std::uint32_t s = 0; s < bulges.size(); ++s) {
      if (bulges[s] == 0) {
        pieces.push_back({s, domain_.segments[s][0], domain_.segments[s][1]});
        result_.is_gap.push_back(0);
        result_.beside.push_back(0);
      }
      for (; piece != pieces_.end() && piece->segment == s; ++piece) {
        if (points_[piece->from] == points_[piece->to]) continue;
        pieces.push_back({s, piece->from, piece->to});
        result_.is_gap.push_back(piece->is_gap ? 1 : 0);
        result_.beside.push_back(piece->curve->beside(points_[piece->from], points_[piece->to],
                                                      piece->to_angle - piece->from_angle));
      }
    }
    const std::vector<Vec2> added(
        points_.begin() + static_cast<std::ptrdiff_t>(domain_.points.size()), points_.end());
    result_.straight = straight_domain(domain_, added, pieces);
    result_.straight.domain.snap = merging_;
  }

  const Domain& domain_;
  const Mesh& mesh_;
  const ListedEdges& listed_;
  double merging_ = 0;             // distance
  double tight_ = 0;               // how far vertices may be off arcs that nothing bends
  std::vector<PlacedArc> arcs_;    // by segment
  std::vector<char> is_junction_;  // per mesh vertex
  std::vector<Vec2> points_;       // the domain's, then others
  std::unordered_map<std::uint32_t, std::uint32_t> point_of_;  // of mesh vertices
  std::vector<ArcPiece> pieces_;                               // by segment, in order along it
  ArcChains result_;
};

}  // namespace

double extent_of(const Domain& domain) {
  double extent = largest_coordinate(domain);
  const std::vector<double> bulges = bulges_of(domain);
  for (std::size_t s = 0; s < bulges.size(); ++s) {
    if (bulges[s] == 0) continue;
    const Vec2 p = domain.points[domain.segments[s][0]], q = domain.points[domain.segments[s][1]];
    const double end = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(q.x), std::fabs(q.y)});
    extent = std::max(extent,
                      end + std::hypot(q.x - p.x, q.y - p.y) * std::max(1.0, std::fabs(bulges[s])));
  }
  return extent;
}

ArcChains find_arc_chains(const Domain& domain, const Mesh& mesh, const ListedEdges& listed) {
  return ChainFinder(domain, mesh, listed).find();
}

}  // namespace weft::check
