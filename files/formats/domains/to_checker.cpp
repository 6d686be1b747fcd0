// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/to_checker.h"

namespace weft::files {

check::Domain checker_domain(const Domain& domain, double snap) {
  check::Domain out;
  for (const Point& point : domain.points) out.points.push_back({point.x, point.y});
  for (const Domain::Segment& segment : domain.segments) {
    out.segments.push_back({segment.a, segment.b});
    out.markers.push_back(segment.marker);
  }
  for (const Domain::Arc& arc : domain.arcs) out.arcs.push_back({arc.segment, arc.bulge});
  for (const Point& hole : domain.holes) out.holes.push_back({hole.x, hole.y});
  for (const Domain::Region& region : domain.regions)
    out.regions.push_back({{region.at.x, region.at.y}, region.id, region.max_area});
  for (const Domain::Area& area : domain.areas)
    out.areas.push_back({area.region, 0, area.max_area, area.is_hole});
  if (!domain.areas.empty())
    for (const Domain::Segment& segment : domain.segments)
      out.segment_areas.push_back(segment.area);
  out.fill = domain.fill == Domain::Fill::kSeeds     ? check::Fill::kSeeds
             : domain.fill == Domain::Fill::kEvenOdd ? check::Fill::kEvenOdd
                                                     : check::Fill::kUnion;
  out.snap = snap > 0 ? snap : domain.snap;
  return out;
}

}  // namespace weft::files
