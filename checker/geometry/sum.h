// SPDX-License-Identifier: Apache-2.0
// Sums of many terms without loss, for areas.
#pragma once

#include <cmath>

#include "checker/domain.h"

namespace weft::check {

// A compensated sum (A. Neumaier, 1974): its error does not grow with the number of terms.
class Sum {
 public:
  void add(long double term) {
    const long double next = total_ + term;
    lost_ += std::fabs(total_) >= std::fabs(term) ? (total_ - next) + term : (term - next) + total_;
    total_ = next;
  }
  long double total() const { return total_ + lost_; }

 private:
  long double total_ = 0;
  long double lost_ = 0;
};

// (p - o) x (q - o), twice the area of the triangle o, p, q.
inline long double cross_from(Vec2 o, Vec2 p, Vec2 q) {
  const long double ux = static_cast<long double>(p.x) - o.x;
  const long double uy = static_cast<long double>(p.y) - o.y;
  const long double vx = static_cast<long double>(q.x) - o.x;
  const long double vy = static_cast<long double>(q.y) - o.y;
  return ux * vy - uy * vx;
}

}  // namespace weft::check
