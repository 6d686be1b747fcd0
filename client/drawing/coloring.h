// SPDX-License-Identifier: Apache-2.0
// Which colour each triangle of a drawing has.
//
// A triangle has a value: its smallest angle in degrees, the binary logarithm of its area, or its
// area over its bound, which is 0 if it has none. The range of colours follows the values that were
// noted, so values are noted first, and kept until the colours are asked for. Regions have their
// colours by themselves.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "client/drawing/colors.h"
#include "client/drawing/drawn_triangle.h"
#include "files/formats/area_bound.h"

namespace weft::client {

struct ValueRange {
  double low = 0;
  double high = 1;
};

class Coloring {
 public:
  // REQUIRES: not kAuto; a bound if it is kBound.
  Coloring(DrawColor by, DrawnUnit unit, AreaBound bound);

  DrawColor by() const { return by_; }
  bool by_value() const {
    return by_ == DrawColor::kAngle || by_ == DrawColor::kSize || by_ == DrawColor::kBound;
  }

  // REQUIRES: by_value.
  float value(const DrawnTriangle& triangle) const;
  // A triangle that is seen: its value and its area on the page.
  void note(float value, double weight);
  void note_region(std::int32_t region);

  // The values at both ends of the colours: of angles 0 and 60; of sizes those that all but a
  // thousandth of the area lies between, at each end, and at least a factor of 2 apart; of areas
  // over bounds 0 and 1, or 0 and 2 if one is above its bound.
  ValueRange range() const;
  // REQUIRES: `range` is range().
  static Color color(float value, const ValueRange& range);

  // Those that were noted first.
  const std::set<std::int32_t>& regions() const { return regions_; }
  static constexpr std::size_t kMaxRegions = 64;

 private:
  DrawColor by_;
  DrawnUnit unit_;
  AreaBound bound_;
  bool above_bound_ = false;
  std::vector<double> area_at_;  // on the page, by steps of the logarithm; empty: not by size
  std::set<std::int32_t> regions_;
};

}  // namespace weft::client
