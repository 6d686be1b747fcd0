// SPDX-License-Identifier: GPL-3.0-or-later
// The bounds on a triangle's shape, and the test of a whole ring of new triangles at once.
//
// With edges a, b from p, e = b - a, and A2 = a x b twice the area, the smallest angle is opposite
// the shortest edge m, and sin^2 = A2^2 m^2 / (|a|^2 |b|^2 |e|^2). So no root and no division is
// needed, the products are those of the walk (cavity.h), and one loop without branches serves the
// ring.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/refine/cavity.h"
#include "engine/refine/mesh.h"

namespace weft {

struct QualityBounds {
  double sin2 = 0;         // of the minimum angle
  double off_centre = 0;   // see steiner_point.h
  double min_length2 = 0;  // squared floor on the length of new edges
  double precision2 = 0;   // squared length below which double precision ends

  // No edge below min_length, nor below `precision`, is made. REQUIRES: 0 <= min_angle_deg <=
  // kMaxMinAngleDeg.
  static QualityBounds from(double min_angle_deg, double min_length, double precision);
};

// Squared circumradius of a counter-clockwise triangle.
inline double circumradius2(Point a, Point b, Point c) {
  const auto length2 = [](Point p, Point q) {
    return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
  };
  const double doubled = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return length2(a, b) / doubled * (length2(b, c) / doubled) * length2(c, a) / 4;
}

// What one look at a ring of new triangles tells. Badness is per triangle, the rest for the ring.
struct RingVerdict {
  bool flat = false;       // a triangle may not be counter-clockwise: ask the exact predicate
  bool too_close = false;  // p is nearer to a point of the ring than the floor
  bool beyond = false;     // a point of the ring is farther from p than `reach2` allows
};

// An area bound for every triangle of a ring.
struct UniformAreaBound {
  double doubled;
  double operator[](std::uint32_t) const { return doubled; }
};

// The badness of a triangle that is larger than its bound: four levels an octave of the ratio, off
// the difference of the numbers' bits, which is a logarithm to 9 %. REQUIRES: 0 < bound < area.
inline Badness badness_of_size(double area, double bound) {
  const std::uint64_t quarters =
      (std::bit_cast<std::uint64_t>(area) - std::bit_cast<std::uint64_t>(bound)) >> 50;
  return kLarge + std::min(static_cast<std::uint32_t>(quarters), kWorst - kLarge);
}

// badness[i] of the triangles first <= i < last. `doubled_bound[i]` is twice the upper bound on
// the area of triangle i, and holds for rings that reach no farther than the root of `reach2`.
template <class AreaBound>
inline RingVerdict judge_ring(const Ring& ring, std::uint32_t first, std::uint32_t last,
                              const QualityBounds& quality, const AreaBound& doubled_bound,
                              double reach2, Badness* __restrict badness) {
  const double* __restrict x = ring.x.data();
  const double* __restrict y = ring.y.data();
  const double* __restrict length2 = ring.length2.data();
  const double* __restrict cross = ring.cross.data();
  const double sin2 = quality.sin2;
  const double min_length2 = quality.min_length2;
  constexpr double kOrientationError = 4 * 0x1p-53;
  std::uint64_t flat = 0;
  std::uint64_t close = 0;
  std::uint64_t beyond = 0;
  for (std::uint32_t i = first; i < last; ++i) {
    const double ex = x[i + 1] - x[i];
    const double ey = y[i + 1] - y[i];
    const double e2 = ex * ex + ey * ey;
    const double a2 = length2[i];
    const double b2 = length2[i + 1];
    const double area2 = cross[i];
    const double shortest2 = std::min(e2, std::min(a2, b2));
    const bool skinny = area2 * area2 * shortest2 < sin2 * (a2 * b2 * e2);
    const bool large = area2 > doubled_bound[i];
    flat |= static_cast<std::uint64_t>(area2 <= kOrientationError * (a2 + b2));
    close |= static_cast<std::uint64_t>(std::min(a2, b2) < min_length2);
    beyond |= static_cast<std::uint64_t>(std::max(a2, b2) > reach2);
    const Badness by_size = badness_of_size(area2, doubled_bound[i]);
    badness[i] = large ? by_size : static_cast<std::uint32_t>(skinny);
  }
  return {flat != 0, close != 0, beyond != 0};
}

}  // namespace weft
