// SPDX-License-Identifier: Apache-2.0
// Fits log h, the logarithm of the wanted edge, in a square by a harmonic polynomial
//     Re U(zeta),    U = sum of u_k zeta^k,    k = 0 to n,    zeta = (z - centre) / radius,
// by least squares over a grid of samples at Chebyshev's extreme points, which are denser at the
// sides (L. N. Trefethen, "Approximation Theory and Approximation Practice", 2013, chapter 2). The
// real parts of 1, zeta, i zeta, ..., i zeta^n are 2 n + 1 functions; samples and functions are the
// same for every square except for its place, so the matrix that solves the normal equations is
// made once. There are two fitters:
//
//                    samples   n   of a fit: products   logarithms
//   FineFitter       8 x 8     5   704                  64
//   CoarseFitter     4 x 4     3   112                  16            for squares of a few rows
//
//   const FineFitter fitter;
//   const FineFitter::Samples edges = ...;        // wanted, at fitter.sample(s, centre, half)
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

// `Grid` samples each way; degree `Harmonics`, at most ConformalMap's.
template <std::size_t Grid, std::size_t Harmonics>
class HarmonicFitter {
 public:
  static constexpr std::size_t kGrid = Grid;
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
  static constexpr std::size_t kUnknowns = 2 * Harmonics + 1;

  std::array<double, kGrid> at_{};  // from -1 to 1
  std::array<std::array<double, kUnknowns>, kSamples> basis_{};
  std::array<std::array<double, kSamples>, kUnknowns> solver_{};
};

using FineFitter = HarmonicFitter<8, ConformalMap::kHarmonics>;
using CoarseFitter = HarmonicFitter<4, 3>;

extern template class HarmonicFitter<8, ConformalMap::kHarmonics>;
extern template class HarmonicFitter<4, 3>;

}  // namespace weft
