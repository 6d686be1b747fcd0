// SPDX-License-Identifier: Apache-2.0
#include "files/lint/judged_domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "files/geo/lonlat_extent.h"

namespace weft::files {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// 0, not -0, for what is nearly 0.
double to_1e_9(double value) {
  return std::nearbyint(value * 1e9) / 1e9 + 0.0;
}

void keep_segments(const std::vector<bool>& kept, Domain& domain) {
  std::vector<Domain::Segment> segments;
  Provenance places;
  for (std::size_t s = 0; s < kept.size(); ++s) {
    if (!kept[s]) continue;
    places.add_same(segments.size(), domain.segment_places, s);
    segments.push_back(domain.segments[s]);
  }
  domain.segments = std::move(segments);
  domain.segment_places = std::move(places);
}

// What is a line in degrees and a point on the Earth, such as a pole; and pairs of segments that
// are in two places in degrees, and in one on the Earth, as where a map of all longitudes is cut.
void leave_out_seams(const Domain& degrees, const Domain& plane, std::vector<bool>& kept) {
  using Key = std::array<double, 5>;
  std::map<Key, std::size_t> segment_at;
  for (std::size_t s = 0; s < kept.size(); ++s) {
    const auto& [a, b, marker, area] = degrees.segments[s];
    if (degrees.points[a] != degrees.points[b] && plane.points[a] == plane.points[b])
      kept[s] = false;
    if (area == 0 || std::abs(degrees.points[a].x) < 180 || std::abs(degrees.points[b].x) < 180)
      continue;
    const auto ends = std::minmax({std::pair(plane.points[a].x, plane.points[a].y),
                                   std::pair(plane.points[b].x, plane.points[b].y)});
    const auto [first, is_new] =
        segment_at.emplace(Key{ends.first.first, ends.first.second, ends.second.first,
                               ends.second.second, static_cast<double>(area)},
                           s);
    if (is_new || degrees.points[degrees.segments[first->second].a].x == degrees.points[a].x)
      continue;
    kept[s] = kept[first->second] = false;
  }
}

// Segments end at one point where two in degrees are one place on the Earth.
void join_ends(const Domain& degrees, Domain& plane) {
  std::map<std::pair<double, double>, std::uint32_t> point_at;
  const auto joined = [&](std::uint32_t point) {
    const Point at = degrees.points[point];
    if (std::abs(at.x) < 180 && std::abs(at.y) < 90) return point;
    return point_at.emplace(std::pair(plane.points[point].x, plane.points[point].y), point)
        .first->second;
  };
  for (Domain::Segment& segment : plane.segments) {
    segment.a = joined(segment.a);
    segment.b = joined(segment.b);
  }
}

}  // namespace

Result<JudgedDomain> JudgedDomain::make(const Domain& domain, bool lonlat, bool of_mesh) {
  if (!domain.arcs.empty()) {
    Domain flat = domain;
    if (auto done = flatten_arcs(flat); !done) return tl::unexpected(done.error());
    return make(flat, lonlat, of_mesh);
  }
  JudgedDomain judged;
  judged.domain_ = domain;
  Domain& in_plane = judged.domain_;
  std::vector<bool> kept(domain.segments.size(), true);
  for (std::size_t s = 1; of_mesh && s < kept.size(); ++s)
    kept[s] = !kept[s - 1] || domain.segments[s] != domain.segments[s - 1];
  if (lonlat) {
    const auto extent = lonlat_extent(domain);
    if (!extent) return tl::unexpected(extent.error());
    judged.plane_ = !extent->around        ? Plane::kUnrolled
                    : extent->centre.y < 0 ? Plane::kSouth
                                           : Plane::kNorth;
    judged.east_ = domain.points.front().x;
    for (const Point& p : domain.points) judged.east_ = std::max(judged.east_, p.x);
    if (judged.plane_ == Plane::kUnrolled) {
      const double middle = longitude_scale((extent->south + extent->north) / 2);
      const double nearest_equator = std::clamp(0.0, extent->south, extent->north);
      judged.x_unit_ = kMetresPerDegree * middle;
      judged.greatest_length_ = longitude_scale(nearest_equator) / middle;
    }
    const auto place = [&](Point& p) {
      p.x = extent->unwrapped(p.x);
      if (judged.plane_ == Plane::kUnrolled) {
        p = {p.x * judged.x_unit_, p.y * kMetresPerDegree};
        return;
      }
      const double from_pole =
          kMetresPerDegree * (judged.plane_ == Plane::kNorth ? 90 - p.y : 90 + p.y);
      p = {from_pole * std::cos(p.x * kRadians), from_pole * std::sin(p.x * kRadians)};
    };
    std::ranges::for_each(in_plane.points, place);
    std::ranges::for_each(in_plane.holes, place);
    for (Domain::Region& region : in_plane.regions) place(region.at);
    leave_out_seams(domain, in_plane, kept);
    join_ends(domain, in_plane);
  }
  if (std::ranges::find(kept, false) != kept.end()) keep_segments(kept, in_plane);
  return judged;
}

Point JudgedDomain::in_file(Point at) const {
  if (plane_ == Plane::kFile) return at;
  if (plane_ == Plane::kUnrolled) {
    at = {at.x / x_unit_, at.y / kMetresPerDegree};
  } else {
    const double from_pole = std::hypot(at.x, at.y) / kMetresPerDegree;
    at = {std::atan2(at.y, at.x) / kRadians,
          plane_ == Plane::kNorth ? 90 - from_pole : from_pole - 90};
  }
  while (at.x > east_ + 1e-9) at.x -= 360;
  return {to_1e_9(at.x), to_1e_9(at.y)};
}

}  // namespace weft::files
