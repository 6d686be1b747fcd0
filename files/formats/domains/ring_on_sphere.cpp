// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ring_on_sphere.h"

#include <cmath>

namespace weft::files {
namespace {

double step(Point from, Point to) {
  return std::remainder(to.x - from.x, 360);
}

// From the first position to the last, in degrees.
double turned(std::span<const Point> ring) {
  double sum = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) sum += step(ring[i - 1], ring[i]);
  return sum;
}

constexpr double kHalf = 180;  // a turn is a multiple of 360, but for rounding

}  // namespace

bool comes_round(std::span<const Point> ring) {
  if (ring.size() < 4) return false;
  const Point first = ring.front();
  const Point last = ring.back();
  return first.y == last.y && std::abs(first.y) < 90 && std::abs(last.x - first.x) == 360 &&
         std::abs(turned(ring)) > kHalf;
}

bool is_around_pole(std::span<const Point> ring) {
  return std::abs(turned(ring) + step(ring.back(), ring.front())) > kHalf;
}

std::vector<Point> unrolled(std::span<const Point> ring, double near) {
  std::vector<Point> plane;
  double at = near + std::remainder(ring.front().x - near, 360);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (i > 0) at += step(ring[i - 1], ring[i]);
    plane.push_back({at, ring[i].y});
  }
  if (!is_around_pole(ring)) return plane;
  double latitudes = 0;
  for (const Point p : ring) latitudes += p.y;
  // Beyond the pole, so that the ring does not touch what closes it.
  const double pole = latitudes < 0 ? -100 : 100;
  const double end = at + step(ring.back(), ring.front());
  plane.insert(plane.end(), {{end, ring.front().y}, {end, pole}, {plane.front().x, pole}});
  return plane;
}

}  // namespace weft::files
