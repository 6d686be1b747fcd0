// SPDX-License-Identifier: Apache-2.0
// Finds the nearest of many points, if it is nearer than a radius: a hash table of square cells.
//
// The table is never walked, and ties go to the lowest index: its order cannot leak into a result.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {

class PointGrid {
 public:
  // REQUIRES: radius > 0; coordinates are below 2^60 times the radius.
  explicit PointGrid(double radius);

  void insert(std::uint32_t index, Point p);

  // The index of the nearest point that is nearer to p than the radius; kNone if there is none.
  // Takes constant time if no two points in the grid are nearer to each other than the radius.
  std::uint32_t nearest(Point p) const;

  static constexpr std::uint64_t kBytesPerPoint = 64;  // at the peak, while the table grows

 private:
  struct Entry {
    Point at;
    std::uint32_t index;
    std::uint32_t next;  // of the same bucket, kNone for none
  };

  std::int64_t cell(double coordinate) const;
  std::size_t bucket(std::int64_t x, std::int64_t y) const;
  void link(std::uint32_t entry);

  const double radius_;
  const double cells_per_unit_;  // a cell is twice the radius wide
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> first_;  // per bucket; their number is a power of two
};

}  // namespace weft
