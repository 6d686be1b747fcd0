// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/three_point_arcs.h"

#include <cmath>
#include <cstddef>

#include "files/base/text.h"

namespace weft::files {
namespace {

std::string text_of(Point at) {
  return coordinates(at.x, at.y);
}

// The angle between the chords to the point between and from there is half of the arc's turn.
double bulge_through(Point a, Point between, Point b) {
  const Point u{between.x - a.x, between.y - a.y};
  const Point v{b.x - between.x, b.y - between.y};
  const double lengths = std::sqrt((u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y));
  return (u.x * v.y - u.y * v.x) / (lengths + u.x * v.x + u.y * v.y);
}

}  // namespace

std::string add_three_point_arcs(std::span<const Point> positions, ArcChain& chain) {
  if (positions.size() % 2 == 0 || positions.size() == 1)
    return "has " + std::to_string(positions.size()) +
           " positions; arcs by three points each have 3, 5, 7, ...";
  chain = ArcChain({positions[0]});
  for (std::size_t i = 0; i + 2 < positions.size(); i += 2) {
    const Point a = positions[i], between = positions[i + 1], b = positions[i + 2];
    if (a == b && a == between) continue;
    if (a == b) {
      chain.add(between, 1);
      chain.add(b, 1);
      continue;
    }
    if (a == between || between == b)
      return "has an arc two of whose points are " + text_of(between);
    const double bulge = bulge_through(a, between, b);
    if (!(std::abs(bulge) <= Domain::Arc::kMaxBulge))
      return "has an arc whose points lie on one line, " + text_of(between) +
             " outside of the others";
    chain.add(b, bulge);
  }
  return "";
}

std::string append(const ArcChain& curve, ArcChain& chain) {
  if (curve.points.empty()) return "";
  if (chain.points.empty()) {
    chain = curve;
    return "";
  }
  if (chain.points.back() != curve.points.front())
    return "has a part that begins at " + text_of(curve.points.front()) +
           ", where the part before it ends at " + text_of(chain.points.back());
  for (std::size_t i = 1; i < curve.points.size(); ++i)
    chain.add(curve.points[i], curve.bulges[i - 1]);
  return "";
}

}  // namespace weft::files
