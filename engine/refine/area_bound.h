// SPDX-License-Identifier: Apache-2.0
// The kernel's view of a grading function: bounds on the areas of a ring of new triangles, in
// squared units of the domain; infinity is none. The kernel is a template over this, so that a
// constant costs nothing.
//
//   ConstantArea area(1e-3);
//   area.begin(box);
//   const RingVerdict verdict = area.judge(ring, 0, ring.size, p, region_bound, quality, badness);
//
// Of a class with kBoundsAreas, triangles that are too large have an area above a bound, so that
// they end by packing.
//
// Errors: bad_size() is the first point where the size is no size; the task polls it. Not
// thread-safe: `again` makes one for each thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "engine/base/geometry.h"
#include "engine/refine/cavity.h"
#include "engine/refine/quality_bounds.h"
#include "engine/size/lattice/lattice.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

// A point where the size field is not finite or not positive.
struct BadSize {
  Point at;
  const SizeFunction* size;
};

// The error kBadSizeValue, with a message that names the point, the value that the request asks
// for, and the fields that are undefined there.
Error bad_size_error(const BadSize& bad);

// Whether bounds around one place differ by so much that one at a centroid tells little of what is
// beside it.
inline bool jumps(const double* bound, std::size_t n) {
  constexpr double kJump = 4;
  const auto [least, most] = std::minmax_element(bound, bound + n);
  return !(*most <= kJump * *least);
}

// The same bound everywhere; infinity is no bound.
class ConstantArea {
 public:
  static constexpr bool kBoundsAreas = true;

  // Bounds are multiplied by `coarseness`.
  explicit ConstantArea(double bound, double coarseness = 1)
      : bound_(bound), coarseness_(coarseness) {}

  // A copy for another thread or another coarseness.
  ConstantArea again(double coarseness = 1) const { return ConstantArea(bound_, coarseness); }

  // Begins a task most of whose rings lie in `box`. Bounds have no slack.
  void begin(const Box&) { slack_ = 1; }

  // From now on, bounds are multiplied by `slack`, but for places where a lattice follows the size.
  void set_slack(double slack) { slack_ = slack; }
  // Whether there may be such a slack somewhere in the box.
  static bool has_slack_in(const Box&, const LatticeShape& shape) { return !shape.exists(); }
  // Whether a lattice follows the size at p, so that there is no slack.
  static constexpr bool fits_lattice(Point) { return false; }
  // Whether one of the region's own bound does, where `bound` is the lesser of both.
  static constexpr bool fits_region(double, double) { return false; }

  // Judges the triangles first <= i < last of the ring around p, none of which may exceed
  // `region_bound`.
  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point,
                    double region_bound, const QualityBounds& quality, Badness* badness) {
    return judge_ring(ring, first, last, quality,
                      UniformAreaBound{2 * slack_ * coarseness_ * std::min(bound_, region_bound)},
                      badness);
  }

  static constexpr bool covers_finer(Point, Point, Point, double) { return false; }

  // The lattice point nearest to c. The lattice is that of the final mesh, whatever the coarseness.
  LatticePoint nearest_of_lattice(Point c, double region_bound, const LatticeShape& shape) {
    return lattice_.nearest(c, std::min(bound_, region_bound), shape);
  }

  // The bound if it is one value in all of the box.
  std::optional<double> uniform_bound(const Box&) const { return bound_; }

  // Whether there is a lattice at p. `bound` is the bound there, that of the region included.
  bool on_lattice(Point, double bound, double) const {
    return bound < std::numeric_limits<double>::infinity();
  }

  // The number of insertions that take about 0.1 ms, see ExecutionContext.
  static constexpr std::uint32_t poll_interval() { return 512; }

  // The bound at n points.
  void bounds_at(std::size_t n, const double*, const double*, double* bound) const {
    std::fill_n(bound, n, bound_);
  }

  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  double bound_;
  double coarseness_;
  double slack_ = 1;
  UniformLattice lattice_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
