// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/seeded.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "client/formats/domains/interior_point.h"

namespace weft::client {
namespace {

using Segment = Domain::Segment;

// Merges points that coincide. The first one keeps its marker.
void join_points(Domain& domain) {
  std::vector<std::uint32_t> order(domain.points.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Point a = domain.points[i];
    const Point b = domain.points[j];
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : i < j;
  });
  std::vector<std::uint32_t> first(order.size());  // of those that coincide
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && domain.points[order[k]] == domain.points[order[k - 1]]
                          ? first[order[k - 1]]
                          : order[k];
  std::vector<std::uint32_t> kept(order.size());
  std::vector<Point> points;
  std::vector<std::int32_t> markers;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (first[i] != i) continue;
    kept[i] = static_cast<std::uint32_t>(points.size());
    points.push_back(domain.points[i]);
    if (!domain.point_markers.empty()) markers.push_back(domain.point_markers[i]);
  }
  for (Segment& segment : domain.segments) {
    segment.a = kept[first[segment.a]];
    segment.b = kept[first[segment.b]];
  }
  domain.points = std::move(points);
  domain.point_markers = std::move(markers);
}

// Segments as pairs of ends. Those that occur an odd number of times bound what is filled.
struct Parity {
  std::vector<Segment> bounding;
  std::vector<Segment> inside;
};

Parity by_parity(std::vector<Segment> segments) {
  const auto ends = [](const Segment& s) { return std::minmax(s.a, s.b); };
  std::stable_sort(segments.begin(), segments.end(),
                   [&ends](const Segment& s, const Segment& t) { return ends(s) < ends(t); });
  Parity out;
  for (std::size_t i = 0; i < segments.size();) {
    std::size_t end = i;
    std::int32_t marker = 0;  // the first that is not 0
    for (; end < segments.size() && ends(segments[end]) == ends(segments[i]); ++end)
      if (marker == 0) marker = segments[end].marker;
    (((end - i) % 2 == 1) ? out.bounding : out.inside)
        .push_back({segments[i].a, segments[i].b, marker});
    i = end;
  }
  return out;
}

// Orders segments ring by ring, so that no ring visits a point twice. REQUIRES: an even number of
// them meets at each point.
std::vector<PolygonRange> order_by_ring(std::size_t points, std::vector<Segment>& segments) {
  std::vector<std::uint32_t> starts(points + 1, 0);
  for (const Segment& s : segments) ++starts[s.a + 1], ++starts[s.b + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::uint32_t> at_point(2 * segments.size());
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  for (std::uint32_t i = 0; i < segments.size(); ++i)
    for (const std::uint32_t p : {segments[i].a, segments[i].b}) at_point[next[p]++] = i;
  std::copy(starts.begin(), starts.end() - 1, next.begin());

  std::vector<PolygonRange> rings;
  std::vector<Segment> ordered;
  std::vector<bool> used(segments.size(), false);
  constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(points, kNowhere);         // of a point on the path
  std::vector<std::pair<std::uint32_t, std::uint32_t>> path;  // point, segment that leaves it
  for (std::uint32_t start = 0; start < points; ++start) {
    std::uint32_t at = start;
    for (;;) {
      if (place[at] != kNowhere) {  // the path has come back to one of its points
        const std::size_t first = ordered.size();
        const std::size_t ring = place[at];
        for (std::size_t k = ring; k < path.size(); ++k) {
          ordered.push_back(segments[path[k].second]);
          place[path[k].first] = kNowhere;
        }
        rings.push_back({first, ordered.size()});
        path.resize(ring);
      }
      while (next[at] < starts[at + 1] && used[at_point[next[at]]]) ++next[at];
      if (next[at] == starts[at + 1]) break;
      const std::uint32_t segment = at_point[next[at]];
      used[segment] = true;
      place[at] = static_cast<std::uint32_t>(path.size());
      path.emplace_back(at, segment);
      at = segments[segment].a == at ? segments[segment].b : segments[segment].a;
    }
    for (const auto& [point, segment] : path) {
      ordered.push_back(segments[segment]);
      place[point] = kNowhere;
    }
    path.clear();
  }
  segments = std::move(ordered);
  return rings;
}

}  // namespace

Result<Domain> seeded(Domain domain) {
  if (domain.fill == Domain::Fill::kSeeds) return domain;
  join_points(domain);
  Parity parity = by_parity(std::move(domain.segments));
  const std::vector<PolygonRange> rings = order_by_ring(domain.points.size(), parity.bounding);

  domain.segments = parity.bounding;
  for (int time = 0; time < 2; ++time)
    domain.segments.insert(domain.segments.end(), parity.inside.begin(), parity.inside.end());
  const auto holes = hole_points(domain, rings);
  if (!holes) return tl::unexpected(holes.error());
  for (const auto& hole : *holes)
    if (hole) domain.holes.push_back(*hole);
  domain.segments.resize(parity.bounding.size() + parity.inside.size());
  domain.fill = Domain::Fill::kSeeds;
  domain.point_places = {};
  domain.segment_places = {};
  return domain;
}

}  // namespace weft::client
