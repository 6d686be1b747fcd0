// SPDX-License-Identifier: Apache-2.0
#include "files/geo/segment_touches.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include "files/geo/projection_options.h"

namespace weft::files {
namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::d2::point_xy<double>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::uint32_t>;

constexpr double kTouch = kProjectedSnap / kMetresPerDegree;  // degrees

}  // namespace

struct SegmentTouches::Tree : bg::index::rtree<Entry, bg::index::quadratic<16>> {
  using rtree::rtree;
};

SegmentTouches::SegmentTouches(const std::vector<Point>& lonlat, const LonLatExtent& extent)
    : lonlat_(lonlat), extent_(extent), points_(lonlat.size()) {}

SegmentTouches::~SegmentTouches() = default;

std::vector<std::uint32_t> SegmentTouches::on(std::uint32_t a, std::uint32_t b) {
  const Point from{extent_.unwrapped(lonlat_[a].x), lonlat_[a].y};
  const Point d{longitude_step(from.x, lonlat_[b].x), lonlat_[b].y - from.y};
  const double length = std::sqrt(d.x * d.x + d.y * d.y);
  constexpr double kBent = 1e-6;  // bent by a quarter of a millimetre, at most
  if (!(length * turn_of_segment(lonlat_[a], lonlat_[b]) >= kBent)) return {};
  if (tree_ == nullptr) {
    std::vector<std::uint32_t> order(points_);
    std::iota(order.begin(), order.end(), 0);
    const auto place = [this](std::uint32_t i) {
      return std::pair(extent_.unwrapped(lonlat_[i].x), lonlat_[i].y);
    };
    std::ranges::stable_sort(order, {}, place);
    order.erase(std::unique(order.begin(), order.end(),
                            [&](std::uint32_t i, std::uint32_t j) { return place(i) == place(j); }),
                order.end());
    std::vector<Entry> entries;
    entries.reserve(order.size());
    for (const std::uint32_t i : order) {
      const auto [x, y] = place(i);
      entries.push_back({{{x - kTouch, y - kTouch}, {x + kTouch, y + kTouch}}, i});
    }
    tree_ = std::make_unique<const Tree>(entries);
  }
  std::vector<std::pair<double, std::uint32_t>> found;  // how far along, which
  const auto look_at = [&](const Entry& entry) {
    const Point at = lonlat_[entry.second];
    const Point e{longitude_step(from.x, extent_.unwrapped(at.x)), at.y - from.y};
    near_ += e != Point{} && e != d ? 1 : 0;
    const double along = (e.x * d.x + e.y * d.y) / length;
    if (along > kTouch && along < length - kTouch &&
        std::abs(e.x * d.y - e.y * d.x) / length <= kTouch)
      found.emplace_back(along, entry.second);
  };
  // A segment may go on beyond the longitudes that points have been given.
  for (const double round : {-360., 0., 360.}) {
    const double x = from.x + round;
    if (std::max(x, x + d.x) < extent_.west - kTouch ||
        std::min(x, x + d.x) > extent_.west + 360 + kTouch)
      continue;
    const bg::model::segment<TreePoint> segment{{x, from.y}, {x + d.x, from.y + d.y}};
    for (auto entry = tree_->qbegin(bg::index::intersects(segment)); entry != tree_->qend();
         ++entry)
      look_at(*entry);
  }
  std::ranges::sort(found);
  std::vector<std::uint32_t> points;
  double last = 0;
  for (const auto& [along, point] : found) {
    if (along - last <= kTouch) continue;
    points.push_back(point);
    last = along;
  }
  return points;
}

}  // namespace weft::files
