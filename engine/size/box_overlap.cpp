// SPDX-License-Identifier: Apache-2.0
#include "engine/size/box_overlap.h"

#include <algorithm>

namespace weft {
namespace {

// Twice the area that the edge from a to b spans with the box's corner farthest to its left, or,
// `nearest`, to its right.
double reach(const Box& box, Point a, Point b, bool nearest) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double x = (dy > 0) != nearest ? box.min_x : box.max_x;
  const double y = (dx > 0) != nearest ? box.max_y : box.min_y;
  return dx * (y - a.y) - dy * (x - a.x);
}

}  // namespace

bool overlap(const Box& box, const Corners& c) {
  Box around;
  for (Point p : c) around.add(p);
  if (around.min_x >= box.max_x || around.max_x <= box.min_x || around.min_y >= box.max_y ||
      around.max_y <= box.min_y) {
    return false;
  }
  for (unsigned i = 0; i < 3; ++i) {
    if (reach(box, c[i], c[(i + 1) % 3], false) <= 0) return false;
  }
  return true;
}

bool inside(const Box& box, const Corners& c) {
  for (unsigned i = 0; i < 3; ++i) {
    if (reach(box, c[i], c[(i + 1) % 3], true) <= 0) return false;
  }
  return true;
}

bool meets(const Box& box, Point a, Point b) {
  if (std::max(a.x, b.x) < box.min_x || std::min(a.x, b.x) > box.max_x ||
      std::max(a.y, b.y) < box.min_y || std::min(a.y, b.y) > box.max_y)
    return false;
  return reach(box, a, b, false) >= 0 && reach(box, a, b, true) <= 0;
}

double CommonPart::area() const {
  double doubled = 0;
  for (std::size_t i = 2; i < count; ++i) {
    doubled += (corners[i - 1].x - corners[0].x) * (corners[i].y - corners[0].y) -
               (corners[i - 1].y - corners[0].y) * (corners[i].x - corners[0].x);
  }
  return 0.5 * doubled;
}

CommonPart common_part(const Box& box, const Corners& c) {
  CommonPart part{{c[0], c[1], c[2]}, 3};
  const auto clip = [&](auto depth) {
    CommonPart rest{{}, 0};
    for (std::size_t i = 0; i < part.count; ++i) {
      const Point a = part.corners[i];
      const Point b = part.corners[(i + 1) % part.count];
      const double da = depth(a);
      const double db = depth(b);
      if (da >= 0) rest.corners[rest.count++] = a;
      if ((da >= 0) != (db >= 0)) {
        const double t = da / (da - db);
        rest.corners[rest.count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      }
    }
    part = rest;
  };
  clip([&](Point p) { return p.x - box.min_x; });
  clip([&](Point p) { return box.max_x - p.x; });
  clip([&](Point p) { return p.y - box.min_y; });
  clip([&](Point p) { return box.max_y - p.y; });
  return part;
}

}  // namespace weft
