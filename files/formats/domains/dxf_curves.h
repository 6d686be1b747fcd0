// SPDX-License-Identifier: Apache-2.0
// The geometry of drawings: where blocks place what is in them, and curves as arcs of circles.
#pragma once

#include <array>

#include "files/formats/domain.h"
#include "files/formats/domains/biarcs.h"

namespace weft::files {

// (x, y) becomes (xx x + xy y + x0, yx x + yy y + y0).
struct DxfPlacement {
  double xx = 1, xy = 0, yx = 0, yy = 1;
  double x0 = 0, y0 = 0;

  Point operator()(Point p) const { return {xx * p.x + xy * p.y + x0, yx * p.x + yy * p.y + y0}; }
  // Of a direction.
  Point linear(Point v) const { return {xx * v.x + xy * v.y, yx * v.x + yy * v.y}; }
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

// Adds an arc from the end of the chain, which is place(a), to place(b): the one from `a` to `b`
// with this bulge, which may be 0, as it is placed. If `place` does not keep circles, that is an
// arc of an ellipse.
void add_bulge(const DxfPlacement& place, Point a, Point b, double bulge, ArcChain& chain);

// An arc of an ellipse, by its centre, two half axes, which need not be its principal ones, and its
// parameters in radians, `from` <= `to`. A whole one, from 0 to a full turn or the like, returns to
// its first point.
struct DxfEllipse {
  Point centre, major, minor;
  double from = 0, to = 0;

  DxfEllipse placed(const DxfPlacement& place) const {
    return {place(centre), place.linear(major), place.linear(minor), from, to};
  }
};

ArcChain arcs_of(const DxfEllipse& ellipse);

}  // namespace weft::files
