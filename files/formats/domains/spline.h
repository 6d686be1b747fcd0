// SPDX-License-Identifier: Apache-2.0
// Curves of B-splines, rational or not, as arcs of circles.
#pragma once

#include <cstddef>
#include <vector>

#include "files/formats/domain.h"
#include "files/formats/domains/biarcs.h"

namespace weft::files {

struct Spline {
  int degree = 3;
  std::vector<double> knots;
  std::vector<double> weights;  // one for each control point, or empty: all 1
  std::vector<Point> control;

  // Degrees are up to 25, weights positive, knots ascend and are as many as belong to the points.
  bool is_sound() const;
};

// From its first point to its last, as add_biarcs makes them of each part between two knots; so it
// has the kinks of the spline. REQUIRES: it is sound.
ArcChain arcs_of(const Spline& spline);

}  // namespace weft::files
