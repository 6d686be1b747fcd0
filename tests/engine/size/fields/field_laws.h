// SPDX-License-Identifier: Apache-2.0
// The laws of engine/size/field.h, checked on random boxes and batches.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/size/field.h"

namespace weft {

// From 0 to 1.
inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

inline Point random_point(const Box& box, std::mt19937_64& random) {
  const double x = box.min_x + uniform(random) * box.width();
  const double y = box.min_y + uniform(random) * box.height();
  return {std::min(x, box.max_x), std::min(y, box.max_y)};
}

// From a thousandth of `around` to all of it, inside, across its border and outside; sometimes with
// corners on multiples of `step`, sometimes a point or a line.
inline Box random_box(const Box& around, double step, std::mt19937_64& random) {
  const double scale = std::pow(10, -3 * uniform(random));
  const double x = around.min_x + around.width() * (1.6 * uniform(random) - 0.3);
  const double y = around.min_y + around.height() * (1.6 * uniform(random) - 0.3);
  Box box{x, y, x + scale * around.width(), y + scale * around.height()};
  const auto kind = random() % 8;
  if (kind == 0) {
    for (double* side : {&box.min_x, &box.min_y, &box.max_x, &box.max_y})
      *side = std::round(*side / step) * step;
  }
  if (kind == 1) box.max_x = box.min_x;
  if (kind == 2) box.max_y = box.min_y;
  return box;
}

// What bounds say of `boxes` boxes holds at points inside, on the sides and at the corners; with
// `steep`, steepness of pairs of points with 9 defined points between them, too.
inline void expect_bounds_to_hold(const Field& field, const Box& around, double step, int boxes,
                                  bool steep, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < boxes; ++i) {
    const Box box = random_box(around, step, random);
    const Interval bounds = field.bounds(box);
    const double steepness = steep ? field.steepness(box) : 0;
    ASSERT_TRUE(bounds.lo <= bounds.hi || bounds.may_be_nan);
    for (int j = 0; j < 12; ++j) {
      Point p = random_point(box, random);
      if (j % 3 == 0) p.x = j % 2 == 0 ? box.min_x : box.max_x;
      if (j % 4 == 0) p.y = j % 8 == 0 ? box.min_y : box.max_y;
      const double value = field(p);
      if (std::isnan(value)) {
        ASSERT_TRUE(bounds.may_be_nan) << p.x << " " << p.y;
        continue;
      }
      ASSERT_LE(bounds.lo, value) << p.x << " " << p.y << " box " << i;
      ASSERT_GE(bounds.hi, value) << p.x << " " << p.y << " box " << i;
      if (!steep || std::isinf(steepness)) continue;
      const Point q = random_point(box, random);
      bool defined = true;
      for (int k = 1; k <= 10; ++k)
        defined = defined &&
                  !std::isnan(field({p.x + 0.1 * k * (q.x - p.x), p.y + 0.1 * k * (q.y - p.y)}));
      if (!defined) continue;
      const double rounding = 1e-13 * (std::abs(bounds.lo) + std::abs(bounds.hi));
      ASSERT_LE(std::abs(value - field(q)), steepness * std::sqrt(distance2(p, q)) + rounding)
          << p.x << " " << p.y << " to " << q.x << " " << q.y;
    }
  }
}

inline std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

// Points far apart and near one another, alone and in batches.
inline void expect_same_bits_in_batches(const Field& field, const Box& around, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  constexpr std::size_t kPoints = 24;
  alignas(64) std::array<double, kPoints> x, y, out;
  for (int round = 0; round < 200; ++round) {
    const Box box = round % 4 == 0 ? around : random_box(around, 1, random);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const Point p = random_point(box, random);
      x[i] = p.x;
      y[i] = p.y;
    }
    field.evaluate(kPoints, x.data(), y.data(), out.data());
    for (std::size_t i = 0; i < kPoints; ++i) ASSERT_EQ(bits(out[i]), bits(field({x[i], y[i]})));
  }
}

}  // namespace weft
