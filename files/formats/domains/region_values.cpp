// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/region_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace weft::files {
namespace {

bool is_id(double value) {
  return value == std::nearbyint(value) && value >= std::numeric_limits<std::int32_t>::min() &&
         value <= std::numeric_limits<std::int32_t>::max();
}

}  // namespace

RegionIds::RegionIds(std::span<const double> values) {
  std::set<std::int32_t> taken;
  std::set<double> others;
  for (const double value : values) {
    if (is_id(value)) {
      taken.insert(static_cast<std::int32_t>(value));
    } else {
      others.insert(value);
    }
  }
  std::int32_t id = 0;
  for (const double value : others) {
    do {
      ++id;
    } while (taken.contains(id));
    assigned_.push_back({id, value});
  }
}

std::int32_t RegionIds::of(double value) const {
  if (is_id(value)) return static_cast<std::int32_t>(value);
  return std::lower_bound(assigned_.begin(), assigned_.end(), value,
                          [](const RegionValue& a, double v) { return a.value < v; })
      ->id;
}

}  // namespace weft::files
