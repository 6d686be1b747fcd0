// SPDX-License-Identifier: Apache-2.0
#include "tests/support/floor_plan.h"

#include <charconv>
#include <cmath>
#include <random>
#include <vector>

namespace weft {
namespace {

// The decimal that an export prints, as a reader parses it.
double round_to(double value, int decimals) {
  if (decimals == kUnrounded) return value;
  char text[64];
  const auto printed =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  double parsed = 0;
  std::from_chars(text, printed.ptr, parsed);
  return parsed;
}

class Draughtsman {
 public:
  explicit Draughtsman(const FloorPlan& plan) : plan_(plan), random_(plan.seed) {
    // Cosine and sine of an angle below 90 degrees, by a rational parametrisation.
    const double t = unit();
    cosine_ = (1 - t * t) / (1 + t * t);
    sine_ = 2 * t / (1 + t * t);
  }

  Pslg draw() {
    const double width = 12 + 28 * unit(), height = 8 + 16 * unit();
    add_ring({{0, 0}, {width, 0}, {width, height}, {0, height}}, 1);
    divide(0, 0, width, height, 2 + static_cast<int>(random_() % 3));
    return pslg_;
  }

 private:
  // Not std::uniform_real_distribution: its values differ between standard libraries.
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  // Splits a room by a partition across it, then both halves.
  void divide(double x0, double y0, double x1, double y1, int depth) {
    constexpr double kMin = 2;
    const bool upright = x1 - x0 > y1 - y0;
    const double extent = upright ? x1 - x0 : y1 - y0;
    if (depth == 0 || extent < 2 * kMin) return furnish(x0, y0, x1, y1);
    const double at = (upright ? x0 : y0) + kMin + (extent - 2 * kMin) * unit();
    // Some partitions are not at right angles to the walls that they end on.
    const double slant = random_() % 4 == 0 ? (unit() - 0.5) : 0;
    const double from = at, to = at + slant;
    const Point a = upright ? Point{from, y0} : Point{x0, from};
    const Point b = upright ? Point{to, y1} : Point{x1, to};
    add_partition(a, b);
    if (slant != 0) return;  // the rooms beside it are no rectangles
    if (upright) {
      divide(x0, y0, at, y1, depth - 1);
      divide(at, y0, x1, y1, depth - 1);
    } else {
      divide(x0, y0, x1, at, depth - 1);
      divide(x0, at, x1, y1, depth - 1);
    }
  }

  // From wall to wall; in two thirds of them there is a door of 0.9.
  void add_partition(Point a, Point b) {
    if (random_() % 3 == 0) return add_segment(a, b);
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double door = 0.9 / std::sqrt(dx * dx + dy * dy);
    const double start = 0.1 + (0.8 - door) * unit();
    const auto along = [&](double t) { return Point{a.x + t * dx, a.y + t * dy}; };
    add_segment(a, along(start));
    add_segment(along(start + door), b);
  }

  // A column in one room of three.
  void furnish(double x0, double y0, double x1, double y1) {
    if (random_() % 3 != 0 || x1 - x0 < 1.5 || y1 - y0 < 1.5) return;
    const double x = x0 + 0.4 * (x1 - x0), y = y0 + 0.3 * (y1 - y0);
    const double side = 0.2 + 0.3 * unit();
    add_ring({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}, 3);
    pslg_.holes.push_back(place({x + side / 2, y + side / 2}));
  }

  void add_ring(const std::vector<Point>& corners, std::int32_t marker) {
    const auto first = static_cast<std::uint32_t>(pslg_.points.size());
    const auto count = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      pslg_.points.push_back(place(corners[i]));
      pslg_.segments.push_back({first + i, first + (i + 1) % count, marker});
    }
  }

  void add_segment(Point a, Point b) {
    const auto first = static_cast<std::uint32_t>(pslg_.points.size());
    pslg_.points.insert(pslg_.points.end(), {place(a), place(b)});
    pslg_.segments.push_back({first, first + 1, 2});
  }

  Point place(Point p) const {
    return {round_to(plan_.offset + (cosine_ * p.x - sine_ * p.y), plan_.decimals),
            round_to(3 * plan_.offset + (sine_ * p.x + cosine_ * p.y), plan_.decimals)};
  }

  const FloorPlan plan_;
  std::mt19937_64 random_;
  double cosine_ = 1, sine_ = 0;
  Pslg pslg_;
};

}  // namespace

Pslg floor_plan(const FloorPlan& plan) {
  return Draughtsman(plan).draw();
}

}  // namespace weft
