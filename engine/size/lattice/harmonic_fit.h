// SPDX-License-Identifier: Apache-2.0
// Fits log h, the logarithm of the wanted edge, in a square by a harmonic polynomial
//     Re U(zeta),    U = sum of u_k zeta^k,    k = 0 to 5,    zeta = (z - centre) / radius,
// by least squares over 8 x 8 samples at Chebyshev's extreme points, which are denser at the sides
// (L. N. Trefethen, "Approximation Theory and Approximation Practice", 2013, chapter 2). The real
// parts of 1, zeta, i zeta, ..., i zeta^5 are 11 functions; samples and functions are the same for
// every square except for its place, so the matrix that solves the normal equations is made once. A
// fit is then 704 products and 64 logarithms.
//
//   const HarmonicFitter fitter;
//   const HarmonicFitter::Samples edges = ...;    // wanted, at fitter.sample(s, centre, half)
//   const HarmonicFit fit = fitter.fit(edges);    // fit.deviation() says how good it is
//
// Deterministic: sums in a fixed order, and SLEEF's log and cos. Thread-safety: immutable.
#pragma once

#include <array>
#include <cstddef>

#include "engine/base/geometry.h"
#include "engine/size/lattice/conformal_map.h"

namespace weft {

struct HarmonicFit {
  ConformalMap::Exponent u{};
  // The largest and the smallest difference of the fit from the wanted logarithms, over the
  // samples.
  double above = 0;  // >= 0
  double below = 0;  // <= 0

  double deviation() const { return above - below; }
  // Sum of the moduli of u[1] and up.
  double bend() const;
};

class HarmonicFitter {
 public:
  static constexpr std::size_t kGrid = 8;  // samples each way
  static constexpr std::size_t kSamples = kGrid * kGrid;
  using Samples = std::array<double, kSamples>;

  HarmonicFitter();

  // Where sample s of a square lies, from the lowest row up.
  Point sample(std::size_t s, Point centre, double half) const {
    return {centre.x + half * at_[s % kGrid], centre.y + half * at_[s / kGrid]};
  }

  // REQUIRES: the values are positive and finite. `radius` of the polynomial is half the square's
  // diagonal.
  HarmonicFit fit(const Samples& edges) const;

 private:
  static constexpr std::size_t kUnknowns = 2 * ConformalMap::kHarmonics + 1;

  std::array<double, kGrid> at_{};  // from -1 to 1
  std::array<std::array<double, kUnknowns>, kSamples> basis_{};
  std::array<std::array<double, kSamples>, kUnknowns> solver_{};
};

}  // namespace weft
