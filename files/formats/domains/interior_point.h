// SPDX-License-Identifier: Apache-2.0
// Points strictly inside polygons, away from every segment: the seeds of regions.
//
// A horizontal line through the middle of a gap between vertices is cut where any segment of the
// domain crosses it; the seed is the middle of the widest piece inside the polygon. One sweep over
// the segments serves all polygons.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// The segments of a polygon, rings and holes alike: [first_segment, end_segment) of the domain.
struct PolygonRange {
  std::size_t first_segment = 0;
  std::size_t end_segment = 0;
};

// One point per polygon; nullopt for a polygon without area. Its inside is where rays cross its own
// segments an odd number of times. Fails (kUnreadableInput) if the polygons and segments are so
// many and so tall that the sweep would not end in reasonable time.
Result<std::vector<std::optional<Point>>> interior_points(const Domain& domain,
                                                          std::span<const PolygonRange> polygons);

}  // namespace weft::files
