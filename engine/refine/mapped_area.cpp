// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/mapped_area.h"

#include <array>
#include <cmath>
#include <limits>

namespace weft {

void MappedArea::begin(const Box& box) {
  slack_ = 1;
  box_ = Box{};
  if (const auto size = map_.uniform_size(box)) {
    box_ = box;
    size_ = *size;
  }
  grid_ = box;
  cells_per_x_ = kGrid / box.width();
  cells_per_y_ = kGrid / box.height();
  for (Cell& cell : cells_) cell.known = false;
}

MappedArea::Cell& MappedArea::cell_at(Point p) {
  constexpr double kLast = kGrid - 1;
  const auto column =
      static_cast<std::size_t>(std::clamp((p.x - grid_.min_x) * cells_per_x_, 0.0, kLast));
  const auto row =
      static_cast<std::size_t>(std::clamp((p.y - grid_.min_y) * cells_per_y_, 0.0, kLast));
  Cell& cell = cells_[row * kGrid + column];
  if (!cell.known) {
    const double width = 1 / cells_per_x_;
    const double height = 1 / cells_per_y_;
    const double x = grid_.min_x + static_cast<double>(column) * width;
    const double y = grid_.min_y + static_cast<double>(row) * height;
    cell.around = {x - width, y - height, x + 2 * width, y + 2 * height};
    cell.place = map_.locate(cell.around);
    cell.size = map_.uniform_size(cell.place, cell.around).value_or(0);
    cell.known = true;
  }
  return cell;
}

RingVerdict MappedArea::judge_by_cell(const Ring& ring, std::uint32_t first, std::uint32_t last,
                                      Point p, double region_bound, const QualityBounds& quality,
                                      Badness* badness) {
  double farthest2 = 0;
  for (std::uint32_t i = first; i <= last; ++i)
    farthest2 = std::max(farthest2, ring.points[i].length2);
  const Cell& cell = cell_at(p);
  if (const double room = room_in(cell.around, p); room > 0 && farthest2 <= room * room)
      [[likely]] {
    if (cell.size == 0)
      return judge_evaluated(cell.place, ring, first, last, p, region_bound, quality, badness);
    box_ = cell.around;
    size_ = cell.size;
    return judge_ring(ring, first, last, quality, uniform(p, region_bound), badness);
  }
  const double reach = std::sqrt(farthest2);
  const Box ring_box{p.x - reach, p.y - reach, p.x + reach, p.y + reach};
  return judge_evaluated(map_.locate(ring_box), ring, first, last, p, region_bound, quality,
                         badness);
}

RingVerdict MappedArea::judge_evaluated(const SizeMap::Place& place, const Ring& ring,
                                        std::uint32_t first, std::uint32_t last, Point p,
                                        double region_bound, const QualityBounds& quality,
                                        Badness* badness) {
  const std::uint32_t n = last - first;
  const std::size_t lanes = (n + SizeFunction::kLanes - 1) / SizeFunction::kLanes;
  if (lanes > x_.size()) {
    x_.resize(lanes);
    y_.resize(lanes);
    bound_.resize(lanes);
  }
  double* const x = x_.data()->values;
  double* const y = y_.data()->values;
  double* const bound = bound_.data()->values;
  for (std::uint32_t i = 0; i < n; ++i) {
    x[i] = p.x + (ring.points[first + i].x + ring.points[first + i + 1].x) * (1.0 / 3);
    y[i] = p.y + (ring.points[first + i].y + ring.points[first + i + 1].y) * (1.0 / 3);
  }
  // Lanes beyond n are evaluated, too, so they get a point of the domain, the last one again.
  for (std::uint32_t i = n; i % SizeFunction::kLanes != 0; ++i) {
    x[i] = x[n - 1];
    y[i] = y[n - 1];
  }
  function_.evaluate(n, x, y, bound);

  const SizeMap::Node& node = *place.node;
  if (node.may_be_nan || !(node.lo > 0) || !(node.hi < std::numeric_limits<double>::infinity())) {
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!(bound[i] > 0 && bound[i] < std::numeric_limits<double>::infinity()) && !bad_size_) {
        bad_size_ = BadSize{{x[i], y[i]}, &function_};
      }
    }
  }
  const double slack = slack_ == 1 || jumps(bound, n) ? 1 : slack_at(p, bound[0], region_bound);
  for (std::uint32_t i = 0; i < n; ++i)
    bound[i] = 2 * slack * coarseness_ * std::min(bound[i], region_bound);
  const RingVerdict verdict =
      judge_ring(ring, first, last, quality, DoubledBounds{bound, first}, badness);
  if (node.leaf()) return verdict;
  for (std::uint32_t i = first; i < last; ++i) {
    const double area = 0.5 * ring.points[i + 1].cross;
    if (badness[i] >= kLarge || !(area > SizeMap::kFeatureFactor * coarseness_ * node.lowest_hi)) {
      continue;
    }
    const std::array<Point, 3> corners{
        p, Point{p.x + ring.points[i].x, p.y + ring.points[i].y},
        Point{p.x + ring.points[i + 1].x, p.y + ring.points[i + 1].y}};
    if (map_.covers_finer(place, corners, area / coarseness_)) {
      badness[i] = badness_of_size(area, SizeMap::kFeatureFactor * coarseness_ * node.lowest_hi);
    }
  }
  return verdict;
}

bool MappedArea::covers_finer(Point a, Point b, Point c, double area) {
  const Cell& cell = cell_at(a);
  const SizeMap::Place& place = cell.place;
  return !place.node->leaf() &&
         area > SizeMap::kFeatureFactor * coarseness_ * place.node->lowest_hi &&
         map_.covers_finer(place, {a, b, c}, area / coarseness_);
}

double MappedArea::bound_of_piece(Point c) const {
  const double here = function_(c);
  if (!(here > 0 && here < std::numeric_limits<double>::infinity())) return 0;
  const double h = std::sqrt(here);
  Lanes x;
  Lanes y;
  Lanes bound;
  std::fill_n(x.values, SizeFunction::kLanes, c.x);
  std::fill_n(y.values, SizeFunction::kLanes, c.y);
  x.values[0] -= h;
  x.values[1] += h;
  y.values[2] -= h;
  y.values[3] += h;
  function_.evaluate(4, x.values, y.values, bound.values);
  const double* const b = bound.values;
  return (b[0] == here || b[1] == here) && (b[2] == here || b[3] == here) ? here : 0;
}

void MappedArea::bounds_at(std::size_t n, const double* x, const double* y, double* bound) {
  Box around;
  for (std::size_t i = 0; i < n; ++i) around.add({x[i], y[i]});
  if (const auto size = map_.uniform_size(around)) {
    std::fill_n(bound, n, *size);
  } else {
    function_.evaluate(n, x, y, bound);
  }
}

}  // namespace weft
