// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/size/size_map.h"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace weft {
namespace {

using Corners = std::array<Point, 3>;

Corners corners_of(const Domain& domain, std::uint32_t t) {
  const auto& v = domain.triangles[t].vertex;
  return {domain.vertices[v[0]], domain.vertices[v[1]], domain.vertices[v[2]]};
}

Point middle(const Box& box) {
  return {box.min_x + 0.5 * (box.max_x - box.min_x), box.min_y + 0.5 * (box.max_y - box.min_y)};
}

Box child_box(const Box& box, unsigned child) {
  const Point m = middle(box);
  return {child & 1 ? m.x : box.min_x, child & 2 ? m.y : box.min_y, child & 1 ? box.max_x : m.x,
          child & 2 ? box.max_y : m.y};
}

// Whether the open box and the counter-clockwise triangle have a point in common, by separating
// axes.
bool overlap(const Box& box, const Corners& c) {
  Box around;
  for (Point p : c) around.add(p);
  if (around.min_x >= box.max_x || around.max_x <= box.min_x || around.min_y >= box.max_y ||
      around.max_y <= box.min_y) {
    return false;
  }
  for (unsigned i = 0; i < 3; ++i) {
    const Point a = c[i];
    const double dx = c[(i + 1) % 3].x - a.x;
    const double dy = c[(i + 1) % 3].y - a.y;
    // The box's corner that is farthest to the left of a -> b.
    const double x = dy > 0 ? box.min_x : box.max_x;
    const double y = dx > 0 ? box.max_y : box.min_y;
    if (dx * (y - a.y) - dy * (x - a.x) <= 0) return false;
  }
  return true;
}

// Area of the part of a triangle that lies in a box: Sutherland-Hodgman clipping.
double common_area(const Box& box, const Corners& c) {
  std::array<Point, 8> polygon{c[0], c[1], c[2]};
  std::size_t n = 3;
  const auto clip = [&](auto inside) {
    std::array<Point, 8> result;
    std::size_t m = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Point a = polygon[i];
      const Point b = polygon[(i + 1) % n];
      const double da = inside(a);
      const double db = inside(b);
      if (da >= 0) result[m++] = a;
      if ((da >= 0) != (db >= 0)) {
        const double t = da / (da - db);
        result[m++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      }
    }
    polygon = result;
    n = m;
  };
  clip([&](Point p) { return p.x - box.min_x; });
  clip([&](Point p) { return box.max_x - p.x; });
  clip([&](Point p) { return p.y - box.min_y; });
  clip([&](Point p) { return box.max_y - p.y; });
  double doubled = 0;
  for (std::size_t i = 2; i < n; ++i) {
    doubled += (polygon[i - 1].x - polygon[0].x) * (polygon[i].y - polygon[0].y) -
               (polygon[i - 1].y - polygon[0].y) * (polygon[i].x - polygon[0].x);
  }
  return 0.5 * doubled;
}

bool contains(const Box& outer, const Box& inner) {
  return inner.min_x >= outer.min_x && inner.max_x <= outer.max_x && inner.min_y >= outer.min_y &&
         inner.max_y <= outer.max_y;
}

// A node whose fate is to be decided, with the triangles of the domain that it overlaps.
struct Pending {
  std::uint32_t node = 0;
  Box box;
  std::vector<std::uint32_t> triangles;
};

// What a look at a node tells.
struct Look {
  Interval bounds;
  bool split = false;                                 // it is to be split
  std::array<std::vector<std::uint32_t>, 4> overlap;  // the triangles of each child, then
  double area = 0;                                    // common with the domain, otherwise
  std::optional<Error> stopped;
};

// Polls now and then: one box may overlap millions of triangles.
class Poll {
 public:
  explicit Poll(const ExecutionContext& context) : context_(context) {}
  std::optional<Error> operator()() {
    constexpr std::uint32_t kInterval = 1 << 14;
    return ++count_ % kInterval == 0 ? context_.poll() : std::nullopt;
  }

 private:
  const ExecutionContext& context_;
  std::uint32_t count_ = 0;
};

double common_area(const Pending& pending, const Domain& domain) {
  double area = 0;
  for (const std::uint32_t t : pending.triangles)
    area += common_area(pending.box, corners_of(domain, t));
  return area;
}

Look look_at(const Pending& pending, const Expression& size, const Domain& domain, bool may_split,
             Poll& poll) {
  Look look;
  if (pending.triangles.empty()) return look;
  look.bounds = size.bounds(pending.box);
  const bool resolved = !look.bounds.may_be_nan && look.bounds.lo > 0 &&
                        look.bounds.hi <= SizeMap::kResolved * look.bounds.lo;
  const double box_area = pending.box.width() * pending.box.height();
  const bool small = box_area <= SizeMap::kSmallBox * look.bounds.lo;
  look.split = !resolved && !small && may_split;
  for (const std::uint32_t t : pending.triangles) {
    if ((look.stopped = poll())) return look;
    const Corners corners = corners_of(domain, t);
    if (!look.split) {
      look.area += common_area(pending.box, corners);
      continue;
    }
    for (unsigned child = 0; child < 4; ++child) {
      if (overlap(child_box(pending.box, child), corners)) look.overlap[child].push_back(t);
    }
  }
  return look;
}

}  // namespace

Result<SizeMap> SizeMap::build(const Expression& size, const Domain& domain,
                               const ExecutionContext& context) {
  constexpr int kMaxLevels = 48;
  constexpr std::size_t kAtATime = 64;  // nodes
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SizeMap map;
  for (Point p : domain.vertices) map.root_.add(p);
  map.nodes_.push_back({-kInfinity, kInfinity, kInfinity, 0, true, false});

  std::vector<Pending> level{{0, map.root_, {}}};
  level[0].triangles.resize(domain.triangles.size());
  std::iota(level[0].triangles.begin(), level[0].triangles.end(), 0u);
  for (int depth = 0; !level.empty(); ++depth) {
    if (auto error = context.poll()) return tl::unexpected(*error);
    // The looks on many threads; what comes of them in order.
    std::vector<Look> looks(level.size());
    context.for_each((level.size() + kAtATime - 1) / kAtATime, [&](std::size_t group) {
      Poll poll(context);
      const std::size_t end = std::min((group + 1) * kAtATime, level.size());
      for (std::size_t i = group * kAtATime; i < end; ++i)
        looks[i] = look_at(level[i], size, domain, depth < kMaxLevels, poll);
    });
    std::vector<Pending> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      Look& look = looks[i];
      if (look.stopped) return tl::unexpected(*look.stopped);
      if (level[i].triangles.empty()) continue;
      const Interval& bounds = look.bounds;
      Node& node = map.nodes_[level[i].node];
      node = {bounds.lo, bounds.hi, bounds.hi, 0, bounds.may_be_nan, true};
      if (look.split && map.nodes_.size() + 4 <= kMaxNodes) {
        const auto first = static_cast<std::uint32_t>(map.nodes_.size());
        node.first_child = first;
        for (unsigned child = 0; child < 4; ++child) {
          map.nodes_.push_back({-kInfinity, kInfinity, kInfinity, 0, true, false});
          next.push_back(
              {first + child, child_box(level[i].box, child), std::move(look.overlap[child])});
        }
        continue;
      }
      const double area = look.split ? common_area(level[i], domain) : look.area;
      if (bounds.lo > 0 && !bounds.may_be_nan) map.least_triangles_ += area / bounds.hi;
      const double guess = bounds.lo > 0 ? std::sqrt(bounds.lo) * std::sqrt(bounds.hi) : bounds.hi;
      if (guess > 0) map.likely_triangles_ += area / guess;
    }
    level = std::move(next);
  }
  // Children come after their parents.
  for (std::size_t i = map.nodes_.size(); i-- > 0;) {
    Node& node = map.nodes_[i];
    if (node.leaf()) continue;
    node.lowest_hi = kInfinity;
    for (unsigned child = 0; child < 4; ++child) {
      node.lowest_hi = std::min(node.lowest_hi, map.nodes_[node.first_child + child].lowest_hi);
    }
  }
  return map;
}

SizeMap::Place SizeMap::locate(const Box& box) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Box wanted = inside_root(box);
  const Node* node = nodes_.data();
  Box at = root_;
  while (!node->leaf()) {
    const Point m = middle(at);
    const unsigned child = (wanted.min_x >= m.x ? 1 : 0) | (wanted.min_y >= m.y ? 2 : 0);
    const Box smaller = child_box(at, child);
    if (!contains(smaller, wanted)) break;
    at = smaller;
    node = &nodes_[node->first_child + child];
  }
  if (at.min_x == root_.min_x) at.min_x = -kInfinity;
  if (at.min_y == root_.min_y) at.min_y = -kInfinity;
  if (at.max_x == root_.max_x) at.max_x = kInfinity;
  if (at.max_y == root_.max_y) at.max_y = kInfinity;
  return {node, at};
}

Box SizeMap::inside_root(const Box& box) const {
  return {std::max(box.min_x, root_.min_x), std::max(box.min_y, root_.min_y),
          std::min(box.max_x, root_.max_x), std::min(box.max_y, root_.max_y)};
}

std::optional<double> SizeMap::uniform_size(const Place& place, const Box& box) const {
  double size = 0;
  if (!uniform_below(*place.node, inside_root(place.box), box, size) || size == 0) {
    return std::nullopt;
  }
  return size;
}

bool SizeMap::uniform_below(const Node& node, const Box& at, const Box& box, double& size) const {
  if (node.leaf()) {
    if (!node.meets_domain) return true;
    if (!node.constant() || (size != 0 && size != node.lo)) return false;
    size = node.lo;
    return true;
  }
  const Point m = middle(at);
  for (unsigned child = 0; child < 4; ++child) {
    const bool meets = (child & 1 ? box.max_x >= m.x : box.min_x <= m.x) &&
                       (child & 2 ? box.max_y >= m.y : box.min_y <= m.y);
    if (meets && !uniform_below(nodes_[node.first_child + child], child_box(at, child), box, size))
      return false;
  }
  return true;
}

bool SizeMap::covers_finer(const Place& place, const std::array<Point, 3>& corners,
                           double area) const {
  return finer_below(*place.node, inside_root(place.box), corners, area);
}

bool SizeMap::finer_below(const Node& node, const Box& at, const std::array<Point, 3>& corners,
                          double area) const {
  if (!(area > kFeatureFactor * node.lowest_hi) || !overlap(at, corners)) return false;
  if (node.leaf()) return true;
  for (unsigned child = 0; child < 4; ++child) {
    if (finer_below(nodes_[node.first_child + child], child_box(at, child), corners, area))
      return true;
  }
  return false;
}

}  // namespace weft
