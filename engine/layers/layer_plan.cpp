// SPDX-License-Identifier: Apache-2.0
#include "engine/layers/layer_plan.h"

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/text.h"

namespace weft {
namespace {

namespace bg = boost::geometry;
using Triangle = std::array<Point, 3>;
using TreeBox = bg::model::box<bg::model::point<double, 2, bg::cs::cartesian>>;
using Tree = bg::index::rtree<std::pair<TreeBox, std::uint32_t>, bg::index::quadratic<16>>;

constexpr double kMaxOfWidth = 0.4;                      // that layers take
constexpr double kToOthers = 0.5 / kMaxOfWidth;          // how much thicker they would meet
constexpr double kToObstacles = 1 / kMaxOfWidth;         // what is opposite
constexpr std::size_t kMaxWalls = std::size_t{1} << 20;  // edges
constexpr std::uint64_t kBytesPerEdge = 100;             // of the boundary
constexpr std::uint64_t kBytesPerWall = 1000;            // with its corners, and boxes in trees
constexpr double kMaxOfEdge = 0.4;      // by which a corner shifts a spoke along it
constexpr double kMaxGrowth = 0.5;      // of the thickness, over the length of an edge
constexpr double kShrink = 0.8;         // in a round, where layers are too thick
constexpr double kMaxMissing = 1e-6;    // of a piece of the line
constexpr double kCosineOfFan = 0.5;    // of 60 degrees
constexpr double kCosineOfStep = 0.86;  // of 30.7 degrees, between the spokes of a fan
constexpr double kCosineOfSide = 0.70710678118654752;  // of 45 degrees

Vector operator*(double s, Vector v) {
  return {s * v.x, s * v.y};
}
Vector operator+(Vector u, Vector v) {
  return {u.x + v.x, u.y + v.y};
}
Point operator+(Point p, Vector v) {
  return {p.x + v.x, p.y + v.y};
}
Vector unit(Vector v) {
  return (1 / length(v)) * v;
}
Vector left_of(Vector v) {
  return {-v.y, v.x};
}

double doubled_area(const Triangle& t) {
  return cross(t[1] - t[0], t[2] - t[0]);
}

// Whether a line along an edge of `t` parts the two; touching counts as parted.
template <class Other>
bool parts(const Triangle& t, const Other& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector normal = left_of(t[(i + 1) % 3] - t[i]);
    if (normal.x == 0 && normal.y == 0) continue;
    const auto range = [&](const auto& points) {
      double low = dot(normal, points[0] - Point{}), high = low;
      for (const Point p : points) {
        low = std::min(low, dot(normal, p - Point{}));
        high = std::max(high, dot(normal, p - Point{}));
      }
      return std::pair(low, high);
    };
    const auto [low, high] = range(t);
    const auto [other_low, other_high] = range(other);
    if (high <= other_low || other_high <= low) return true;
  }
  return false;
}
bool overlap(const Triangle& t, const Triangle& u) {
  return !parts(t, u) && !parts(u, t);
}
bool overlap(const Triangle& t, const std::array<Point, 2>& segment) {
  return !parts(t, segment) && !parts(Triangle{segment[0], segment[1], segment[1]}, t);
}

template <class Points>
TreeBox box_of(const Points& points) {
  Box box;
  for (const Point p : points) box.add(p);
  return {{box.min_x, box.min_y}, {box.max_x, box.max_y}};
}

// Directions between two at a corner that turns away from the mesh, none of them far from the next;
// both included. `outward` lies between the two.
void add_fan(Vector u, Vector outward, Vector v, std::vector<Vector>& fan) {
  const auto halve = [&fan](auto& self, Vector from, Vector to) -> void {
    if (dot(from, to) < kCosineOfStep) {
      const Vector middle = unit(from + to);
      self(self, from, middle);
      self(self, middle, to);
    } else {
      fan.push_back(to);
    }
  };
  fan.push_back(u);
  halve(halve, u, outward);
  halve(halve, outward, v);
}

}  // namespace

double thickness_of(const Layers& layers) {
  double height = layers.first, sum = 0;
  for (std::uint32_t i = 0; i < layers.rows; ++i, height *= layers.ratio) sum += height;
  return sum;
}

std::vector<double> heights_of(const Layers& layers) {
  const double thickness = thickness_of(layers);
  std::vector<double> heights;
  double height = layers.first, sum = 0;
  for (std::uint32_t i = 0; i < layers.rows; ++i, height *= layers.ratio)
    heights.push_back((sum += height) / thickness);
  heights.back() = 1;
  return heights;
}

class LayerPlanner {
 public:
  LayerPlanner(const std::vector<Layers>& layers, const Domain& domain, double tolerance,
               const ExecutionContext& context)
      : layers_(layers), domain_(domain), tolerance_(tolerance), context_(context) {}

  Result<LayerPlan> run() {
    if (auto error = find_walls()) return tl::unexpected(*error);
    if (auto error = find_corners()) return tl::unexpected(*error);
    bound_thickness();
    if (auto error = find_patches()) return tl::unexpected(*error);
    if (auto error = find_obstacles()) return tl::unexpected(*error);
    if (auto error = make_room()) return tl::unexpected(*error);
    return plan();
  }

 private:
  // An edge of the domain's boundary, the inside at its left.
  struct Edge {
    std::uint32_t a = 0, b = 0;
    std::uint32_t subsegment = 0;
    std::uint32_t layers = kNone;               // of a wall
    std::uint32_t next = kNone;                 // that begins where this one ends
    std::uint32_t inner = kNone;                // a subsegment inside the domain between the two
    std::uint32_t first = kNone, last = kNone;  // corners of a wall's edge
  };
  struct Corner {
    std::uint32_t vertex = 0;
    std::uint32_t side = kNone;  // the subsegment that its spoke lies on
    std::vector<Vector> spokes;  // of layers as thick as they are asked for; empty: a point
    double scale = 1;            // of them
  };
  // What a wall's edge, or two spokes of a corner, take.
  struct Patch {
    std::uint32_t first, last;  // corners
    std::uint32_t first_spoke, last_spoke;
    std::uint32_t edge;  // kNone in a fan
  };

  Error bad(std::uint32_t layers, const std::string& message, Point at) const {
    const std::string field = "quality.layers[" + std::to_string(layers) + "]";
    return {ErrorCode::kBadOption, field,
            field + ": " + message + " at (" + text(at.x) + ", " + text(at.y) + ")", at};
  }
  Point at(std::uint32_t vertex) const { return domain_.vertices[vertex]; }
  Vector along(const Edge& edge) const { return at(edge.b) - at(edge.a); }
  std::string segment_of(std::uint32_t subsegment) const {
    return "segment " + std::to_string(domain_.subsegments[subsegment].segment);
  }

  std::uint32_t layers_at(std::uint32_t subsegment) const {
    const std::int32_t marker = domain_.subsegments[subsegment].marker;
    const auto found = std::find_if(layers_.begin(), layers_.end(),
                                    [&](const Layers& l) { return l.marker == marker; });
    return found == layers_.end() ? kNone : static_cast<std::uint32_t>(found - layers_.begin());
  }

  std::optional<Error> find_walls() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> places;  // triangles and sides, sorted
    std::size_t walls = 0;
    std::vector<bool> has_wall(layers_.size());
    for (std::uint32_t t = 0; t < domain_.triangles.size(); ++t) {
      if (auto error = poll(t)) return error;
      const Domain::Triangle& triangle = domain_.triangles[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (triangle.subsegment[i] == kNone) continue;
        const std::uint32_t layers = layers_at(triangle.subsegment[i]);
        const std::uint32_t a = triangle.vertex[(i + 1) % 3], b = triangle.vertex[(i + 2) % 3];
        if (triangle.neighbor[i] != kNone) {
          if (layers == kNone) continue;
          return bad(layers,
                     segment_of(triangle.subsegment[i]) +
                         " lies inside of the domain, and layers are on its boundary,",
                     at(a));
        }
        if (layers != kNone) {
          has_wall[layers] = true;
          ++walls;
        }
        places.emplace_back(t, i);
        edges_.push_back({.a = a, .b = b, .subsegment = triangle.subsegment[i], .layers = layers});
      }
    }
    for (std::uint32_t i = 0; i < layers_.size(); ++i)
      if (!has_wall[i])
        return Error{ErrorCode::kBadOption, "quality.layers[" + std::to_string(i) + "]",
                     "quality.layers[" + std::to_string(i) +
                         "]: no segment of the domain has the marker " +
                         std::to_string(layers_[i].marker)};
    if (walls > kMaxWalls)
      return Error{ErrorCode::kLimitExceeded, "quality.layers",
                   "quality.layers: walls have " + std::to_string(walls) +
                       " edges; layers are laid along " + std::to_string(kMaxWalls) + " at most"};
    if (auto error = context_.need_bytes(
            domain_.bytes() + kBytesPerEdge * edges_.size() + kBytesPerWall * walls,
            "the plan of layers"))
      return error;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      if (auto error = poll(e)) return error;
      auto [t, i] = places[e];
      while (true) {  // around the end of the edge
        const std::uint32_t onwards = (i + 1) % 3;
        const Domain::Triangle& triangle = domain_.triangles[t];
        const std::uint32_t next = triangle.neighbor[onwards];
        if (next == kNone) {
          const auto found = std::lower_bound(places.begin(), places.end(), std::pair(t, onwards));
          edges_[e].next = static_cast<std::uint32_t>(found - places.begin());
          break;
        }
        if (triangle.subsegment[onwards] != kNone) edges_[e].inner = triangle.subsegment[onwards];
        const auto& back = domain_.triangles[next].neighbor;
        i = static_cast<std::uint32_t>(std::find(back, back + 3, t) - back);
        t = next;
      }
    }
    return std::nullopt;
  }

  bool alike(std::uint32_t i, std::uint32_t j) const {
    const Layers &a = layers_[i], &b = layers_[j];
    return a.first == b.first && a.ratio == b.ratio && a.rows == b.rows && a.region == b.region;
  }

  std::optional<Error> find_corners() {
    std::vector<std::uint32_t> before(edges_.size(), kNone);
    for (std::uint32_t e = 0; e < edges_.size(); ++e) before[edges_[e].next] = e;
    const auto is_wall = [this](std::uint32_t e) { return edges_[e].layers != kNone; };
    // Walls that end first, then those that go around.
    for (const bool ends : {true, false}) {
      for (std::uint32_t start = 0; start < edges_.size(); ++start) {
        if (!is_wall(start) || edges_[start].first != kNone || (ends && is_wall(before[start])))
          continue;
        std::uint32_t e = start;
        std::uint32_t corner = ends ? end_corner(e, before[e], true) : kNone;
        const std::size_t first = walls_.size();
        do {
          Edge& edge = edges_[e];
          walls_.push_back(e);
          edge.first = corner;
          if (is_wall(edge.next) && !alike(edge.layers, edges_[edge.next].layers))
            return bad(edge.layers, "walls with other layers meet", at(edge.b));
          if (edge.inner != kNone)
            return bad(edge.layers, segment_of(edge.inner) + " ends on the wall, inside of it,",
                       at(edge.b));
          corner =
              is_wall(edge.next) ? inner_corner(e, edge.next) : end_corner(e, edge.next, false);
          edge.last = corner;
          e = edge.next;
        } while (is_wall(e) && e != start);
        if (!ends) edges_[start].first = corner;
        if (ends && edges_[before[start]].inner != kNone)
          return bad(edges_[start].layers,
                     segment_of(edges_[before[start]].inner) + " ends on the wall, inside of it,",
                     at(edges_[start].a));
        const bool stands = std::any_of(walls_.begin() + static_cast<std::ptrdiff_t>(first),
                                        walls_.end(), [this](std::uint32_t w) {
                                          return !corners_[edges_[w].first].spokes.empty() ||
                                                 !corners_[edges_[w].last].spokes.empty();
                                        });
        if (!stands)
          return bad(edges_[start].layers,
                     "layers end in a point at both ends of a wall of one edge",
                     at(edges_[start].a));
      }
    }
    return std::nullopt;
  }

  std::uint32_t add(Corner corner) {
    corners_.push_back(std::move(corner));
    return static_cast<std::uint32_t>(corners_.size() - 1);
  }

  std::uint32_t inner_corner(std::uint32_t in, std::uint32_t out) {
    const double thickness = thickness_of(layers_[edges_[in].layers]);
    const Vector d = unit(along(edges_[in])), e = unit(along(edges_[out]));
    Corner corner{.vertex = edges_[in].b, .spokes = {}};
    const double cosine = dot(d, e), sine = cross(d, e);
    if (sine < 0 && cosine < kCosineOfFan) {
      add_fan(left_of(d), unit(d + -e), left_of(e), corner.spokes);
    } else {
      corner.spokes.push_back((1 / (1 + cosine)) * (left_of(d) + left_of(e)));
      const double shift = thickness * sine / (1 + cosine);
      const double shorter = std::min(length(along(edges_[in])), length(along(edges_[out])));
      if (shift > kMaxOfEdge * shorter) corner.scale = kMaxOfEdge * shorter / shift;
    }
    for (Vector& spoke : corner.spokes) spoke = thickness * spoke;
    return add(std::move(corner));
  }

  // Where a wall's edge begins or ends at another side.
  std::uint32_t end_corner(std::uint32_t wall, std::uint32_t side, bool begins) {
    const double thickness = thickness_of(layers_[edges_[wall].layers]);
    const Vector away = unit(begins ? along(edges_[wall]) : -along(edges_[wall]));
    const Vector onto = begins ? -along(edges_[side]) : along(edges_[side]);
    const Vector direction = unit(onto);
    Corner corner{.vertex = begins ? edges_[wall].a : edges_[wall].b, .spokes = {}};
    const double sine = begins ? cross(away, direction) : cross(direction, away);
    if (sine >= kCosineOfSide) {
      corner.side = edges_[side].subsegment;
      corner.spokes.push_back((thickness / sine) * direction);
      const double share = thickness / sine / length(onto);
      if (share > kMaxOfEdge) corner.scale = kMaxOfEdge / share;
    }
    return add(std::move(corner));
  }

  // No layers are thicker than the domain is wide.
  void bound_thickness() {
    Box box;
    for (const Point p : domain_.vertices) box.add(p);
    const double most = std::max(box.width(), box.height());
    for (const std::uint32_t w : walls_)
      for (const std::uint32_t c : {edges_[w].first, edges_[w].last})
        corners_[c].scale =
            std::min(corners_[c].scale, most / thickness_of(layers_[edges_[w].layers]));
  }

  std::optional<Error> find_patches() {
    const auto last_spoke = [this](std::uint32_t corner) {
      return static_cast<std::uint32_t>(std::max<std::size_t>(corners_[corner].spokes.size(), 1) -
                                        1);
    };
    for (const std::uint32_t w : walls_) {
      if (auto error = poll(w)) return error;
      const Edge& edge = edges_[w];
      patches_.push_back({edge.first, edge.last, last_spoke(edge.first), 0, w});
      for (std::uint32_t i = 0; i < last_spoke(edge.last); ++i)
        patches_.push_back({edge.last, edge.last, i, i + 1, kNone});
    }
    return std::nullopt;
  }

  // What layers as thick as they are asked for may come near.
  std::optional<Error> find_obstacles() {
    std::vector<bool> is_joined(domain_.vertices.size());
    std::vector<bool> is_wall(domain_.subsegments.size());
    for (const std::uint32_t w : walls_) is_wall[edges_[w].subsegment] = true;
    const Tree patches = tree_of_patches(kToObstacles);
    const auto add = [&](const std::array<Point, 2>& ends, std::uint32_t subsegment) {
      if (patches.qbegin(bg::index::intersects(box_of(ends))) != patches.qend())
        obstacles_.push_back({ends, subsegment});
    };
    for (std::uint32_t s = 0; s < domain_.subsegments.size(); ++s) {
      if (auto error = poll(s)) return error;
      const Subsegment& subsegment = domain_.subsegments[s];
      is_joined[subsegment.a] = is_joined[subsegment.b] = true;
      if (!is_wall[s]) add({at(subsegment.a), at(subsegment.b)}, s);
    }
    for (std::uint32_t v = 0; v < domain_.vertices.size(); ++v) {
      if (auto error = poll(v)) return error;
      if (!is_joined[v]) add({at(v), at(v)}, kNone);
    }
    std::vector<std::pair<TreeBox, std::uint32_t>> boxes;
    for (std::uint32_t i = 0; i < obstacles_.size(); ++i)
      boxes.emplace_back(box_of(obstacles_[i].ends), i);
    obstacle_tree_ = Tree(boxes);
    return context_.poll();
  }

  TreeBox box_of_patch(const Patch& patch, double factor) const {
    const auto [t, u] = triangles(patch, factor);
    return box_of(std::array{t[0], t[1], t[2], u[2]});
  }
  Tree tree_of_patches(double factor) const {
    std::vector<std::pair<TreeBox, std::uint32_t>> boxes;
    for (std::uint32_t i = 0; i < patches_.size(); ++i)
      boxes.emplace_back(box_of_patch(patches_[i], factor), i);
    return Tree(boxes);
  }

  // In long loops.
  std::optional<Error> poll(std::size_t step) const {
    constexpr std::size_t kStepsPerPoll = 1024;
    return step % kStepsPerPoll == 0 ? context_.poll() : std::nullopt;
  }

  double thickness(const Corner& corner, std::uint32_t layers) const {
    return corner.spokes.empty() ? 0 : corner.scale * thickness_of(layers_[layers]);
  }
  Point tip(std::uint32_t corner, std::uint32_t spoke, double factor) const {
    const Corner& c = corners_[corner];
    return c.spokes.empty() ? at(c.vertex) : at(c.vertex) + (factor * c.scale) * c.spokes[spoke];
  }
  // Of a patch, with spokes that are longer by a factor. One of the two may have no area.
  std::array<Triangle, 2> triangles(const Patch& patch, double factor) const {
    const Point a = at(corners_[patch.first].vertex), b = at(corners_[patch.last].vertex);
    const Point p = tip(patch.first, patch.first_spoke, factor);
    const Point q = tip(patch.last, patch.last_spoke, factor);
    return {Triangle{a, b, q}, Triangle{a, q, p}};
  }
  // So that no row turns over, whichever diagonals it has.
  bool is_convex(const Patch& patch) const {
    const auto [t, u] = triangles(patch, 1);
    return doubled_area(t) >= 0 && doubled_area(u) >= 0 && doubled_area({t[0], t[1], u[2]}) >= 0 &&
           doubled_area({t[1], t[2], u[2]}) >= 0;
  }
  template <class Other>
  bool overlaps(const Patch& patch, double factor, const Other& other) const {
    for (const Triangle& t : triangles(patch, factor))
      if (doubled_area(t) != 0 && overlap(t, other)) return true;
    return false;
  }

  // Makes layers thinner until there is room for all of them.
  std::optional<Error> make_room() {
    while (true) {
      even_out();
      if (auto error = check_thickness()) return error;
      std::vector<bool> is_tight(corners_.size());
      const auto mark = [&](const Patch& patch) {
        is_tight[patch.first] = is_tight[patch.last] = true;
      };
      const Tree tree = tree_of_patches(kToOthers);
      for (std::uint32_t i = 0; i < patches_.size(); ++i) {
        if (auto error = poll(i)) return error;
        const Patch& patch = patches_[i];
        if (!is_convex(patch)) mark(patch);
        for (auto near = tree.qbegin(bg::index::intersects(box_of_patch(patch, kToOthers)));
             near != tree.qend(); ++near) {
          const Patch& other = patches_[near->second];
          if (near->second <= i || other.first == patch.last || other.last == patch.first ||
              other.first == patch.first || other.last == patch.last)
            continue;
          const auto theirs = triangles(other, kToOthers);
          if (overlaps(patch, kToOthers, theirs[0]) || overlaps(patch, kToOthers, theirs[1])) {
            mark(patch);
            mark(other);
          }
        }
        for (auto near =
                 obstacle_tree_.qbegin(bg::index::intersects(box_of_patch(patch, kToObstacles)));
             near != obstacle_tree_.qend(); ++near) {
          const Obstacle& obstacle = obstacles_[near->second];
          if (obstacle.subsegment != kNone && (obstacle.subsegment == corners_[patch.first].side ||
                                               obstacle.subsegment == corners_[patch.last].side))
            continue;
          if (overlaps(patch, kToObstacles, obstacle.ends)) mark(patch);
        }
      }
      bool any = false;
      for (std::size_t i = 0; i < corners_.size(); ++i) {
        if (!is_tight[i] || corners_[i].spokes.empty()) continue;
        corners_[i].scale *= kShrink;
        any = true;
      }
      if (!any) return std::nullopt;
    }
  }

  // Lets the thickness grow slowly along walls.
  void even_out() {
    const auto follow = [this](const Edge& edge, Corner& corner, const Corner& other) {
      if (corner.spokes.empty()) return;
      const double asked = thickness_of(layers_[edge.layers]);
      const double most = thickness(other, edge.layers) + kMaxGrowth * length(along(edge));
      corner.scale = std::min(corner.scale, most / asked);
    };
    for (int round = 0; round < 2; ++round) {  // a second time for walls that go around
      for (const std::uint32_t w : walls_)
        follow(edges_[w], corners_[edges_[w].last], corners_[edges_[w].first]);
      for (auto w = walls_.rbegin(); w != walls_.rend(); ++w)
        follow(edges_[*w], corners_[edges_[*w].first], corners_[edges_[*w].last]);
    }
  }

  std::optional<Error> check_thickness() const {
    for (const std::uint32_t w : walls_) {
      const Edge& edge = edges_[w];
      for (const std::uint32_t c : {edge.first, edge.last}) {
        const Corner& corner = corners_[c];
        const double row = corner.scale * layers_[edge.layers].first;
        if (corner.spokes.empty() ||
            (row > kMinRow * tolerance_ && thickness(corner, edge.layers) > kMin * tolerance_))
          continue;
        return bad(edge.layers,
                   "there is no room for layers, of a first row of " + rough_text(row) + ",",
                   at(corner.vertex));
      }
    }
    return std::nullopt;
  }

  LayerPlan plan() const {
    LayerPlan plan;
    std::vector<std::uint32_t> first_spoke;
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const Corner& corner = corners_[c];
      first_spoke.push_back(static_cast<std::uint32_t>(plan.spokes_.size()));
      for (std::uint32_t i = 0; i < std::max<std::size_t>(corner.spokes.size(), 1); ++i)
        plan.spokes_.push_back({corner.vertex, corner.side, at(corner.vertex),
                                tip(static_cast<std::uint32_t>(c), i, 1)});
      if (!corner.spokes.empty() && corner.scale < 1) ++plan.cut_;
    }
    plan.least_ = std::numeric_limits<double>::infinity();
    for (const Patch& patch : patches_) {
      const std::uint32_t layers =
          patch.edge != kNone ? edges_[patch.edge].layers : plan.pieces_.back().layers;
      plan.pieces_.push_back({first_spoke[patch.first] + patch.first_spoke,
                              first_spoke[patch.last] + patch.last_spoke, layers,
                              patch.edge == kNone ? kNone : edges_[patch.edge].subsegment});
      for (const Triangle& t : triangles(patch, 1)) plan.area_ += 0.5 * doubled_area(t);
      for (const std::uint32_t c : {patch.first, patch.last}) {
        const double thick = thickness(corners_[c], layers);
        if (corners_[c].spokes.empty() || thick >= plan.least_) continue;
        plan.least_ = thick;
        plan.thinnest_at_ = at(corners_[c].vertex);
      }
    }
    return plan;
  }

  // In tolerances: a row is no thinner than refinement's edges are short, and the line is apart
  // from the wall.
  static constexpr double kMinRow = 1.0 / 64;
  static constexpr double kMin = 16;

  struct Obstacle {
    std::array<Point, 2> ends;
    std::uint32_t subsegment;  // kNone: a point
  };

  const std::vector<Layers>& layers_;
  const Domain& domain_;
  const double tolerance_;
  const ExecutionContext& context_;
  std::vector<Edge> edges_;           // of the boundary
  std::vector<std::uint32_t> walls_;  // those with layers, one wall after the other
  std::vector<Corner> corners_;
  std::vector<Patch> patches_;
  std::vector<Obstacle> obstacles_;
  Tree obstacle_tree_;
};

Result<LayerPlan> LayerPlan::of(const std::vector<Layers>& layers, const Domain& domain,
                                double tolerance, const ExecutionContext& context) {
  return LayerPlanner(layers, domain, tolerance, context).run();
}

Pslg LayerPlan::with_holes(const Pslg& pslg, const std::vector<Layers>& layers) const {
  Pslg result = pslg;
  const auto first = static_cast<std::uint32_t>(pslg.points.size());
  for (const Spoke& spoke : spokes_) {
    result.points.push_back(spoke.base);
    result.points.push_back(spoke.tip);
  }
  const auto tip_of = [&](std::uint32_t spoke) { return first + 2 * spoke + 1; };
  // Where parity decides what is inside, each is there twice, which changes no parity.
  const int copies = pslg.fill == Fill::kEvenOdd && pslg.areas.empty() ? 2 : 1;
  for (int copy = 0; copy < copies; ++copy)
    for (const LinePiece& piece : pieces_)
      result.segments.push_back({.a = tip_of(piece.first),
                                 .b = tip_of(piece.last),
                                 .marker = layers[piece.layers].marker});
  for (const LinePiece& piece : pieces_) {
    const Spoke &a = spokes_[piece.first], &b = spokes_[piece.last];
    const Triangle low{a.base, b.base, b.tip}, high{a.base, b.tip, a.tip};
    const Triangle& larger = doubled_area(low) > doubled_area(high) ? low : high;
    result.holes.push_back(centroid(larger[0], larger[1], larger[2]));
  }
  return result;
}

std::uint32_t LayerPlan::segment_of(std::uint32_t segment, const Pslg& pslg,
                                    const Domain& domain) const {
  const std::size_t count = pslg.segments.size();
  if (segment < count) return segment;
  std::size_t piece = (segment - count) % pieces_.size();
  while (pieces_[piece].wall == kNone) --piece;  // of a fan, which follows its wall
  return domain.subsegments[pieces_[piece].wall].segment;
}

std::optional<Error> LayerPlan::check(const Pslg& pslg, const Domain& before,
                                      const Domain& domain) const {
  const auto area_of = [](const Domain& d) {
    double doubled = 0;
    for (const Domain::Triangle& t : d.triangles)
      doubled +=
          doubled_area({d.vertices[t.vertex[0]], d.vertices[t.vertex[1]], d.vertices[t.vertex[2]]});
    return 0.5 * doubled;
  };
  constexpr double kRounding = 1e-9;
  const double all = area_of(before);
  const auto wrong = [](const std::string& what, Point at) {
    return Error{ErrorCode::kBadOption, "quality.layers",
                 "quality.layers: " + what + " near (" + text(at.x) + ", " + text(at.y) + ")", at};
  };
  std::vector<double> missing;  // of each piece
  for (const LinePiece& piece : pieces_)
    missing.push_back(length(spokes_[piece.last].tip - spokes_[piece.first].tip));
  for (const Subsegment& s : domain.subsegments)
    if (s.segment >= pslg.segments.size())
      missing[(s.segment - pslg.segments.size()) % pieces_.size()] -=
          length(domain.vertices[s.b] - domain.vertices[s.a]);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Spoke &a = spokes_[pieces_[i].first], &b = spokes_[pieces_[i].last];
    if (std::fabs(missing[i]) > kMaxMissing * length(b.tip - a.tip))
      return wrong("something crosses the line on which they end", a.tip);
  }
  if (std::fabs(all - area_of(domain) - area_) > kRounding * all)
    return wrong("they do not lie between the walls and the line on which they end",
                 spokes_.front().tip);
  return std::nullopt;
}

double LayerPlan::least_stretch(std::int32_t marker, const Domain& domain) const {
  double least = 1;
  for (const LinePiece& piece : pieces_) {
    if (piece.wall == kNone || domain.subsegments[piece.wall].marker != marker) continue;
    const Spoke &a = spokes_[piece.first], &b = spokes_[piece.last];
    least = std::min(least, length(b.tip - a.tip) / length(b.base - a.base));
  }
  return least;
}

}  // namespace weft
