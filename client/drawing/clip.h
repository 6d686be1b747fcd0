// SPDX-License-Identifier: Apache-2.0
// Cuts off what lies outside a box of the page, so that a mesh of which little is seen costs
// little, and so that no coordinate leaves the range of cairo, which is some 8 million.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "client/drawing/canvas.h"

namespace weft::client {

struct PageBox {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  bool contains(PagePoint p) const {
    return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom;
  }
};

// The part of a segment in the box (Y.-D. Liang and B. A. Barsky, 1984); none: it lies outside, or
// an end is not finite.
std::optional<std::pair<PagePoint, PagePoint>> clipped(const PageBox& box, PagePoint a,
                                                       PagePoint b);

// The part of a triangle in the box, convex (I. E. Sutherland and G. W. Hodgman, 1974).
class ClippedTriangle {
 public:
  ClippedTriangle(const PageBox& box, const std::array<PagePoint, 3>& corners);
  // Fewer than three: none of it.
  std::span<const PagePoint> corners() const { return {corners_.data(), count_}; }

 private:
  // Keeps what `inside` is not negative of.
  template <class Inside>
  void cut(const Inside& inside);

  std::array<PagePoint, 7> corners_{};  // each of four sides adds at most one
  std::size_t count_ = 3;
};

}  // namespace weft::client
