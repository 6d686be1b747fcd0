// SPDX-License-Identifier: Apache-2.0
// Where points of a domain in longitude and latitude lie on the inside of its segments. A plane
// bends what is straight in degrees, so what only touches there comes apart, as a corner in the
// middle of the neighbour's wall does; a segment that has the point is divided at it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "files/formats/domain.h"
#include "files/geo/lonlat_extent.h"

namespace weft::files {

class SegmentTouches {
 public:
  // `snap`: metres, above 0. The others are used as long as this lives; points that `lonlat` gets
  // later are not looked for.
  SegmentTouches(const std::vector<Point>& lonlat, const LonLatExtent& extent, double snap);
  ~SegmentTouches();

  // The points of `lonlat` within `snap` of the segment between two of them, and further from its
  // ends, in the order from a to b; of several as near to each other, one. None for a segment that
  // the plane bends by less than a quarter of a millimetre.
  std::vector<std::uint32_t> on(std::uint32_t a, std::uint32_t b);
  // How many pairs of a point and a segment have been looked at.
  std::size_t looked_at() const { return looked_at_; }

 private:
  struct Tree;
  const std::vector<Point>& lonlat_;
  const LonLatExtent& extent_;
  const double near_;  // degrees of latitude
  const std::size_t points_;
  std::unique_ptr<const Tree> tree_;  // of the distinct places; null until a segment needs it
  std::size_t looked_at_ = 0;
};

}  // namespace weft::files
