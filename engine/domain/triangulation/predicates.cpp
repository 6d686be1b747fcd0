// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace weft {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_cgal(Point p) {
  return {p.x, p.y};
}

}  // namespace

int orientation_exact(Point a, Point b, Point c) noexcept {
  return static_cast<int>(Kernel::Orientation_2{}(to_cgal(a), to_cgal(b), to_cgal(c)));
}

bool in_circle_exact(Point a, Point b, Point c, Point p) noexcept {
  return Kernel::Side_of_oriented_circle_2{}(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(p)) ==
         CGAL::ON_POSITIVE_SIDE;
}

int in_circle_sign_exact(Point a, Point b, Point c, Point p) noexcept {
  return static_cast<int>(
      Kernel::Side_of_oriented_circle_2{}(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(p)));
}

}  // namespace weft
