// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/crossing.h"

#include <gmpxx.h>
#include <mpfr.h>

namespace weft {
namespace {

double nearest_double(const mpq_class& q) {
  MPFR_DECL_INIT(rounded, 53);
  mpfr_set_q(rounded, q.get_mpq_t(), MPFR_RNDN);
  return mpfr_get_d(rounded, MPFR_RNDN);
}

}  // namespace

Point crossing_point(Point a, Point b, Point c, Point d) {
  const mpq_class ax(a.x), ay(a.y), cx(c.x), cy(c.y);
  const mpq_class ux = b.x - ax, uy = b.y - ay;
  const mpq_class vx = d.x - cx, vy = d.y - cy;
  // a + t u lies on cd.
  const mpq_class t = ((cx - ax) * vy - (cy - ay) * vx) / (ux * vy - uy * vx);
  return {nearest_double(ax + t * ux), nearest_double(ay + t * uy)};
}

}  // namespace weft
