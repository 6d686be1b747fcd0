// SPDX-License-Identifier: Apache-2.0
// The statistics of a mesh: angles in degrees, aspect ratios, mean quality, areas over their
// bounds. They are gathered while the mesh is sent, in blocks of triangles: two at once if
// possible, in counters that do not wait for one another. Not thread-safe: each fragment has its
// own, and Delivery adds them up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/refine/triangle_block.h"
#include "weft/mesh.h"

namespace weft {

class QualityStatistics {
 public:
  void add(const TriangleBlock& block);
  void add(const QualityStatistics& other);
  // Writes all statistics into the summary. REQUIRES: there is a triangle.
  void write(Summary& summary) const;

 private:
  double percentile(double rank) const;

  // Triangles by their smallest angle, in two columns. A fragment without triangles has none.
  static constexpr std::size_t kFineBins = 1024;

  double area_ = 0;
  double on_lattice_ = 0;  // of the area
  double off_lattice_ = 0;
  double quality_ = 0;         // sum over the triangles
  double least_ = 0;           // sum of area over bound, times 10
  std::uint64_t bounded_ = 0;  // triangles that have a bound
  double least_bound_ = std::numeric_limits<double>::infinity();
  std::vector<std::uint64_t> fine_;
  double smallest_angle_ = -1;  // as its t, see the source: t falls as the angle grows
  double largest_angle_ = 1;
  std::array<std::uint64_t, 18> angles_{};
  std::array<std::uint64_t, 9> aspects_{};
  std::array<std::uint64_t, 10> sizes_{};
};

}  // namespace weft
