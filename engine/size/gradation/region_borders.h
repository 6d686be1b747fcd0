// SPDX-License-Identifier: Apache-2.0
// The borders of regions that have their own bound on areas. With a gradation, the size outside
// such a region grows from these lines (field_size.h).
#pragma once

#include <cstddef>
#include <vector>

#include "engine/domain/domain.h"
#include "engine/size/fields/distance_field.h"

namespace weft {

// The borders of all regions with about the same bound to what has a larger one or none, and to the
// outside: no point of a region with this bound is nearer to a point of a larger bound than these
// lines are, unless a region with a smaller one lies between.
struct RegionBorders {
  double max_area = 0;  // the least of the regions'; squared units
  std::vector<Line> lines;
};

// One for each bound, the least first. Bounds that differ by less than 4 % count as one; if there
// would be more than kMaxRegionBorders, so do bounds that differ by more. A bound that no region
// exceeds has none.
inline constexpr std::size_t kMaxRegionBorders = 32;
std::vector<RegionBorders> region_borders(const Domain& domain);

}  // namespace weft
