// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/medial_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

MedialAxis axis_of(const Pslg& pslg) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  if (!domain) throw std::runtime_error(domain.error().message);
  const Result<MedialAxis> axis = medial_axis(*domain, context);
  if (!axis) throw std::runtime_error(axis.error().message);
  return *axis;
}

double length(const std::vector<Line>& lines) {
  double sum = 0;
  for (const Line& line : lines) sum += std::sqrt(distance2(line.a, line.b));
  return sum;
}

TEST(MedialAxis, OfAStripIsItsMiddleLine) {
  Pslg strip;
  add_box(strip, {0, 0}, {10, 1});
  const MedialAxis axis = axis_of(strip);
  for (const Line& line : axis.axis)
    for (const Point p : {line.a, line.b})
      if (p.x > 0.5 && p.x < 9.5) {
        EXPECT_NEAR(p.y, 0.5, 1e-9) << p.x;
      }
  // It ends half a width before the ends.
  EXPECT_NEAR(length(axis.axis), 9, 0.1);
}

TEST(MedialAxis, WallsAreTheEdgesWithTheMeshedAreaOnOneSide) {
  Pslg strip;
  add_box(strip, {0, 0}, {10, 1});
  add_box(strip, {4, 0.4}, {5, 0.6});  // a hole
  strip.holes = {{4.5, 0.5}};
  add_segment(strip, {1, 0.5}, {3, 0.5}, 7);  // a slit
  add_segment(strip, {8, 0}, {8, 1}, 8);      // the border of a region
  strip.regions = {{.at = {9, 0.5}, .id = 3, .max_area = {}}};
  strip.points.push_back({7, 0.5});
  EXPECT_DOUBLE_EQ(length(axis_of(strip).walls), 22 + 2.4);
}

TEST(MedialAxis, EveryComponentHasOne) {
  std::mt19937 random(3);
  const auto next = [&] { return random() / 4294967296.0; };
  constexpr int kTriangles = 500;
  Pslg triangles;
  for (int i = 0; i < kTriangles; ++i)
    add_ring(triangles,
             {{2.0 * i + next(), next()}, {2.0 * i + next(), next()}, {2.0 * i + next(), next()}});
  std::vector<int> parts(kTriangles);
  for (const Line& line : axis_of(triangles).axis) ++parts[static_cast<std::size_t>(line.a.x / 2)];
  for (int i = 0; i < kTriangles; ++i) EXPECT_GT(parts[static_cast<std::size_t>(i)], 0) << i;
}

TEST(MedialAxis, AComponentTooSmallForPiecesHasOne) {
  Pslg both;
  add_box(both, {0, 0}, {10, 10});
  add_ring(both, {{11, 0}, {11 + 1e-6, 0}, {11, 1e-6}});
  int inside = 0;
  for (const Line& line : axis_of(both).axis) inside += line.a.x > 11 && line.a.y < 1e-6;
  EXPECT_EQ(inside, 1);
}

TEST(MedialAxis, PiecesAreBoundedInNumberHoweverNarrowThePassage) {
  for (const double width : {1e-4, 1e-9}) {
    Pslg strip;
    add_box(strip, {0, 0}, {10, width});
    EXPECT_LT(axis_of(strip).axis.size(), std::size_t{3} << 17) << width;
    Pslg needle;
    add_ring(needle, {{0, 0}, {10, 0}, {10, width}});
    EXPECT_LT(axis_of(needle).axis.size(), std::size_t{3} << 17) << width;
  }
}

}  // namespace
}  // namespace weft
