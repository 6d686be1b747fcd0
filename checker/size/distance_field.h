// SPDX-License-Identifier: Apache-2.0
// The distance to the nearest of some points or segments. Independent of the engine's: a hierarchy
// of boxes, in long double.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {

// To the segments between `points`; if there are none, to the points themselves; if there are no
// points, to the segments of the domain that have one of the markers; without markers, to all. Arcs
// are polylines (domain/flattened.h).
struct DistanceField {
  std::vector<std::int32_t> markers;
  std::vector<Vec2> points;
  std::vector<std::array<std::uint32_t, 2>> segments;  // indices into points
};

class Distance {
 public:
  // Errors: a sentence about an index out of range, a coordinate that is not finite, a marker that
  // no segment has, or nothing to measure to.
  static tl::expected<Distance, std::string> make(const DistanceField& field, const Domain& domain);

  // Exact to about 1e-18 of the coordinates. Throws nothing; takes a logarithmic time, but on
  // hostile input.
  double operator()(Vec2 p) const;

 private:
  using Piece = std::array<Vec2, 2>;  // the same twice for a point
  explicit Distance(std::vector<Piece> pieces);

  std::vector<Piece> pieces_;
  BoxTree tree_;
};

}  // namespace weft::check
