// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/orientation.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace weft::files {
namespace {

// An exact sum of doubles, as a nonoverlapping expansion in increasing order of magnitude
// (Grow-Expansion).
class Expansion {
 public:
  void add(double b) {
    double carry = b;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = carry + terms_[i];
      const double virtual_b = sum - carry;
      terms_[i] = (carry - (sum - virtual_b)) + (terms_[i] - virtual_b);
      carry = sum;
    }
    terms_[size_++] = carry;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    for (std::size_t i = size_; i-- > 0;)
      if (terms_[i] != 0) return terms_[i] > 0 ? 1 : -1;
    return 0;
  }

 private:
  std::array<double, 12> terms_{};
  std::size_t size_ = 0;
};

}  // namespace

int orientation(Point a, Point b, Point c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  constexpr double kErrorBound = 3.3306690738754716e-16;  // (3 + 16 eps) eps, eps = 2^-53
  if (std::abs(det) > kErrorBound * (std::abs(left) + std::abs(right))) return det > 0 ? 1 : -1;

  Expansion area;
  area.add_product(a.x, b.y);
  area.add_product(-a.x, c.y);
  area.add_product(-c.x, b.y);
  area.add_product(-a.y, b.x);
  area.add_product(a.y, c.x);
  area.add_product(c.y, b.x);
  return area.sign();
}

void turn_counter_clockwise(Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) {
      return &mesh.coordinates[2 * std::size_t{mesh.triangles[t + k]}];
    };
    const double* a = at(0);
    const double* b = at(1);
    const double* c = at(2);
    if ((b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]))
      std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  }
}

}  // namespace weft::files
