// SPDX-License-Identifier: Apache-2.0
#include "files/geo/segment_touches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace weft::files {
namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::d2::point_xy<double>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::uint32_t>;

}  // namespace

struct SegmentTouches::Tree : bg::index::rtree<Entry, bg::index::quadratic<16>> {
  using rtree::rtree;
};

SegmentTouches::SegmentTouches(const std::vector<Point>& lonlat, const LonLatExtent& extent,
                               double snap)
    : lonlat_(lonlat), extent_(extent), near_(snap / kMetresPerDegree), points_(lonlat.size()) {}

SegmentTouches::~SegmentTouches() = default;

std::vector<std::uint32_t> SegmentTouches::on(std::uint32_t a, std::uint32_t b) {
  const Point from{extent_.unwrapped(lonlat_[a].x), lonlat_[a].y};
  const Point d{longitude_step(from.x, lonlat_[b].x), lonlat_[b].y - from.y};
  const double length = std::sqrt(d.x * d.x + d.y * d.y);
  constexpr double kBent = 1e-6;  // square degrees
  if (!(length > 2 * near_ && length * turn_of_segment(lonlat_[a], lonlat_[b]) >= kBent)) return {};
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
      const double across = near_ / longitude_scale(y);
      entries.push_back({{{x - across, y - near_}, {x + across, y + near_}}, i});
    }
    tree_ = std::make_unique<const Tree>(entries);
  }
  std::vector<std::pair<double, std::uint32_t>> found;  // how far along, 0 to 1, and which
  const auto look_at = [&](std::uint32_t point) {
    ++looked_at_;
    const Point at = lonlat_[point];
    const double scale = longitude_scale(at.y);
    const Point way{d.x * scale, d.y};
    const Point e{longitude_step(from.x, extent_.unwrapped(at.x)) * scale, at.y - from.y};
    const double on_ground = std::sqrt(way.x * way.x + way.y * way.y);
    const double along = (e.x * way.x + e.y * way.y) / on_ground;
    if (along > near_ && along < on_ground - near_ &&
        std::abs(e.x * way.y - e.y * way.x) / on_ground <= near_)
      found.emplace_back(along / on_ground, point);
  };
  // A segment may go on beyond the longitudes that points have been given.
  const double reach = near_ / longitude_scale(90);
  for (const double round : {-360., 0., 360.}) {
    const double x = from.x + round;
    if (std::max(x, x + d.x) < extent_.west - reach ||
        std::min(x, x + d.x) > extent_.west + 360 + reach)
      continue;
    const bg::model::segment<TreePoint> segment{{x, from.y}, {x + d.x, from.y + d.y}};
    for (auto entry = tree_->qbegin(bg::index::intersects(segment)); entry != tree_->qend();
         ++entry)
      look_at(entry->second);
  }
  std::ranges::sort(found);
  std::vector<std::uint32_t> points;
  for (const auto& [along, point] : found)
    if (points.empty() || distance_deg(lonlat_[points.back()], lonlat_[point]) > near_)
      points.push_back(point);
  return points;
}

}  // namespace weft::files
