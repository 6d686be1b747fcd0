// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace weft::check {
namespace {

namespace mp = boost::multiprecision;
// Without allocation; wide enough unless exponents differ wildly.
using Fixed = mp::number<mp::cpp_int_backend<1024, 1024, mp::signed_magnitude, mp::unchecked, void>,
                         mp::et_off>;
using Unbounded = mp::number<mp::cpp_int_backend<>, mp::et_off>;
constexpr int kFixedBits = 1024;

constexpr double kEpsilon = 0x1p-53;

// The coordinates as integers over one power of two. Scaling all of them changes no sign.
template <std::size_t N>
class CommonScale {
 public:
  explicit CommonScale(const std::array<double, N>& values) {
    for (std::size_t i = 0; i < N; ++i) {
      parts_[i] = decompose(values[i]);
      if (parts_[i].mantissa == 0) continue;
      low_ = std::min(low_, parts_[i].exponent);
      high_ = std::max(high_, parts_[i].exponent);
    }
  }
  // Bits that hold the difference of any two of the integers.
  int bits() const { return high_ < low_ ? 1 : high_ - low_ + 54; }
  template <class Int>
  Int integer(std::size_t i) const {
    if (parts_[i].mantissa == 0) return Int(0);
    return Int(parts_[i].mantissa) * (Int(1) << (parts_[i].exponent - low_));
  }

 private:
  std::array<Dyadic, N> parts_{};
  int low_ = std::numeric_limits<int>::max();
  int high_ = std::numeric_limits<int>::min();
};

template <class Int>
int exact_cross(const CommonScale<8>& c) {
  const Int ux = c.integer<Int>(2) - c.integer<Int>(0);
  const Int uy = c.integer<Int>(3) - c.integer<Int>(1);
  const Int vx = c.integer<Int>(6) - c.integer<Int>(4);
  const Int vy = c.integer<Int>(7) - c.integer<Int>(5);
  return Int(ux * vy).compare(Int(uy * vx));
}

template <class Int>
int exact_in_circle(const CommonScale<8>& c) {
  std::array<Int, 3> x, y, lift;
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = c.integer<Int>(2 * i) - c.integer<Int>(6);
    y[i] = c.integer<Int>(2 * i + 1) - c.integer<Int>(7);
    lift[i] = x[i] * x[i] + y[i] * y[i];
  }
  const Int determinant = lift[0] * (x[1] * y[2] - x[2] * y[1]) +
                          lift[1] * (x[2] * y[0] - x[0] * y[2]) +
                          lift[2] * (x[0] * y[1] - x[1] * y[0]);
  return determinant.sign();
}

int sign(int value) {
  return (value > 0) - (value < 0);
}

}  // namespace

Dyadic decompose(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53};
}

int cross_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double ux = b.x - a.x;
  const double uy = b.y - a.y;
  const double vx = d.x - c.x;
  const double vy = d.y - c.y;
  // A difference of doubles is 0 only if they are equal, so these zeros are exact.
  if ((ux == 0 || vy == 0) && (uy == 0 || vx == 0)) return 0;
  const double left = ux * vy;
  const double right = uy * vx;
  const double determinant = left - right;
  const double magnitude = std::fabs(left) + std::fabs(right);
  // Each factor is off by one rounding, each product by three, the difference by four: 4 epsilon
  // and terms of second order. Underflow adds less than 1e-323, which the lower limit covers;
  // overflow makes the bound infinite or NaN, and decides nothing.
  const double bound = 6 * kEpsilon * magnitude;
  if (magnitude > 1e-290) {
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
  }
  const CommonScale<8> scale({a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  return sign(2 * scale.bits() + 2 <= kFixedBits ? exact_cross<Fixed>(scale)
                                                 : exact_cross<Unbounded>(scale));
}

int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double ax = a.x - d.x, ay = a.y - d.y;
  const double bx = b.x - d.x, by = b.y - d.y;
  const double cx = c.x - d.x, cy = c.y - d.y;
  const double bxcy = bx * cy, cxby = cx * by;
  const double cxay = cx * ay, axcy = ax * cy;
  const double axby = ax * by, bxay = bx * ay;
  const double a_lift = ax * ax + ay * ay;
  const double b_lift = bx * bx + by * by;
  const double c_lift = cx * cx + cy * cy;
  const double determinant =
      a_lift * (bxcy - cxby) + b_lift * (cxay - axcy) + c_lift * (axby - bxay);
  const double magnitude = a_lift * (std::fabs(bxcy) + std::fabs(cxby)) +
                           b_lift * (std::fabs(cxay) + std::fabs(axcy)) +
                           c_lift * (std::fabs(axby) + std::fabs(bxay));
  // Shewchuk's bound is (10 + 96 epsilon) epsilon. It knows no underflow: a lost product is below
  // 1e-323, times a lift below 1e120, which the lower limit of the magnitude outweighs.
  const double bound = 12 * kEpsilon * magnitude;
  if (a_lift + b_lift + c_lift < 1e120 && magnitude > 1e-180) {
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
  }
  const CommonScale<8> scale({a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  return sign(4 * scale.bits() + 5 <= kFixedBits ? exact_in_circle<Fixed>(scale)
                                                 : exact_in_circle<Unbounded>(scale));
}

}  // namespace weft::check
