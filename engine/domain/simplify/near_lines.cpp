// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/near_lines.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/triangulation/hilbert.h"

namespace weft {
namespace {

constexpr double kPrecision = 1.0 / 16;  // of a distance
// Of the parts of a triangle: what takes more is far larger than what narrow places hold.
constexpr int kMaxLooks = 4096;

Point middle(Point a, Point b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

// The square of the distance to a box.
double distance2(Point p, const Box& box) {
  const double dx = std::max({box.min_x - p.x, p.x - box.max_x, 0.0});
  const double dy = std::max({box.min_y - p.y, p.y - box.max_y, 0.0});
  return dx * dx + dy * dy;
}

}  // namespace

NearLines::NearLines(const LineGraph& graph, StopPoller& poller) {
  std::vector<Point> middles;
  middles.reserve(graph.lines.size());
  for (const GraphLine& line : graph.lines)
    middles.push_back(middle(graph.points[line.a], graph.points[line.b]));
  for (const std::uint32_t l : hilbert_order(middles, poller))
    lines_.push_back(
        {graph.points[graph.lines[l].a], graph.points[graph.lines[l].b], graph.lines[l].marker});
  while (leaves_ * kLeaf < lines_.size()) leaves_ *= 2;
  box_.resize(2 * leaves_);
  known_.resize(kLeaf * leaves_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    box_[leaves_ + i / kLeaf].add(lines_[i].a);
    box_[leaves_ + i / kLeaf].add(lines_[i].b);
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node)
    for (const std::size_t child : {2 * node, 2 * node + 1})
      if (box_[child].min_x <= box_[child].max_x) box_[node].merge(box_[child]);
}

double NearLines::distance(Point p, double within, Marker marker) const {
  std::size_t line = kNoLine;
  return distance(p, within, marker, 0, line);
}

double NearLines::distance(Point p, double within, Marker marker, double enough,
                           std::size_t& line) const {
  double least = within;
  const auto try_line = [&](std::size_t i) {
    const double off = distance_to_segment(p, lines_[i].a, lines_[i].b);
    if (!(off < least)) return;
    least = off;
    line = i;
  };
  if (line != kNoLine) try_line(line);
  std::array<std::size_t, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = 1;
  while (depth > 0 && least > enough) {
    const std::size_t node = stack[--depth];
    if (!(distance2(p, box_[node]) < least * least)) continue;
    if (node < leaves_) {
      const bool left_is_nearer = distance2(p, box_[2 * node]) < distance2(p, box_[2 * node + 1]);
      stack[depth++] = left_is_nearer ? 2 * node + 1 : 2 * node;
      stack[depth++] = left_is_nearer ? 2 * node : 2 * node + 1;
      continue;
    }
    const std::size_t first = (node - leaves_) * kLeaf;
    for (std::size_t i = first; i < first + kLeaf && i < lines_.size(); ++i)
      if (!marker || *marker == lines_[i].marker) try_line(i);
  }
  return least;
}

std::size_t NearLines::place_of(const Asked& asked) const {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(asked.within);
  for (const Point p : asked.triangle) {
    for (const double c : {p.x, p.y}) {
      hash = 0x9e3779b97f4a7c15 * (hash ^ std::bit_cast<std::uint64_t>(c));
      hash ^= hash >> 32;
    }
  }
  return hash % known_.size();
}

bool NearLines::holds_near(const std::array<Point, 3>& triangle, double within,
                           Marker marker) const {
  Asked asked{triangle, within, marker};
  Asked& known = known_[place_of(asked)];
  if (!known.is_for(asked)) {
    asked.is_near = find_near(asked);
    known = asked;
  }
  return known.is_near;
}

bool NearLines::find_near(const Asked& asked) const {
  const double within = asked.within;
  constexpr double kRounding = 0x1p-50;  // of a sum
  int looks = 0;
  std::size_t line = kNoLine;
  // The distance to one line is convex: no point of a triangle is farther than all corners.
  const auto is_near_line = [&](std::size_t l, const std::array<Point, 3>& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](Point p) {
      return distance_to_segment(p, lines_[l].a, lines_[l].b) <= (1 - kPrecision) * within;
    });
  };
  const auto look = [&](auto&& self, Point a, Point b, Point c) -> bool {
    const Point centre = centroid(a, b, c);
    const double radius = std::sqrt(std::max(
        {weft::distance2(centre, a), weft::distance2(centre, b), weft::distance2(centre, c)}));
    const double off =
        distance(centre, within, asked.marker, within - radius - kRounding * within, line);
    if (off + radius <= within) return true;
    if (off < within && is_near_line(line, {a, b, c})) return true;
    if (off >= within || radius < kPrecision * within || ++looks > kMaxLooks) return false;
    const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    return self(self, ab, bc, ca) && self(self, a, ab, ca) && self(self, ab, b, bc) &&
           self(self, ca, bc, c);
  };
  return look(look, asked.triangle[0], asked.triangle[1], asked.triangle[2]);
}

double NearLines::farthest(Point a, Point b, double within) const {
  if (!(within > 0)) return 0;
  const double most = (1 + kPrecision) * within;
  double found = 0;
  double bound = 0;
  const auto look = [&](auto&& self, Point p, Point q) -> void {
    const Point m = middle(p, q);
    const double half = weft::distance(p, q) / 2;
    const double off = distance(m, most);
    found = std::max(found, off);
    if (off + half <= found) return;
    if (half < kPrecision * within) {
      bound = std::max(bound, off + half);
      return;
    }
    self(self, p, m);
    self(self, m, q);
  };
  look(look, a, b);
  return std::min(within, std::max(found, bound));
}

}  // namespace weft
