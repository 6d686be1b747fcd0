// SPDX-License-Identifier: Apache-2.0
// Triangle's attributes of regions are real numbers, the ids of regions are integers of 32 bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft::files {

// The attribute of a file that an id stands for.
struct RegionValue {
  std::int32_t id = 0;
  double value = 0;
  friend bool operator==(const RegionValue&, const RegionValue&) = default;
};

// An integer of 32 bits is its own id. The other values, in ascending order, get the smallest
// positive ids that no integer among the values has.
// Law: the ids depend on the set of values alone, so the .poly file of a domain and the .ele file
// of its mesh agree, whatever the order of their lines.
class RegionIds {
 public:
  // REQUIRES: the values are finite.
  explicit RegionIds(std::span<const double> values);

  // REQUIRES: the value is one of these.
  std::int32_t of(double value) const;
  // Those whose id is not the value itself, by id.
  const std::vector<RegionValue>& assigned() const { return assigned_; }

 private:
  std::vector<RegionValue> assigned_;  // ascending in both
};

}  // namespace weft::files
