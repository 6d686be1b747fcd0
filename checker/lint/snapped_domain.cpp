// SPDX-License-Identifier: Apache-2.0
#include "checker/lint/snapped_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "checker/domain/tolerance.h"

namespace weft::check {
namespace {

// Places in cells as wide as the merging distance, so few in each, because they are farther apart.
class PlaceGrid {
 public:
  explicit PlaceGrid(double width) : width_(width > 0 ? width : 1) {}

  // The nearest place within the width.
  std::optional<std::uint32_t> find(Vec2 p, const std::vector<Vec2>& places) const {
    std::optional<std::uint32_t> found;
    double least = std::numeric_limits<double>::infinity();
    const Cell at = cell_of(p);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto [first, last] = cells_.equal_range({at.x + dx, at.y + dy});
        for (auto it = first; it != last; ++it) {
          const double d = distance(p, places[it->second]);
          if (d > width_ || d > least || (d == least && found < it->second)) continue;
          least = d;
          found = it->second;
        }
      }
    return found;
  }
  void add(Vec2 p, std::uint32_t place) { cells_.emplace(cell_of(p), place); }

 private:
  struct Cell {
    std::int64_t x, y;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      return static_cast<std::size_t>(cell.x) * 0x9e3779b97f4a7c15u ^
             static_cast<std::size_t>(cell.y) * 0xc2b2ae3d27d4eb4fu;
    }
  };
  // Cells number 2^41 across at most, because the width is 2^-40 of the largest coordinate or more.
  Cell cell_of(Vec2 p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / width_)),
            static_cast<std::int64_t>(std::floor(p.y / width_))};
  }

  double width_;
  std::unordered_multimap<Cell, std::uint32_t, Hash> cells_;
};

void merge_points(const Domain& domain, SnappedDomain& out) {
  PlaceGrid grid(out.merging);
  out.place_of.reserve(domain.points.size());
  for (std::uint32_t i = 0; i < domain.points.size(); ++i) {
    const Vec2 p = domain.points[i];
    auto place = grid.find(p, out.places);
    if (!place) {
      place = static_cast<std::uint32_t>(out.places.size());
      out.places.push_back(p);
      out.point_at.push_back(i);
      grid.add(p, *place);
    }
    out.place_of.push_back(*place);
  }
}

void list_ends(SnappedDomain& out) {
  out.first_end.assign(out.places.size() + 1, 0);
  for (const auto [a, b] : out.segments) ++out.first_end[a + 1], ++out.first_end[b + 1];
  std::partial_sum(out.first_end.begin(), out.first_end.end(), out.first_end.begin());
  out.ends.resize(2 * out.segments.size());
  out.reach.assign(out.places.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> next = out.first_end;
  for (std::uint32_t s = 0; s < out.segments.size(); ++s)
    for (const std::uint32_t end : out.segments[s]) {
      out.ends[next[end]++] = s;
      out.reach[end] = std::min(out.reach[end], out.length(s));
    }
}

}  // namespace

double distance(Vec2 p, Vec2 q) {
  return std::hypot(q.x - p.x, q.y - p.y);
}

double SnappedDomain::length(std::uint32_t segment) const {
  return distance(from(segment), to(segment));
}

SnappedDomain snapped(const Domain& domain) {
  SnappedDomain out;
  out.merging = merging_distance(domain);
  out.rounding = 0x1p-40 * largest_coordinate(domain);
  merge_points(domain, out);
  for (std::uint32_t s = 0; s < domain.segments.size(); ++s) {
    const std::uint32_t a = out.place_of[domain.segments[s][0]];
    const std::uint32_t b = out.place_of[domain.segments[s][1]];
    if (a == b) continue;
    out.segments.push_back({a, b});
    out.origin.push_back(s);
    out.areas.push_back(domain.segment_areas.empty() ? 0 : domain.segment_areas[s]);
  }
  list_ends(out);
  if (!out.places.empty()) {
    Box box = box_of(out.places[0], out.places[0]);
    for (const Vec2 p : out.places) box.add(box_of(p, p));
    out.extent = std::max(box.max_x - box.min_x, box.max_y - box.min_y);
  }
  return out;
}

BoxTree tree_of_segments(const SnappedDomain& snapped) {
  std::vector<Box> boxes;
  boxes.reserve(snapped.segments.size());
  for (std::uint32_t s = 0; s < snapped.segments.size(); ++s)
    boxes.push_back(box_of(snapped.from(s), snapped.to(s)));
  return BoxTree(std::move(boxes));
}

}  // namespace weft::check
