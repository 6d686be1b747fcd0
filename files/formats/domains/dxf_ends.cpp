// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_ends.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

namespace weft::files {
namespace {

struct Extent {
  double left = std::numeric_limits<double>::infinity();
  double bottom = left;
  double right = -left;
  double top = -left;
  bool is_finite = true;

  explicit Extent(const std::vector<DxfShape>& shapes) {
    for (const DxfShape& shape : shapes)
      for (const ArcChain& ring : shape.rings)
        for (const Point p : ring.points) {
          is_finite = is_finite && std::isfinite(p.x) && std::isfinite(p.y);
          left = std::min(left, p.x);
          right = std::max(right, p.x);
          bottom = std::min(bottom, p.y);
          top = std::max(top, p.y);
        }
  }
  double size() const { return std::max(right - left, top - bottom); }
};

// Positions in squares of the size of the reach.
class Positions {
 public:
  Positions(const Extent& extent, double reach)
      : left_(extent.left), bottom_(extent.bottom), reach_(reach) {}

  void add(Point p) { squares_[square(column(p), row(p))].push_back(p); }
  std::optional<Point> nearest(Point p, double within) const {
    std::optional<Point> best;
    double least = std::min(reach_, within);
    for (std::int64_t i = column(p) - 1; i <= column(p) + 1; ++i)
      for (std::int64_t j = row(p) - 1; j <= row(p) + 1; ++j) {
        const auto found = squares_.find(square(i, j));
        if (found == squares_.end()) continue;
        for (const Point other : found->second)
          if (const double gap = std::hypot(other.x - p.x, other.y - p.y); gap < least) {
            least = gap;
            best = other;
          }
      }
    return best;
  }

 private:
  std::int64_t column(Point p) const { return static_cast<std::int64_t>((p.x - left_) / reach_); }
  std::int64_t row(Point p) const { return static_cast<std::int64_t>((p.y - bottom_) / reach_); }
  static std::uint64_t square(std::int64_t i, std::int64_t j) {
    return static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(j);
  }

  double left_, bottom_, reach_;
  std::unordered_map<std::uint64_t, std::vector<Point>> squares_;
};

bool is_computed(const DxfShape& shape) {
  return shape.kind == DxfShape::Kind::kLine && shape.has_computed_ends;
}

bool is_open(const DxfShape& line) {
  const std::vector<Point>& points = line.rings[0].points;
  return points.size() > 1 && points.front() != points.back();
}

}  // namespace

void join_ends(std::vector<DxfShape>& shapes) {
  const Extent extent(shapes);
  const double reach = 1e-9 * extent.size();
  if (!(extent.is_finite && reach > 0 && std::isfinite(reach)) ||
      std::ranges::none_of(shapes, is_computed))
    return;
  Positions positions(extent, reach);
  Point last{extent.left - extent.size(), 0};  // no position
  const auto add = [&](Point p) {
    if (p != last) positions.add(p);
    last = p;
  };
  for (const DxfShape& shape : shapes)
    if (shape.kind == DxfShape::Kind::kLine && !shape.has_computed_ends)
      for (const Point p : shape.rings[0].points) add(p);
  for (DxfShape& shape : shapes) {
    if (!is_computed(shape) || !is_open(shape)) continue;
    Point& first = shape.rings[0].points.front();
    Point& end = shape.rings[0].points.back();
    const double within = 1e-3 * std::hypot(end.x - first.x, end.y - first.y);
    const Point to_first = positions.nearest(first, within).value_or(first);
    const Point to_end = positions.nearest(end, within).value_or(end);
    first = to_first;
    end = to_end;
    positions.add(first);
    positions.add(end);
  }
}

std::vector<bool> straighten_degenerate(std::vector<DxfShape>& shapes) {
  const double least = 1e-12 * Extent(shapes).size();
  std::vector<bool> found(shapes.size(), false);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    for (auto& [points, bulges] : shapes[s].rings)
      for (std::size_t i = 0; i + 1 < bulges.size(); ++i) {
        const Point a = points[i], b = points[i + 1];
        const bool is_sound = std::hypot(b.x - a.x, b.y - a.y) > least &&
                              std::abs(bulges[i]) <= Domain::Arc::kMaxBulge;
        if (is_sound || bulges[i] == 0 || a == b) continue;
        bulges[i] = 0;
        found[s] = true;
      }
  return found;
}

}  // namespace weft::files
