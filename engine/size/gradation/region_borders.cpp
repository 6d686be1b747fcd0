// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/region_borders.h"

#include <sleef.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace weft {
namespace {

// The least of each group of bounds, from the least on.
std::vector<double> groups_of(std::vector<double> bounds) {
  constexpr double kSame = 1.04 * 1.04;  // as areas
  std::sort(bounds.begin(), bounds.end());
  std::vector<double> groups;
  if (bounds.empty()) return groups;
  const double range =
      Sleef_cinz_logd1_u10purec(bounds.back()) - Sleef_cinz_logd1_u10purec(bounds.front());
  const double apart = std::max(kSame, Sleef_cinz_expd1_u10purec(range / (kMaxRegionBorders - 1)));
  for (const double bound : bounds)
    if (groups.empty() || bound > apart * groups.back()) groups.push_back(bound);
  return groups;
}

}  // namespace

std::vector<RegionBorders> region_borders(const Domain& domain) {
  std::vector<double> bounds;
  for (const Region& region : domain.regions)
    if (std::isfinite(region.max_area)) bounds.push_back(region.max_area);
  const std::vector<double> groups = groups_of(std::move(bounds));
  std::vector<RegionBorders> borders;
  for (const double group : groups) borders.push_back({group, {}});

  // The group of each region; those without a bound come last.
  std::vector<std::size_t> group_of;
  for (const Region& region : domain.regions)
    group_of.push_back(std::isfinite(region.max_area)
                           ? static_cast<std::size_t>(
                                 std::upper_bound(groups.begin(), groups.end(), region.max_area) -
                                 groups.begin() - 1)
                           : groups.size());
  std::size_t last = 0;
  for (const Domain::Triangle& t : domain.triangles) last = std::max(last, group_of[t.region]);
  borders.resize(std::min(borders.size(), last));
  for (const Domain::Triangle& t : domain.triangles) {
    const std::size_t group = group_of[t.region];
    if (group >= borders.size()) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t beside = t.neighbor[k];
      if (beside != kNone && group_of[domain.triangles[beside].region] <= group) continue;
      borders[group].lines.push_back(
          {domain.vertices[t.vertex[(k + 1) % 3]], domain.vertices[t.vertex[(k + 2) % 3]]});
    }
  }
  std::erase_if(borders, [](const RegionBorders& of) { return of.lines.empty(); });
  return borders;
}

}  // namespace weft
