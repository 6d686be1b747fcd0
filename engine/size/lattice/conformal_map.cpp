// SPDX-License-Identifier: Apache-2.0
#include "engine/size/lattice/conformal_map.h"

#include <sleef.h>

#include <algorithm>

namespace weft {

ConformalMap::ConformalMap(Point centre, double radius, const Exponent& u, double scale)
    : centre_(centre), radius_(radius), inverse_radius_(1 / radius) {
  constexpr double kNegligible = 1e-3;  // in spacings of the lattice
  std::array<Complex, kDegree> e{};     // coefficients of exp(-U)
  // `move` turns the lattice as a whole, by Im u[0].
  e[0].re = radius * Sleef_cinz_expd1_u10purec(-u[0].re) / scale;
  for (std::size_t n = 0; n < e.size(); ++n) {
    if (n > 0) {
      for (std::size_t k = 1; k <= std::min(n, kHarmonics); ++k)
        e[n] = e[n] + static_cast<double>(k) * (u[k] * e[n - k]);
      e[n] = (-1.0 / static_cast<double>(n)) * e[n];
    }
    f_[n + 1] = (1.0 / static_cast<double>(n + 1)) * e[n];
  }
  degree_ = kDegree;
  while (degree_ > 1 && modulus(f_[degree_]) < kNegligible) --degree_;
  for (std::size_t k = 1; k <= kHarmonics; ++k)
    half_bend_[k - 1] = (0.5 * static_cast<double>(k)) * u[k];
}

}  // namespace weft
