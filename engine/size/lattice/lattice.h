// SPDX-License-Identifier: Apache-2.0
// The hexagonal lattice from which the Steiner points of too large triangles are taken
// (refine/steiner_point.h): most triangles are then equilateral, and nearly as large as their
// bound allows (docs/how-it-works.md).
//
// A bound D on the area is that of equilateral triangles of edge h = sqrt(4 D / sqrt(3)). The
// lattice is laid out with triangles of `area_ratio` D, so that rounding, jitter and the curvature
// of a graded lattice (conformal_map.h) make none too large.
//
// Jitter. Each point is moved by up to `jitter` spacings each way, by a hash of its indices, so the
// same point always moves alike. In a perfect lattice every in-circle test is a tie; 1e-4 of a
// spacing lets the filter decide nearly all of them. For bounds from 30 degrees on there is a
// second reason: an extra vertex in a perfect lattice makes triangles of 30, 30 and 120 degrees,
// whose circumcentres are the centroids of the next triangles, and so on through the whole lattice
// (up to 2.2 times the least number of triangles were seen). With 1 % of jitter that dies out, from
// 30 degrees on with 5 % more per degree; jitter reduces the area ratio. Above 31.5 degrees it does
// not die out, and there is no lattice. bench/README.md has the measurements.
//
// Units: coordinates of the domain; bounds in their square. Thread-safety: values and pure
// functions, but for UniformLattice.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/size/lattice/complex.h"

namespace weft {

// Area of an equilateral triangle over its squared edge.
inline constexpr double kEquilateral = 0.43301270189221932;

// How the lattice is laid out.
struct LatticeShape {
  double area_ratio = 0;  // area of its triangles over the bound; 0: there is no lattice
  double jitter = 0;      // of its points, in spacings

  bool exists() const { return area_ratio > 0; }

  // The shape for a bound on angles, in degrees.
  static LatticeShape for_angle(double min_angle_deg) {
    constexpr double kPerfect = 29.5;
    constexpr double kMax = 31.5;
    if (min_angle_deg > kMax) return {};
    const double beyond = std::max(0.0, min_angle_deg - 30);
    const double jitter = min_angle_deg <= kPerfect ? 1e-4 : 0.01 + 0.05 * beyond;
    return {0.99 - 2.2 * jitter, jitter};
  }
};

// A point of the lattice, and its squared spacing there; 0 if there is no lattice.
struct LatticePoint {
  Point at{};
  double spacing2 = 0;
};

// Beyond this the lattice's indices, and a tenth of a spacing, are no longer exact in a double.
inline constexpr double kFarthestInLattice2 = 1e28;

// From row to row of the hexagonal lattice of unit spacing. Odd rows are shifted by a half.
inline constexpr double kRowRise = 0.86602540378443865;

// The point in column i of row j of that lattice, whose row is shifted by `shift`, with its jitter.
inline Complex lattice_point(double i, double j, double shift, double jitter) {
  const auto bits = [](double n) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(n));
  };
  std::uint64_t hash = bits(i) * 0x9e3779b97f4a7c15u ^ bits(j) * 0xc2b2ae3d27d4eb4fu;
  hash ^= hash >> 29;
  hash *= 0xbf58476d1ce4e5b9u;
  hash ^= hash >> 32;
  const auto shake = [jitter](std::uint64_t bits16) {
    return jitter * (static_cast<double>(static_cast<std::int32_t>(bits16)) * 0x1p-15 - 1);
  };
  return {i + shift + shake(hash & 0xffff), j * kRowRise + shake(hash >> 16 & 0xffff)};
}

// The point of the lattice nearest to w. REQUIRES: norm2(w) < kFarthestInLattice2.
inline Complex nearest_of_lattice(Complex w, double jitter) {
  // The nearest point is in the row below or the one above.
  const double j0 = std::floor(w.im * (1 / kRowRise));
  const double shift0 = 0.5 * (j0 - 2 * std::floor(0.5 * j0));
  const double shift1 = 0.5 - shift0;
  const double i0 = std::floor(w.re - shift0 + 0.5);
  const double i1 = std::floor(w.re - shift1 + 0.5);
  const double x0 = i0 + shift0 - w.re;
  const double x1 = i1 + shift1 - w.re;
  const double y0 = j0 * kRowRise - w.im;
  const double y1 = y0 + kRowRise;
  const bool upper = x1 * x1 + y1 * y1 < x0 * x0 + y0 * y0;
  const double i = upper ? i1 : i0;
  const double j = upper ? j0 + 1 : j0;
  return lattice_point(i, j, upper ? shift1 : shift0, jitter);
}

// The squared spacing of the lattice for a bound; 0 if this is not a size. REQUIRES: the shape
// exists.
inline double lattice_spacing2(double bound, const LatticeShape& shape) {
  constexpr double kMaxBound = 1e150;
  return bound > 0 && bound < kMaxBound ? shape.area_ratio * bound / kEquilateral : 0;
}

// The lattice for one bound everywhere, through the origin. It remembers the last bound.
// Not thread-safe: one per thread.
class UniformLattice {
 public:
  // Returns the point nearest to c; its spacing is 0 if the bound is not a size, or if c is too
  // many spacings from the origin.
  LatticePoint nearest(Point c, double bound, const LatticeShape& shape) {
    if (bound != bound_) [[unlikely]] {
      const double spacing2 = lattice_spacing2(bound, shape);
      if (spacing2 == 0) return {};
      bound_ = bound;
      spacing2_ = spacing2;
      spacing_ = std::sqrt(spacing2_);
      per_unit_ = 1 / spacing_;
    }
    const Complex w{c.x * per_unit_, c.y * per_unit_};
    if (!(norm2(w) < kFarthestInLattice2)) [[unlikely]]
      return {};
    const Complex at = nearest_of_lattice(w, shape.jitter);
    return {{at.re * spacing_, at.im * spacing_}, spacing2_};
  }

 private:
  double bound_ = 0;
  double spacing2_ = 0;
  double spacing_ = 0;
  double per_unit_ = 0;
};

}  // namespace weft
