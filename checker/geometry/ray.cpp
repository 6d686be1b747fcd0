// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/ray.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "checker/geometry/predicates.h"

namespace weft::check {
namespace {

// The line of an edge, directed upwards; never horizontal.
struct Line {
  Vec2 low, high;
};

Line line_of(const Arrangement::Edge& edge) {
  return edge.from.y < edge.to.y ? Line{edge.from, edge.to} : Line{edge.to, edge.from};
}

// The x at which the line has the height y, which lies between those of its ends, with a bound on
// the error.
struct Abscissa {
  double x, error;
};

Abscissa abscissa(const Line& line, double y) {
  const double t = (y - line.low.y) / (line.high.y - line.low.y);
  // t carries three roundings, so does the product with the width, the sum one more: less than
  // 8 epsilon of the coordinates' sum. The constant covers underflow.
  return {line.low.x + t * (line.high.x - line.low.x),
          0x1p-49 * (std::fabs(line.low.x) + std::fabs(line.high.x)) + 1e-300};
}

using Exact = boost::multiprecision::cpp_rational;

Exact exact_abscissa(const Line& line, double y) {
  const Exact low_x(line.low.x), low_y(line.low.y);
  return low_x + (Exact(y) - low_y) * (Exact(line.high.x) - low_x) / (Exact(line.high.y) - low_y);
}

// Whether `line` passes to the right of `other`, at y or, where they meet there, just above.
bool passes_right(const Line& line, const Line& other, double y) {
  const Abscissa p = abscissa(line, y);
  const Abscissa q = abscissa(other, y);
  if (std::fabs(p.x - q.x) > p.error + q.error) return p.x > q.x;
  const int order = exact_abscissa(line, y).compare(exact_abscissa(other, y));
  if (order != 0) return order > 0;
  return cross_sign(line.low, line.high, other.low, other.high) > 0;
}

}  // namespace

RayHit nearest_to_the_left(const Arrangement& arrangement, const BoxTree& tree, Vec2 p) {
  const VertexOrder& vertices = arrangement.vertices();
  RayHit hit;
  Line nearest{};
  Box ray{-std::numeric_limits<double>::infinity(), p.y, p.x, p.y};
  tree.visit(ray, [&](std::uint32_t e) {
    const Arrangement::Edge& edge = arrangement.edges()[e];
    const Line line = line_of(edge);
    const int side = orientation(line.low, line.high, p);
    if (side == 0 && vertices.compare(edge.u, p) <= 0 && vertices.compare(edge.v, p) >= 0)
      hit.on_edge = e;
    // Half open: an edge has its lower end and not its upper one.
    const bool rises = edge.from.y < edge.to.y;
    const bool spans = vertices.compare_y(rises ? edge.u : edge.v, p.y) <= 0 &&
                       vertices.compare_y(rises ? edge.v : edge.u, p.y) > 0;
    if (!spans || side >= 0) return;  // a horizontal edge never spans
    if (hit.half_edge && !passes_right(line, nearest, p.y)) return;
    nearest = line;
    hit.half_edge = 2 * e + (rises ? 1 : 0);
    const Abscissa at = abscissa(line, p.y);
    ray.min_x = std::max(ray.min_x, at.x - at.error);
  });
  return hit;
}

}  // namespace weft::check
