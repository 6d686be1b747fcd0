// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/medial_axis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "engine/domain/stop_poller.h"
#include "engine/domain/tolerance.h"
#include "engine/domain/triangulation/segment_inserter.h"
#include "engine/domain/triangulation/triangulation.h"

namespace weft {
namespace {

constexpr double kSinHalfAngle = 0.8414709848078965;  // sin(kObjectAngle / 2)
constexpr double kCosHalfAngle = 0.5403023058681398;  // cos(kObjectAngle / 2)
constexpr double kCosAngle = -0.4161468365471424;     // cos(kObjectAngle)
// Longest piece of a wall, in heights of a triangle of the axis on it.
constexpr double kLongestPiece = 0.5;
// How near the axis comes to a corner, as a part of the shorter of its two walls.
constexpr double kOfTip = 0.5;
// The walls of every ear are halved in so many rounds, because a domain may consist of ears.
constexpr int kRoundsOfEars = 2;

constexpr std::uint32_t kCorners = 4;  // of a frame around the walls

Point middle(Point a, Point b) {
  return {a.x + 0.5 * (b.x - a.x), a.y + 0.5 * (b.y - a.y)};
}

double length(Point a, Point b) {
  return std::sqrt(distance2(a, b));
}

void require(std::uint64_t bytes, const ExecutionContext& context) {
  if (auto error = context.need_bytes(bytes, "the local width")) throw Stopped{*error};
}

// The walls, and a frame around them: no wall is on the convex hull then. The first points are the
// frame's corners.
Pslg walls_of(const Domain& domain, StopPoller& poller) {
  Pslg walls;
  walls.points.resize(kCorners);
  std::vector<std::uint32_t> number(domain.vertices.size(), kNone);
  const auto point = [&](std::uint32_t v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(walls.points.size());
      walls.points.push_back(domain.vertices[v]);
    }
    return number[v];
  };
  Box box;
  for (const Domain::Triangle& t : domain.triangles) {
    poller.step();
    for (int i = 0; i < 3; ++i) {
      if (t.neighbor[i] != kNone) continue;
      const std::uint32_t a = t.vertex[ccw(i)], b = t.vertex[cw(i)];
      walls.segments.push_back({point(a), point(b)});
      box.add(domain.vertices[a]);
    }
  }
  const double room = std::max(box.width(), box.height());
  walls.points[0] = {box.min_x - room, box.min_y - room};
  walls.points[1] = {box.max_x + room, box.min_y - room};
  walls.points[2] = {box.max_x + room, box.max_y + room};
  walls.points[3] = {box.min_x - room, box.max_y + room};
  return walls;
}

class Axis {
 public:
  Axis(const Pslg& walls, std::uint64_t other_bytes, const ExecutionContext& context,
       StopPoller& poller)
      : walls_(walls), other_bytes_(other_bytes), context_(context), poller_(poller), t_(poller) {}

  std::vector<Line> find() {
    triangulate_walls();
    find_inside();
    halve_walls();
    return collect();
  }

 private:
  using Edge = Triangulation::Edge;
  using Vertex = Triangulation::Vertex;

  static constexpr std::uint8_t kUnknown = 2;

  // A triangle of the meshed area. Side i is opposite corner i. An ear has two walls.
  struct Shape {
    Point corner[3];
    double side[3];
    bool is_wall[3];
    int walls = 0;
    double area2;  // twice the area
    double radius;
    bool is_ear;
    bool is_sharp;    // an ear, and the axis runs into its corner
    bool is_at_tip;   // not an ear; near a corner of walls, where the axis does not come
    bool is_on_axis;  // its circumcircle is a disk of the axis
  };

  void triangulate_walls();
  void find_inside();
  void halve_walls();
  void halve(Vertex u, Vertex v, std::vector<std::uint32_t>& changed);
  std::vector<Line> collect();

  Point inside_box(Point p) const {
    return {std::clamp(p.x, box_.min_x, box_.max_x), std::clamp(p.y, box_.min_y, box_.max_y)};
  }
  bool is_wall(Edge e) const { return t_.constraint(e) != kNone; }
  // Whether the edge leads in or out of the meshed area.
  bool leads_over(Edge e) const { return is_wall(e) && constraints_[t_.constraint(e)].odd; }
  bool are_at_tip(Vertex u, Vertex v) const;
  Shape shape(std::uint32_t face) const;
  bool wants_halving(const Shape& s, int i, int round) const;
  bool is_too_narrow(const Shape& s) const;

  const Pslg& walls_;
  const std::uint64_t other_bytes_;
  const ExecutionContext& context_;
  StopPoller& poller_;
  Triangulation t_;
  std::vector<Arrangement::Constraint> constraints_;
  std::vector<std::uint8_t> inside_;  // per face of the triangulation: 0, 1, or kUnknown meanwhile
  std::vector<std::uint32_t> wall_;   // per vertex: the wall that it halves, or kNone
  Box box_;                           // of the walls
  double shortest_ = 0;               // walls up to this length are not halved
};

void Axis::triangulate_walls() {
  t_.build(walls_.points, 0, 1, 2);
  Merging merging{.tolerance = std::min(kMergeFraction * largest_coordinate(walls_.points),
                                        std::sqrt(t_.nearest2()))};
  SegmentInserter inserter(walls_, walls_.points, t_,
                           std::max(merging.tolerance, std::sqrt(t_.nearest2())), kMaxSplits,
                           merging, poller_);
  inserter.insert_all();
  constraints_ = inserter.take_constraints();
  wall_.assign(t_.vertices(), kNone);

  double perimeter = 0;
  for (const Segment& s : walls_.segments) {
    poller_.step();
    box_.add(walls_.points[s.a]);
    perimeter += length(walls_.points[s.a], walls_.points[s.b]);
  }
  const std::size_t walls = walls_.segments.size();
  const auto pieces = static_cast<double>(
      std::min(64 * walls + (std::size_t{1} << 13), 2 * walls + (std::size_t{1} << 17)));
  shortest_ = std::max(perimeter / pieces, 4 * merging.tolerance);
}

// The walls are the border of the meshed area, so each that is crossed on the way from infinity
// leads in or out of it.
void Axis::find_inside() {
  inside_.assign(t_.faces(), kUnknown);
  std::uint32_t start = 0;
  while (!t_.is_infinite(start)) ++start;
  inside_[start] = 0;
  std::vector<std::uint32_t> stack{start};
  while (!stack.empty()) {
    poller_.step();
    const std::uint32_t f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t next = t_.mirror({f, i}).face;
      if (inside_[next] != kUnknown) continue;
      inside_[next] = inside_[f] ^ static_cast<std::uint8_t>(leads_over({f, i}));
      stack.push_back(next);
    }
  }
}

// Whether the two are on walls that meet at a corner, and within kOfTip of the shorter one from it.
bool Axis::are_at_tip(Vertex u, Vertex v) const {
  if (wall_[u] == kNone || wall_[v] == kNone || wall_[u] == wall_[v]) return false;
  const Segment a = walls_.segments[wall_[u]], b = walls_.segments[wall_[v]];
  const bool at_a = a.a == b.a || a.a == b.b;
  if (!at_a && a.b != b.a && a.b != b.b) return false;
  const Point tip = walls_.points[at_a ? a.a : a.b];
  const double shorter = std::min(distance2(walls_.points[a.a], walls_.points[a.b]),
                                  distance2(walls_.points[b.a], walls_.points[b.b]));
  return std::max(distance2(tip, t_.at(u)), distance2(tip, t_.at(v))) <=
         kOfTip * kOfTip * shorter * (1 + 1e-9);  // covers the rounding of halves
}

Axis::Shape Axis::shape(std::uint32_t face) const {
  Shape s;
  for (int i = 0; i < 3; ++i) s.corner[i] = t_.at(t_.vertex(face, i));
  for (int i = 0; i < 3; ++i) {
    s.side[i] = length(s.corner[ccw(i)], s.corner[cw(i)]);
    s.is_wall[i] = is_wall({face, i});
    s.walls += s.is_wall[i];
  }
  const Point a = s.corner[0], b = s.corner[1], c = s.corner[2];
  s.area2 = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  s.radius = s.side[0] * s.side[1] / s.area2 * (0.5 * s.side[2]);  // no product underflows
  s.is_ear = s.walls >= 2;
  double widest = 0;
  s.is_at_tip = false;
  for (int i = 0; i < 3; ++i) {
    if (s.is_wall[i] || s.side[i] <= widest) continue;
    widest = s.side[i];
    s.is_at_tip = are_at_tip(t_.vertex(face, ccw(i)), t_.vertex(face, cw(i)));
  }
  s.is_on_axis = s.area2 > 0 && !s.is_ear && !s.is_at_tip && widest >= 2 * kSinHalfAngle * s.radius;
  s.is_sharp = false;
  if (s.walls == 2) {
    const int i = !s.is_wall[0] ? 0 : !s.is_wall[1] ? 1 : 2;
    const double p = s.side[ccw(i)], q = s.side[cw(i)];
    s.is_sharp = !s.is_at_tip && p * p + q * q - s.side[i] * s.side[i] > -2 * p * q * kCosAngle;
  }
  return s;
}

// Whether wall i is too long for the axis in this triangle.
bool Axis::wants_halving(const Shape& s, int i, int round) const {
  if (!s.is_wall[i]) return false;
  if (s.is_ear) {
    double shortest = s.side[i];
    for (int k = 0; k < 3; ++k)
      if (s.is_wall[k]) shortest = std::min(shortest, s.side[k]);
    return s.is_sharp || round < kRoundsOfEars || s.side[i] > 2 * shortest;
  }
  if (s.is_at_tip) return false;
  const double square = s.side[i] * s.side[i];
  if (s.is_on_axis) return square > kLongestPiece * s.area2;
  const double p = s.side[ccw(i)], q = s.side[cw(i)];
  return p * p + q * q - square < 2 * p * q * kCosHalfAngle;
}

// Whether only a smaller triangle would show where the axis is, and its walls cannot be halved
// further. Called once all walls are halved.
bool Axis::is_too_narrow(const Shape& s) const {
  if (s.is_ear) return false;
  for (int i = 0; i < 3; ++i)
    if (wants_halving(s, i, kRoundsOfEars)) return true;
  return false;
}

// Works in rounds: each one visits the triangles that the last one changed.
void Axis::halve_walls() {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t f = 0; f < t_.faces(); ++f)
    if (inside_[f]) changed.push_back(f);
  std::vector<std::pair<Vertex, Vertex>> long_walls;
  std::size_t announced = t_.vertices();
  for (int round = 0; !changed.empty(); ++round) {
    long_walls.clear();
    for (const std::uint32_t f : changed) {
      poller_.step();
      if (!inside_[f]) continue;
      const Shape s = shape(f);
      for (int i = 0; i < 3; ++i)
        if (s.side[i] > shortest_ && wants_halving(s, i, round))
          long_walls.emplace_back(t_.right({f, i}), t_.left({f, i}));
    }
    changed.clear();
    for (const auto& [u, v] : long_walls) {
      poller_.step();
      if (t_.vertices() >= announced) {
        announced = 2 * t_.vertices();
        constexpr std::uint64_t kBytes = 300;
        require(other_bytes_ + kBytes * announced, context_);
      }
      halve(u, v, changed);
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  }
}

// Adds the new triangles to `changed`: none if the wall is halved already, or too short for its
// middle to differ from its ends.
void Axis::halve(Vertex u, Vertex v, std::vector<std::uint32_t>& changed) {
  Edge edge = t_.find_edge(u, v);
  if (edge.face == kNone) return;
  const Edge behind = t_.mirror(edge);
  const Vertex to = t_.left(edge);
  const Point r = t_.at(t_.right(edge)), l = t_.at(to);
  const Point near = t_.at(t_.apex(edge)), far = t_.at(t_.apex(behind));
  const Point p = middle(r, l);
  if (orientation(near, r, p) <= 0 || orientation(near, p, l) <= 0 || orientation(far, p, r) <= 0 ||
      orientation(far, l, p) <= 0)
    return;
  const std::uint8_t sides[2] = {inside_[edge.face], inside_[behind.face]};
  const std::uint32_t wall = constraints_[t_.constraint(edge)].segment;
  const auto id = static_cast<std::uint32_t>(t_.vertices());
  // After the insertion these numbers may be those of triangles on the other side.
  const auto faces = static_cast<std::uint32_t>(t_.faces());
  const std::uint32_t split[4] = {edge.face, behind.face, faces, faces + 1};
  const Vertex w = t_.insert(p, id, {Triangulation::At::kEdge, edge});
  inside_.resize(t_.faces());
  for (const std::uint32_t f : split) inside_[f] = kUnknown;
  wall_.resize(t_.vertices(), kNone);
  wall_[w] = wall;
  // The triangles around w: from the wall's left half over the near side to its right half, then
  // over the far side.
  edge = t_.find_edge(w, to);
  if (t_.right(edge) != w) edge = t_.mirror(edge);
  int side = 0;
  std::uint32_t face = edge.face;
  do {
    poller_.step();
    inside_[face] = sides[side];
    if (sides[side]) changed.push_back(face);
    const Edge next{face, ccw(t_.index(face, w))};
    if (is_wall(next)) side ^= 1;
    face = t_.mirror(next).face;
  } while (face != edge.face);
  // The middle is rounded, so a triangle that is flat to within rounding may be new and not have
  // the corner w.
  for (bool all_known = false; !all_known;) {
    poller_.step();
    all_known = true;
    for (const std::uint32_t f : split) {
      for (int i = 0; i < 3 && inside_[f] == kUnknown; ++i) {
        const std::uint32_t next = t_.mirror({f, i}).face;
        if (inside_[next] != kUnknown)
          inside_[f] = inside_[next] ^ static_cast<std::uint8_t>(leads_over({f, i}));
      }
      all_known = all_known && inside_[f] != kUnknown;
    }
  }
}

// The lines between the centres of neighbours, the lines through narrow passages, and for each
// component that has none of these the centre of the largest disk in one of its triangles.
std::vector<Line> Axis::collect() {
  constexpr std::uint32_t kSeen = kNone - 1;
  std::vector<Line> axis;
  std::vector<Point> centers;
  std::vector<std::uint32_t> center(t_.faces(), kNone);  // or kSeen if the face has none
  std::vector<std::uint32_t> component;
  for (std::uint32_t first = 0; first < t_.faces(); ++first) {
    poller_.step();
    if (!inside_[first] || center[first] != kNone) continue;
    const std::size_t before = axis.size();
    double largest = -1;
    Point largest_at{};
    component.assign(1, first);
    center[first] = kSeen;
    for (std::size_t k = 0; k < component.size(); ++k) {
      poller_.step();
      const std::uint32_t f = component[k];
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t next = t_.mirror({f, i}).face;
        if (is_wall({f, i}) || center[next] != kNone) continue;
        center[next] = kSeen;
        component.push_back(next);
      }
      const Shape s = shape(f);
      const Point a = s.corner[0], b = s.corner[1], c = s.corner[2];
      const double around = s.side[0] + s.side[1] + s.side[2];
      if (const double inradius = s.area2 / around; inradius > largest) {
        largest = inradius;
        const double to_b = s.side[1] / around, to_c = s.side[2] / around;
        largest_at = {a.x + to_b * (b.x - a.x) + to_c * (c.x - a.x),
                      a.y + to_b * (b.y - a.y) + to_c * (c.y - a.y)};
      }
      if (is_too_narrow(s)) {
        const int i = s.is_wall[0] ? 0 : s.is_wall[1] ? 1 : 2;
        axis.push_back(
            {middle(s.corner[i], s.corner[ccw(i)]), middle(s.corner[i], s.corner[cw(i)])});
      } else if (s.is_on_axis) {
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
        const double to_b = (bx * bx + by * by) / (2 * s.area2);
        const double to_c = (cx * cx + cy * cy) / (2 * s.area2);
        center[f] = static_cast<std::uint32_t>(centers.size());
        centers.push_back(
            inside_box({a.x + (cy * to_b - by * to_c), a.y + (bx * to_c - cx * to_b)}));
      }
    }
    for (const std::uint32_t f : component) {
      poller_.step();
      if (center[f] == kSeen) continue;
      bool is_alone = true;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t next = t_.mirror({f, i}).face;
        if (is_wall({f, i}) || center[next] == kSeen) continue;
        is_alone = false;
        if (f < next) axis.push_back({centers[center[f]], centers[center[next]]});
      }
      if (is_alone) axis.push_back({centers[center[f]], centers[center[f]]});
    }
    if (axis.size() == before) axis.push_back({largest_at, largest_at});
  }
  return axis;
}

}  // namespace

Result<MedialAxis> medial_axis(const Domain& domain, const ExecutionContext& context) {
  try {
    StopPoller poller(context);
    poller.poll();
    MedialAxis result;
    const Pslg walls = walls_of(domain, poller);
    require(domain.bytes() + estimated_bytes(walls.points.size(), walls.segments.size()), context);
    result.walls.reserve(walls.segments.size());
    for (const Segment& s : walls.segments)
      result.walls.push_back({walls.points[s.a], walls.points[s.b]});
    result.axis = Axis(walls, domain.bytes(), context, poller).find();
    return result;
  } catch (Stopped& stopped) {
    return tl::unexpected(std::move(stopped.error));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, "", "the machine has no memory left for the local width");
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInternal, "", std::string("the local width: ") + e.what());
  }
}

}  // namespace weft
