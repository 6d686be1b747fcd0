// SPDX-License-Identifier: Apache-2.0
// Complex numbers for conformal maps. std::complex tests every product for NaN; these operations
// are two to four instructions each, in a fixed order: the same bits on every machine.
#pragma once

#include <cmath>

namespace weft {

struct Complex {
  double re = 0;
  double im = 0;
};

inline Complex operator+(Complex a, Complex b) {
  return {a.re + b.re, a.im + b.im};
}
inline Complex operator-(Complex a, Complex b) {
  return {a.re - b.re, a.im - b.im};
}
inline Complex operator*(Complex a, Complex b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Complex operator*(double s, Complex a) {
  return {s * a.re, s * a.im};
}

// The squared modulus.
inline double norm2(Complex a) {
  return a.re * a.re + a.im * a.im;
}
inline double modulus(Complex a) {
  return std::sqrt(norm2(a));
}
inline Complex inverse(Complex a) {
  const double scale = 1 / norm2(a);
  return {a.re * scale, -a.im * scale};
}

}  // namespace weft
