// SPDX-License-Identifier: Apache-2.0
// Small PSLGs with arcs.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "tests/engine/domain/shapes.h"
#include "weft/pslg.h"

namespace weft {

inline constexpr double kPi = 3.14159265358979323846;

// Between two points of the PSLG.
inline void add_arc(Pslg& pslg, std::uint32_t a, std::uint32_t b, double bulge,
                    std::int32_t marker = 0) {
  pslg.segments.push_back({a, b, marker});
  pslg.arcs.push_back({static_cast<std::uint32_t>(pslg.segments.size() - 1), bulge});
}

// Of equal arcs, from an angle on.
inline void add_circle(Pslg& pslg, Point centre, double radius, std::uint32_t arcs = 4,
                       double from = 0, std::int32_t marker = 0) {
  const auto first = static_cast<std::uint32_t>(pslg.points.size());
  for (std::uint32_t i = 0; i < arcs; ++i) {
    const double angle = from + 2 * kPi * i / arcs;
    pslg.points.push_back(
        {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  for (std::uint32_t i = 0; i < arcs; ++i)
    add_arc(pslg, first + i, first + (i + 1) % arcs, std::tan(kPi / (2 * arcs)), marker);
}

inline Pslg plate_with_holes(int across) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {static_cast<double>(across), static_cast<double>(across)});
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      add_circle(pslg, {i + 0.5, j + 0.5}, 0.3);
      pslg.holes.push_back({i + 0.5, j + 0.5});
    }
  }
  return pslg;
}

// A box from (-10, -10) to (10, 10) with arcs and segments of 1e-4 to 4 in it, which may cross,
// meet, and be flat or round; with every third seed, with circles that touch.
inline Pslg random_arcs(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  Pslg pslg;
  add_box(pslg, {-10, -10}, {10, 10});
  if (seed % 3 == 0) {
    const Point centre{uniform(-3, 3), uniform(-3, 3)};
    const double radius = uniform(0.5, 2);
    add_circle(pslg, centre, radius, 2 + random() % 4, uniform(0, 6));
    for (std::uint64_t i = random() % 3 + 1; i-- > 0;) {
      const double other = radius * std::pow(10, uniform(-1.5, 0.3));
      const double angle = uniform(0, 2 * kPi);
      const double apart = other < radius && random() % 2 == 0 ? radius - other : radius + other;
      add_circle(pslg, {centre.x + apart * std::cos(angle), centre.y + apart * std::sin(angle)},
                 other, 2 + random() % 4, random() % 2 == 0 ? angle : angle + kPi);
    }
    return pslg;
  }
  for (std::uint64_t i = random() % 8 + 1; i-- > 0;) {
    const auto a = static_cast<std::uint32_t>(pslg.points.size());
    const double size = std::min(4.0, std::pow(10, uniform(-4, 0.6)));
    const double angle = uniform(0, 2 * kPi);
    const Point from{uniform(-4, 4), uniform(-4, 4)};
    pslg.points.push_back(from);
    pslg.points.push_back({from.x + size * std::cos(angle), from.y + size * std::sin(angle)});
    const double bulge = std::pow(10, uniform(-6, 0.2)) * (random() % 2 == 0 ? 1 : -1);
    if (random() % 4 == 0) {
      pslg.segments.push_back({a, a + 1});
    } else {
      add_arc(pslg, a, a + 1, bulge);
    }
    if (a == 4 || random() % 4 != 0) continue;
    const auto other = 4 + static_cast<std::uint32_t>(random() % (a - 4));
    add_arc(pslg, a + 1, other, uniform(-1, 1));
  }
  return pslg;
}

}  // namespace weft
