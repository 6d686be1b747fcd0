// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_map.h"

#include <array>
#include <cmath>
#include <utility>

#include "engine/size/box_overlap.h"
#include "engine/size/domain_boxes.h"

namespace weft {
namespace {

constexpr Interval kAnything{-std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity(), true};

double expected(double lo, double hi) {
  return lo > 0 ? std::sqrt(lo) * std::sqrt(hi) : hi;
}

bool contains(const Box& outer, const Box& inner) {
  return inner.min_x >= outer.min_x && inner.max_x <= outer.max_x && inner.min_y >= outer.min_y &&
         inner.max_y <= outer.max_y;
}

// A node that is to be looked at: it overlaps at least one triangle of the domain.
struct Pending {
  std::uint32_t node = 0;
  DomainBox at{};  // triangles of the level
};

struct Level {
  std::vector<Pending> nodes;
  std::vector<std::uint32_t> triangles;
};

// The result of looking at a node.
struct Look {
  Interval bounds{};
  bool split = false;
  std::array<DomainBox, 4> children{};  // if it is split
  double area = 0;                      // of what it shares with the domain, if it is not
};

// Nodes that one thread looks at.
struct Group {
  std::vector<Look> looks;
  std::vector<std::uint32_t> triangles;  // those of the children, one after the other
  std::optional<Error> stopped;
};

Result<double> common_area(const Level& level, const DomainBox& at, const Domain& domain,
                           TrianglePoll& poll) {
  double area = 0;
  for (std::uint32_t i = 0; i < at.count; ++i) {
    if (auto error = poll()) return tl::unexpected(std::move(*error));
    area += common_part(at.box, corners_of(domain, level.triangles[at.first + i])).area();
  }
  return area;
}

std::optional<Error> look_at(const Level& level, const DomainBox& at, const SizeFunction& size,
                             const Domain& domain, bool may_split, TrianglePoll& poll,
                             Group& group) {
  Look& look = group.looks.emplace_back();
  look.bounds = size.bounds(at.box);
  const bool resolved = !look.bounds.may_be_nan && look.bounds.lo > 0 &&
                        look.bounds.hi <= SizeMap::kResolved * look.bounds.lo;
  const double box_area = at.box.width() * at.box.height();
  const bool small = box_area <= SizeMap::kSmallBox * look.bounds.lo;
  look.split = !resolved && !small && may_split;
  if (look.split)
    return split(at, level.triangles.data(), domain, poll, look.children, group.triangles);
  const Result<double> area = common_area(level, at, domain, poll);
  if (!area) return area.error();
  look.area = *area;
  return std::nullopt;
}

}  // namespace

Result<SizeMap> SizeMap::build(const SizeFunction& size, const Domain& domain,
                               const ExecutionContext& context) {
  constexpr int kMaxLevels = 48;
  constexpr std::size_t kAtATime = 8;  // nodes: 1 us at least
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr Node kOutside{-kInfinity, kInfinity, kInfinity, 0, true, false};
  SizeMap map;
  for (Point p : domain.vertices) map.root_.add(p);
  map.nodes_.push_back(kOutside);

  Level level;
  if (!domain.triangles.empty())
    level.nodes.push_back({0, whole_domain(domain, map.root_, level.triangles)});
  std::vector<Group> groups;
  for (int depth = 0; !level.nodes.empty(); ++depth) {
    if (auto error = context.poll()) return tl::unexpected(*error);
    // The nodes are looked at on many threads, and the results are used in order.
    groups.resize((level.nodes.size() + kAtATime - 1) / kAtATime);
    context.for_each(groups.size(), [&](std::size_t g) {
      Group& group = groups[g];
      group.looks.clear();
      group.triangles.clear();
      TrianglePoll poll(context);
      const std::size_t end = std::min((g + 1) * kAtATime, level.nodes.size());
      for (std::size_t i = g * kAtATime; i < end && !group.stopped; ++i)
        group.stopped =
            look_at(level, level.nodes[i].at, size, domain, depth < kMaxLevels, poll, group);
    });
    Level next;
    TrianglePoll poll(context);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const Group& group = groups[g];
      if (group.stopped) return tl::unexpected(*group.stopped);
      const auto first = static_cast<std::uint32_t>(next.triangles.size());
      next.triangles.insert(next.triangles.end(), group.triangles.begin(), group.triangles.end());
      for (std::size_t i = 0; i < group.looks.size(); ++i) {
        const Pending& pending = level.nodes[g * kAtATime + i];
        const Look& look = group.looks[i];
        // If no size is defined, any may be meant: the mesh reports where it misses one.
        const Interval& bounds = look.bounds.lo > look.bounds.hi ? kAnything : look.bounds;
        const bool split = look.split && map.nodes_.size() + 4 <= kMaxNodes;
        Node& node = map.nodes_[pending.node];
        node = {bounds.lo, bounds.hi, bounds.hi, 0, bounds.may_be_nan, true};
        if (split) {
          const auto child = node.first_child = static_cast<std::uint32_t>(map.nodes_.size());
          map.nodes_.resize(child + 4, kOutside);
          for (unsigned c = 0; c < 4; ++c) {
            if (look.children[c].count == 0) continue;
            next.nodes.push_back({child + c, look.children[c]});
            next.nodes.back().at.first += first;
          }
          continue;
        }
        double area = look.area;
        if (look.split) {
          const Result<double> found = common_area(level, pending.at, domain, poll);
          if (!found) return tl::unexpected(found.error());
          area = *found;
        }
        if (bounds.lo > 0 && !bounds.may_be_nan) map.triangles_lower_bound_ += area / bounds.hi;
        const double guess = expected(bounds.lo, bounds.hi);
        if (guess > 0) map.expected_triangles_ += area / guess;
      }
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

double SizeMap::expected_size(Point p) const {
  const Place place = locate({p.x, p.y, p.x, p.y});
  return expected(place.node->lo, place.node->hi);
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
  Box around;
  for (const Point p : corners) around.add(p);
  // The smallest node that holds the triangle, unless no node below is finer.
  const Node* node = place.node;
  Box at = inside_root(place.box);
  while (!node->leaf()) {
    if (!(area > kFeatureFactor * node->lowest_hi)) return false;
    const Point m = middle(at);
    const bool right = around.min_x >= m.x;
    const bool upper = around.min_y >= m.y;
    if ((!right && around.max_x > m.x) || (!upper && around.max_y > m.y)) break;
    const unsigned child = (right ? 1u : 0u) | (upper ? 2u : 0u);
    at = child_box(at, child);
    node = &nodes_[node->first_child + child];
  }
  return finer_below(*node, at, corners, area);
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
