// SPDX-License-Identifier: Apache-2.0
// A lattice whose spacing varies, and whose triangles stay equilateral.
//
// Let F be an analytic function on a square of the plane, z = x + i y. It maps small triangles to
// similar ones, |F'| times as large. So the points that F maps to the hexagonal lattice of unit
// spacing make nearly equilateral triangles of edge 1 / |F'|. For the edge h(z) to come out,
//     |F'(z)| = 1 / h(z),    so    log h = -Re log F' = Re U,    F = integral of exp(-U),
// with U analytic, and so log h harmonic: a lattice without faults can follow no other size.
// (P. Henrici, "Applied and Computational Complex Analysis" I, 1974, sections 2.1 and 5.6.) If
// log h is not harmonic, such a function is fitted to it (harmonic_fit.h), square by square.
//
// Here U is a polynomial of degree kHarmonics in
//     zeta = (z - centre) / radius,    |zeta| <= 1 in the square,
// and F the first terms of its power series. With E = exp(-U) = e_0 + e_1 zeta + ..., E' = -U' E
// gives the recurrence
//     n e_n = -(sum over k of k a_k e_(n-k)),    F = f_0 + sum over n of e_n / (n + 1) zeta^(n+1).
//
// Back from the lattice's plane: let p be the point of the lattice nearest to w = F(zeta), at most
// 0.58 away. With s = (p - w) / F'(zeta), the step to first order, and F'' = -U' F',
//     zeta + s + (U'(zeta) / 2) s^2
// is its preimage to second order. The remaining error, of third order, is about (h / radius)^2 of
// a spacing: 0.4 % in a square of 16 rows.
//
// Deterministic: sums and products in a fixed order, and SLEEF's exp. Thread-safety: a value.
#pragma once

#include <array>
#include <cstddef>

#include "engine/base/geometry.h"
#include "engine/size/lattice/complex.h"
#include "engine/size/lattice/lattice.h"

namespace weft {

class ConformalMap {
 public:
  static constexpr std::size_t kHarmonics = 5;
  static constexpr std::size_t kDegree = 14;

  // U(zeta) = sum over k of u[k] zeta^k.
  using Exponent = std::array<Complex, kHarmonics + 1>;

  ConformalMap() = default;

  // The map for edges of length `scale` * exp(Re U) in the disk around a point. REQUIRES: the
  // moduli of u[1] and up sum to at most kMaxBend; Re u[0] is finite.
  ConformalMap(Point centre, double radius, const Exponent& u, double scale);

  // Up to this sum of the coefficients the series is long enough: the terms of F' that are left out
  // are of third order in u[5] and u[4], of fifth order in u[3], of higher order in the others, and
  // these fall with k. They change only the spacing; triangles are equilateral for any polynomial
  // F.
  static constexpr double kMaxBend = 1.5;

  // F at a point, and its derivative in units of the plane.
  struct Value {
    Complex w;
    Complex slope;
  };
  Value at(Point p) const {
    Value value = evaluate(zeta_of(p));
    value.slope = inverse_radius_ * value.slope;
    return value;
  }

  // Turns the lattice by a complex number of modulus 1 and shifts it.
  void move(Complex turn, Complex shift) {
    for (Complex& c : f_) c = turn * c;
    f_[0] = f_[0] + shift;
  }

  // Returns the lattice point nearest to p; its spacing is 0 if p is outside the disk.
  LatticePoint nearest(Point p, double jitter) const {
    const Complex zeta = zeta_of(p);
    if (!(norm2(zeta) < kEnd2)) [[unlikely]]
      return {};
    const Value value = evaluate(zeta);
    if (!(norm2(value.w) < kFarthestInLattice2)) [[unlikely]]
      return {};
    const Complex back = inverse(value.slope);
    const Complex step = (nearest_of_lattice(value.w, jitter) - value.w) * back;
    Complex half_bend = half_bend_.back();
    for (std::size_t k = half_bend_.size() - 1; k-- > 0;)
      half_bend = half_bend * zeta + half_bend_[k];
    const Complex by = step + half_bend * (step * step);
    return {{p.x + radius_ * by.re, p.y + radius_ * by.im}, radius_ * radius_ * norm2(back)};
  }

 private:
  static constexpr double kEnd2 = 1.0001;  // rounding of the square's corners

  Complex zeta_of(Point p) const {
    return {(p.x - centre_.x) * inverse_radius_, (p.y - centre_.y) * inverse_radius_};
  }
  Value evaluate(Complex zeta) const {
    Complex w = f_[degree_];
    Complex slope;
    for (std::size_t k = degree_; k-- > 0;) {
      slope = slope * zeta + w;
      w = w * zeta + f_[k];
    }
    return {w, slope};
  }

  Point centre_{};
  double radius_ = 0;
  double inverse_radius_ = 0;
  std::size_t degree_ = 0;  // terms beyond are negligible
  std::array<Complex, kDegree + 1> f_{};
  std::array<Complex, kHarmonics> half_bend_{};  // U' / 2
};

}  // namespace weft
