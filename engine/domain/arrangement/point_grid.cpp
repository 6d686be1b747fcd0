// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/point_grid.h"

#include <cmath>
#include <cstddef>

namespace weft {

PointGrid::PointGrid(double radius)
    : radius_(radius), cells_per_unit_(0.5 / radius), first_(64, kNone) {}

std::int64_t PointGrid::cell(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate * cells_per_unit_));
}

// The finaliser of S. Vigna's splitmix64.
std::size_t PointGrid::bucket(std::int64_t x, std::int64_t y) const {
  std::uint64_t h =
      static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(y);
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  return (h ^ h >> 31) & (first_.size() - 1);
}

void PointGrid::link(std::uint32_t entry) {
  Entry& e = entries_[entry];
  std::uint32_t& first = first_[bucket(cell(e.at.x), cell(e.at.y))];
  e.next = first;
  first = entry;
}

void PointGrid::insert(std::uint32_t index, Point p) {
  entries_.push_back({p, index, kNone});
  if (entries_.size() <= first_.size())
    return link(static_cast<std::uint32_t>(entries_.size() - 1));
  first_.assign(2 * first_.size(), kNone);
  for (std::uint32_t entry = 0; entry < entries_.size(); ++entry) link(entry);
}

std::uint32_t PointGrid::nearest(Point p) const {
  double best2 = radius_ * radius_;
  std::uint32_t best = kNone;
  const std::int64_t last_x = cell(p.x + radius_), last_y = cell(p.y + radius_);
  for (std::int64_t x = cell(p.x - radius_); x <= last_x; ++x) {
    for (std::int64_t y = cell(p.y - radius_); y <= last_y; ++y) {
      for (std::uint32_t entry = first_[bucket(x, y)]; entry != kNone;
           entry = entries_[entry].next) {
        const Entry& e = entries_[entry];
        const double dx = e.at.x - p.x, dy = e.at.y - p.y;
        const double distance2 = dx * dx + dy * dy;
        const bool nearer =
            distance2 < best2 || (distance2 == best2 && best != kNone && e.index < best);
        if (!nearer) continue;
        best2 = distance2;
        best = e.index;
      }
    }
  }
  return best;
}

}  // namespace weft
