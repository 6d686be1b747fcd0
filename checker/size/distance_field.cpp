// SPDX-License-Identifier: Apache-2.0
#include "checker/size/distance_field.h"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "checker/domain/flattened.h"
#include "checker/size/segment_distance.h"
#include "checker/text.h"

namespace weft::check {
namespace {

std::vector<Box> boxes_of(const std::vector<std::array<Vec2, 2>>& pieces) {
  std::vector<Box> boxes;
  boxes.reserve(pieces.size());
  for (const auto& [a, b] : pieces) boxes.push_back(box_of(a, b));
  return boxes;
}

}  // namespace

Distance::Distance(std::vector<Piece> pieces)
    : pieces_(std::move(pieces)), tree_(boxes_of(pieces_)) {}

tl::expected<Distance, std::string> Distance::make(const DistanceField& field,
                                                   const Domain& domain) {
  const bool of_domain = field.points.empty() && field.segments.empty();
  const std::vector<Vec2>& points = of_domain ? domain.points : field.points;
  const auto& segments = of_domain ? domain.segments : field.segments;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y))
      return tl::unexpected(say("point ", i, " is ", points[i]));
  std::set<std::int32_t> missing(field.markers.begin(), field.markers.end());
  const std::set<std::int32_t> wanted = missing;
  const std::vector<double> bulges = of_domain ? bulges_of(domain) : std::vector<double>{};
  std::vector<Piece> pieces;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto [a, b] = segments[s];
    if (a >= points.size() || b >= points.size())
      return tl::unexpected(
          say("segment ", s, " joins points ", a, " and ", b, " of ", points.size()));
    if (of_domain && !wanted.empty()) {
      const std::int32_t marker = s < domain.markers.size() ? domain.markers[s] : 0;
      if (!wanted.contains(marker)) continue;
      missing.erase(marker);
    }
    Vec2 from = points[a];
    if (of_domain)
      for (const Vec2 p : flattened(from, points[b], bulges[s]))
        pieces.push_back({std::exchange(from, p), p});
    pieces.push_back({from, points[b]});
  }
  if (of_domain && !missing.empty())
    return tl::unexpected(say("no segment has the marker ", *missing.begin()));
  if (!of_domain && segments.empty())
    for (const Vec2 p : points) pieces.push_back({p, p});
  if (pieces.empty()) return tl::unexpected(std::string("there is nothing to measure to"));
  return Distance(std::move(pieces));
}

double Distance::operator()(Vec2 p) const {
  double least = std::numeric_limits<double>::infinity();
  tree_.least(p, 1, least, [&](std::uint32_t i) {
    return nearest_on_segment(pieces_[i][0], pieces_[i][1], p).distance;
  });
  return least;
}

}  // namespace weft::check
