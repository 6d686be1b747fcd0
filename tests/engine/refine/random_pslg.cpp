// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/refine/random_pslg.h"

#include <cmath>
#include <ostream>
#include <vector>

#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// A box of segments that cross, overlap and touch at will, on a coarse grid.
Pslg dirty_grid(Random& random) {
  Pslg pslg = square(8);
  for (std::uint32_t n = 1 + random.below(12); n > 0; --n) {
    const Point a{double(random.below(9)), double(random.below(9))};
    const Point b{double(random.below(9)), double(random.below(9))};
    if (a == b) continue;
    add_segment(pslg, a, b, static_cast<std::int32_t>(random.below(4)));
  }
  return pslg;
}

// The same, turned: what met exactly meets within rounding only.
Pslg turned_grid(Random& random) {
  Pslg pslg = dirty_grid(random);
  const double angle = random.unit();
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (Point& p : pslg.points) p = {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
  return pslg;
}

// Rays from one point, so that all angles between them are acute, many tiny.
Pslg star(Random& random) {
  Pslg pslg = square(8);
  const Point centre{4 + random.unit(), 4 + random.unit()};
  for (std::uint32_t n = 2 + random.below(40); n > 0; --n) {
    const double angle = random.unit() * 6.283185307179586;
    const double length = 0.5 + 2.5 * random.unit();
    add_segment(pslg, centre,
                {centre.x + length * std::cos(angle), centre.y + length * std::sin(angle)});
  }
  return pslg;
}

// A triangle with a corner of a few degrees or less.
Pslg wedge(Random& random) {
  Pslg pslg;
  const double angle = std::pow(10, -3 * random.unit());
  add_ring(pslg, {{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}});
  if (random.below(2)) add_segment(pslg, {0, 0}, {std::cos(angle / 3), std::sin(angle / 3)});
  return pslg;
}

// Holes that touch each other and the outside.
Pslg touching_holes(Random& random) {
  Pslg pslg = square(8);
  for (std::uint32_t n = 1 + random.below(6); n > 0; --n) {
    const double x = random.below(7);
    const double y = random.below(7);
    add_ring(pslg, {{x, y + 0.5}, {x + 0.5, y}, {x + 1, y + 0.5}, {x + 0.5, y + 1}});
    pslg.holes.push_back({x + 0.5, y + 0.5});
  }
  return pslg;
}

// Points in clusters, at distances that span six decades.
Pslg clusters(Random& random) {
  Pslg pslg = square(8);
  for (std::uint32_t n = 1 + random.below(3); n > 0; --n) {
    const Point centre{1 + 6 * random.unit(), 1 + 6 * random.unit()};
    const double scale = std::pow(10, -6 * random.unit());
    for (std::uint32_t m = 2 + random.below(8); m > 0; --m) {
      pslg.points.push_back({centre.x + scale * random.unit(), centre.y + scale * random.unit()});
    }
  }
  return pslg;
}

// A ring that crosses itself, filled by the even-odd rule.
Pslg tangled_ring(Random& random) {
  Pslg pslg;
  std::vector<Point> ring;
  for (std::uint32_t n = 3 + random.below(9); n > 0; --n) ring.push_back(random.in_box(8));
  add_ring(pslg, ring);
  pslg.fill = Fill::kEvenOdd;
  return pslg;
}

// Several components, with regions of their own.
Pslg islands(Random& random) {
  Pslg pslg;
  for (std::int32_t i = 0; i < 4; ++i) {
    const double x = 10.0 * i;
    const double width = 0.1 + 8 * random.unit();
    add_box(pslg, {x, 0}, {x + width, 8 * random.unit() + 0.1}, i);
    RegionSeed seed{{x + 0.05, 0.05}, i + 1, {}};
    if (random.below(2)) seed.max_area = 0.01 + random.unit();
    pslg.regions.push_back(seed);
  }
  return pslg;
}

// Polygons that overlap, nest and touch, on a coarse grid, some as holes.
Pslg overlapping_areas(Random& random) {
  Pslg pslg;
  pslg.fill = random.below(4) == 0 ? Fill::kEvenOdd : Fill::kUnion;
  for (std::uint32_t n = 1 + random.below(7); n > 0; --n) {
    const std::size_t first = pslg.segments.size();
    const double x = random.below(7), y = random.below(7);
    if (random.below(2))
      add_box(pslg, {x, y}, {x + 1 + random.below(4), y + 1 + random.below(4)});
    else
      add_ring(pslg, {{x, y}, {x + 3, y + random.below(3)}, {x + random.below(3), y + 4}});
    Area area{.priority = static_cast<std::int32_t>(random.below(2)),
              .is_hole = random.below(6) == 0};
    if (random.below(3)) area.region = static_cast<std::int32_t>(random.below(4));
    if (random.below(3) == 0) area.max_area = 0.05 + random.unit();
    add_area(pslg, first, area);
  }
  if (random.below(2)) add_segment(pslg, random.in_box(8), random.in_box(8), 5);
  return pslg;
}

// The same, turned: borders that met exactly meet within rounding only.
Pslg turned_areas(Random& random) {
  Pslg pslg = overlapping_areas(random);
  const double angle = random.unit();
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (Point& p : pslg.points) p = {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
  return pslg;
}

constexpr Kind kKinds[] = {{"DirtyGrid", dirty_grid},
                           {"TurnedGrid", turned_grid},
                           {"Star", star},
                           {"Wedge", wedge},
                           {"TouchingHoles", touching_holes},
                           {"Clusters", clusters},
                           {"TangledRing", tangled_ring},
                           {"Islands", islands},
                           {"OverlappingAreas", overlapping_areas},
                           {"TurnedAreas", turned_areas}};

}  // namespace

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

std::span<const Kind> kinds() {
  return kKinds;
}

}  // namespace weft
