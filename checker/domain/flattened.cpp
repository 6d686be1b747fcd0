// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/flattened.h"

#include <cmath>
#include <numbers>

#include "checker/domain/domain_rules.h"
#include "checker/geometry/circular_arc.h"

namespace weft::check {

StraightDomain straight_domain(const Domain& given, const std::vector<Vec2>& added,
                               const std::vector<SegmentPiece>& pieces) {
  StraightDomain result;
  Domain& domain = result.domain;
  domain.points = given.points;
  domain.points.insert(domain.points.end(), added.begin(), added.end());
  domain.holes = given.holes;
  domain.regions = given.regions;
  domain.areas = given.areas;
  domain.fill = given.fill;
  domain.snap = given.snap;
  for (const SegmentPiece& piece : pieces) {
    domain.segments.push_back({piece.from, piece.to});
    if (!given.markers.empty()) domain.markers.push_back(given.markers[piece.segment]);
    if (!given.segment_areas.empty())
      domain.segment_areas.push_back(given.segment_areas[piece.segment]);
    result.origin.push_back(piece.segment);
  }
  return result;
}

std::vector<double> bulges_of(const Domain& domain) {
  std::vector<double> bulges(domain.segments.size(), 0.0);
  for (const Arc& arc : domain.arcs)
    if (arc.segment < bulges.size() && is_bulge(arc.bulge)) bulges[arc.segment] = arc.bulge;
  return bulges;
}

std::uint32_t pieces_of(double turn, double most) {
  const double pieces = std::ceil(turn * (180 / std::numbers::pi) / most * (1 - 1e-9));
  return pieces < 1 ? 1 : static_cast<std::uint32_t>(pieces);
}

std::vector<Vec2> flattened(Vec2 from, Vec2 to, double bulge) {
  std::vector<Vec2> points;
  if (bulge == 0 || from == to) return points;
  const CircularArc arc(from, to, bulge);
  const std::uint32_t pieces = pieces_of(arc.turn(), 2);
  for (std::uint32_t k = 1; k < pieces; ++k) points.push_back(arc.at(arc.turn() * k / pieces));
  return points;
}

StraightDomain flattened(const Domain& domain) {
  const std::vector<double> bulges = bulges_of(domain);
  std::vector<Vec2> added;
  std::vector<SegmentPiece> pieces;
  for (std::uint32_t s = 0; s < domain.segments.size(); ++s) {
    auto [from, to] = domain.segments[s];
    for (const Vec2 p : flattened(domain.points[from], domain.points[to], bulges[s])) {
      const auto next = static_cast<std::uint32_t>(domain.points.size() + added.size());
      added.push_back(p);
      pieces.push_back({s, from, next});
      from = next;
    }
    pieces.push_back({s, from, to});
  }
  return straight_domain(domain, added, pieces);
}

}  // namespace weft::check
