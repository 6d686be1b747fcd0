// SPDX-License-Identifier: Apache-2.0
#include "engine/size/lattice/harmonic_fit.h"

#include <sleef.h>

#include <algorithm>

namespace weft {

double HarmonicFit::bend() const {
  double sum = 0;
  for (std::size_t k = 1; k < u.size(); ++k) sum += modulus(u[k]);
  return sum;
}

template <std::size_t Grid, std::size_t Harmonics>
HarmonicFitter<Grid, Harmonics>::HarmonicFitter() {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kRootHalf = 0.70710678118654752;
  for (std::size_t i = 0; i < kGrid; ++i)
    at_[i] = -Sleef_cinz_cosd1_u10purec(kPi * static_cast<double>(i) / (kGrid - 1));
  for (std::size_t s = 0; s < kSamples; ++s) {
    const Complex zeta{kRootHalf * at_[s % kGrid], kRootHalf * at_[s / kGrid]};
    Complex power{1, 0};
    basis_[s][0] = 1;
    for (std::size_t k = 1; k <= Harmonics; ++k) {
      power = power * zeta;
      basis_[s][2 * k - 1] = power.re;
      basis_[s][2 * k] = -power.im;
    }
  }
  // Gauss-Jordan elimination turns the normal equations' right side, the basis itself, into what
  // solves them. They are well conditioned: no pivoting.
  std::array<std::array<double, kUnknowns>, kUnknowns> normal{};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t s = 0; s < kSamples; ++s) {
      solver_[i][s] = basis_[s][i];
      for (std::size_t j = 0; j < kUnknowns; ++j) normal[i][j] += basis_[s][i] * basis_[s][j];
    }
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const double scale = 1 / normal[i][i];
    for (double& x : normal[i]) x *= scale;
    for (double& x : solver_[i]) x *= scale;
    for (std::size_t r = 0; r < kUnknowns; ++r) {
      if (r == i) continue;
      const double by = normal[r][i];
      for (std::size_t j = 0; j < kUnknowns; ++j) normal[r][j] -= by * normal[i][j];
      for (std::size_t s = 0; s < kSamples; ++s) solver_[r][s] -= by * solver_[i][s];
    }
  }
}

template <std::size_t Grid, std::size_t Harmonics>
HarmonicFit HarmonicFitter<Grid, Harmonics>::fit(const Samples& edges) const {
  Samples wanted;
  for (std::size_t s = 0; s < kSamples; ++s) wanted[s] = Sleef_cinz_logd1_u10purec(edges[s]);
  std::array<double, kUnknowns> solution{};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t s = 0; s < kSamples; ++s) solution[i] += solver_[i][s] * wanted[s];
  }
  HarmonicFit fit;
  for (std::size_t s = 0; s < kSamples; ++s) {
    double off = -wanted[s];
    for (std::size_t i = 0; i < kUnknowns; ++i) off += basis_[s][i] * solution[i];
    fit.above = std::max(fit.above, off);
    fit.below = std::min(fit.below, off);
  }
  fit.u[0].re = solution[0];
  for (std::size_t k = 1; k <= Harmonics; ++k) fit.u[k] = {solution[2 * k - 1], solution[2 * k]};
  return fit;
}

template class HarmonicFitter<8, ConformalMap::kHarmonics>;
template class HarmonicFitter<4, 3>;

}  // namespace weft
