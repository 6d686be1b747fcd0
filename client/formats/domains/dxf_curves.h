// SPDX-License-Identifier: Apache-2.0
// The geometry of drawings: where blocks place what is in them, and curves as chords.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "client/formats/domain.h"

namespace weft::client {

// (x, y) becomes (xx x + xy y + x0, yx x + yy y + y0).
struct DxfPlacement {
  double xx = 1, xy = 0, yx = 0, yy = 1;
  double x0 = 0, y0 = 0;

  Point operator()(Point p) const { return {xx * p.x + xy * p.y + x0, yx * p.x + yy * p.y + y0}; }
  // First `inner`, then this.
  DxfPlacement after(const DxfPlacement& inner) const;
  bool mirrors() const { return xx * yy < xy * yx; }
  // Whether circles are circles there, but for rounding.
  bool keeps_circles() const;
};

// The plane of an entity with this extrusion, at that height, seen from above, by DXF's arbitrary
// axis algorithm. Of (0, 0, 1) it is the plane itself, of (0, 0, -1) its mirror image.
DxfPlacement plane_of(const std::array<double, 3>& extrusion, double height);

// (cos, sin) of degrees; exact for multiples of 90.
Point direction(double degrees);

using DxfCurve = std::function<Point(double)>;

// Adds the curve's points from one parameter to another as ends of chords, but for the first point.
// Each chord turns by 2 degrees at most against the one before it, up to 512 chords for each
// of `pieces` equal pieces of the parameter.
void add_chords(const DxfCurve& curve, double from, double to, int pieces,
                std::vector<Point>& points);

// The same of an arc from `a` to `b` with this bulge, which may be 0.
void add_bulge_chords(Point a, Point b, double bulge, std::vector<Point>& points);

// A curve of B-splines, rational if there are weights.
struct DxfSpline {
  int degree = 3;
  std::vector<double> knots;
  std::vector<double> weights;  // one for each control point, or empty
  std::vector<Point> control;

  // Degrees are up to 25, weights positive, knots ascend and are as many as belong to the points.
  bool is_sound() const;
};

// Its chords, as add_chords makes them, from its first point to its last. REQUIRES: it is sound.
std::vector<Point> chords_of(const DxfSpline& spline);

// The points of an arc of an ellipse, by its centre, its half axes and the parameter in radians.
struct DxfEllipse {
  Point centre, major, minor;
  Point operator()(double t) const;
};

}  // namespace weft::client
