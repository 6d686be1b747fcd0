// SPDX-License-Identifier: Apache-2.0
// Follows smooth curves by arcs of circles: biarcs, pairs of arcs that have a tangent in common
// where they meet, and the tangents of the curve at their ends (K. M. Bolton, "Biarc curves",
// Computer-Aided Design 7, 1975). They err by the cube of their length, chords by the square.
//
//   ArcChain chain({curve(0).at});
//   add_biarcs(curve, 0, 1, 4, 10, chain);
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "files/formats/domain.h"

namespace weft::files {

// The tangent goes with the parameter, has any length, and is 0 where the curve stands still.
struct CurvePoint {
  Point at;
  Point tangent;
};
using Curve = std::function<CurvePoint(double)>;

// Points, and what leads from each to the next.
struct ArcChain {
  std::vector<Point> points;
  std::vector<double> bulges;  // one of each point (Domain::Arc), 0 if straight; of the last, too

  ArcChain() = default;
  // Straight segments.
  explicit ArcChain(std::vector<Point> corners)
      : points(std::move(corners)), bulges(points.size(), 0) {}
  // REQUIRES: it has a point.
  void add(Point to, double bulge) {
    bulges.back() = bulge;
    points.push_back(to);
    bulges.push_back(0);
  }
};

// Goes on from the last point of the chain, which is curve(from).at, to curve(to).at. `extent` is
// the size of the whole curve. The curve leaves the arcs by at most 2e-5 of `extent`, and where it
// is smooth by at most 1e-4 of their radius or 1e-7 of `extent`. What is straight stays one
// segment, an arc of a circle one arc.
//
// Each of `pieces` equal pieces of the parameter is divided until that holds, into 4096 at most;
// so there are chords of 1e-7 of `extent` where the curve turns back at a point. A position that is
// not finite ends its piece. Uses + - * / and sqrt alone: the same curve makes the same arcs.
void add_biarcs(const Curve& curve, double from, double to, int pieces, double extent,
                ArcChain& chain);

}  // namespace weft::files
