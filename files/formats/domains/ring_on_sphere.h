// SPDX-License-Identifier: Apache-2.0
// Rings of longitudes and latitudes, whose segments go the short way round the Earth.
#pragma once

#include <span>
#include <vector>

#include "files/formats/domain.h"

namespace weft::files {

// Whether the first and the last position are the same place, because the ring between them has
// gone once around the Earth; not at a pole, where every longitude is the same place.
bool comes_round(std::span<const Point> ring);

// The ring in a plane, in degrees: longitudes go on beyond 180 where the ring crosses the date
// line. A ring that goes around a pole is closed along that pole. `near` is where the longitude of
// the first position is to be near to.
std::vector<Point> unrolled(std::span<const Point> ring, double near);

// Whether the ring goes around a pole.
bool is_around_pole(std::span<const Point> ring);

}  // namespace weft::files
