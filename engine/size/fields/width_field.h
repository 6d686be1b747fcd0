// SPDX-License-Identifier: Apache-2.0
// The local width of a domain: at a point of the meshed area, the diameter of the largest disk in
// it that holds the point, in the unit of the coordinates.
//
//   Result<WidthField> width = WidthField::make(domain, context);
//   (*width)({0.5, 0.2});     // 1 in a channel that is 1 wide
//
// Walls are the border of the meshed area alone: coasts, islands, the outside, carved faces.
// Segments that have the meshed area on both sides are no walls, whatever their markers and
// regions, because water flows through them; nor are points inside.
//
// The value is 2 (distance to the walls + distance to the medial axis, medial_axis.h), but at most
// the shorter side of the meshed area's box, which no disk in it exceeds. For a point on the radius
// from a centre of the axis to the wall that is the diameter; elsewhere it differs little, and
// unevenness of the walls does little to it:
//
//   | shape | value / width |
//   |---|---|
//   | strip, passages of 1e-7 of their length | 1.000 |
//   | wedge of 0.2 rad, on the outer half of its axis | median 1.000, at most 1.054 |
//   | regular polygon of 8, 16, 64, 1024 corners | 0.924, 0.981, 0.999, 1.000 at least |
//   | banks moved by 1 % and 5 % of the width | 0.99 to 1.01, 0.95 to 1.05 |
//   | ring around a hole | 0.999 to 1.001 |
//   | triangle, at the centre of its inscribed disk | 1.00 to 1.37 |
//
// A corner sharper than 65 degrees is narrow in the outer half of the shorter of its two walls. Up
// to its tip, as it was, edges of a third of the width with a gradation of 0.15 made more than
// 100 M triangles of the US east coast; it has 2.7 M now. The coast of 9,370 walls takes 0.08 s,
// a ring of waves with 131,072 walls 2.6 s (one core of 2023). The gradient's length reaches 4, so
// that a size made of it wants a bound on its growth.
//
// At the tip of a corner the value is that of the nearest disk, and more. Outside of the meshed
// area it is the same formula and means nothing.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/field.h"
#include "engine/size/fields/distance_field.h"
#include "weft/error.h"

namespace weft {

class WidthField final : public Field {
 public:
  // REQUIRES: a domain that `triangulate` made. Errors: those of medial_axis and of
  // DistanceField::make. The domain is not referred to afterwards.
  static Result<WidthField> make(const Domain& domain, const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;
  // The sum of the bounds of both distances, which is far too low where a box holds walls and axis;
  // or the least diameter about the points of the axis that are nearest to some point of the box,
  // because nobody who walks there comes nearer to the walls by more than the way.
  Interval bounds(const Box& box) const noexcept override;
  double steepness(const Box& box) const noexcept override {
    return 2 * (to_walls_.steepness(box) + to_axis_.steepness(box));
  }
  std::size_t bytes() const noexcept override {
    return to_walls_.bytes() + to_axis_.bytes() + radii_.bytes();
  }
  std::size_t operations() const noexcept override {
    return to_walls_.operations() + to_axis_.operations();
  }

 private:
  // `radii`: for each line of the axis, how near its points come to the walls at most.
  WidthField(DistanceField to_walls, DistanceField to_axis, std::vector<double> radii,
             const Box& box);

  // Increases with both, rounded as well: so bounds of the two give bounds of the value.
  double width(double to_walls, double to_axis) const {
    const double value = 2 * (to_walls + to_axis);
    return most_ < value ? most_ : value;
  }

  DistanceField to_walls_;
  DistanceField to_axis_;
  LineTree::Numbers radii_;  // of each line of the axis: no point of it is nearer to the walls
  double most_;
};

}  // namespace weft
