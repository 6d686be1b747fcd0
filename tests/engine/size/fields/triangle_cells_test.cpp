// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/triangle_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "tests/engine/size/fields/field_laws.h"

namespace weft {
namespace {

struct Triangles {
  std::vector<Point> vertices;
  std::vector<NumberedTriangle> triangles;
  TriangleTree tree;
  TriangleCells cells;

  void add(Point a, Point b, Point c) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    // Some numbers are left out.
    triangles.push_back({{first, first + 1, first + 2}, first});
  }
  void build(const ExecutionContext& context = {}) {
    EXPECT_FALSE(tree.build(vertices, triangles, context));
    EXPECT_FALSE(cells.build(tree, context));
  }
  std::uint32_t first_that_holds(Point p) const {
    const auto near = cells.near(p);
    if (!near) return tree.holding(p).place;
    const auto holds = [&](std::uint32_t place) { return tree.holds(place, p); };
    const auto found = std::find_if(near->begin(), near->end(), holds);
    return found == near->end() ? kNone : *found;
  }
};

// That overlap, from a thousandth of the square to all of it.
void add_random(std::size_t n, std::mt19937_64& random, Triangles& to) {
  for (std::size_t i = 0; i < n; ++i) {
    const Point middle = random_point({0, 0, 1, 1}, random);
    const double size = std::pow(10, -3 * uniform(random));
    Point corner[3];
    for (Point& c : corner)
      c = {middle.x + size * (uniform(random) - 0.5), middle.y + size * (uniform(random) - 0.5)};
    const auto [a, b, c] = corner;
    const bool left = (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
    to.add(a, left ? b : c, left ? c : b);
  }
}

// n x n cells of two triangles; all corners are exact.
void add_grid(int n, Triangles& to) {
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = i, y = j;
      to.add({x, y}, {x + 1, y}, {x + 1, y + 1});
      to.add({x, y}, {x + 1, y + 1}, {x, y + 1});
    }
  }
}

TEST(TriangleCells, FindWhatTheTreeFinds) {
  std::mt19937_64 random(1);
  Triangles some;
  add_random(3'000, random, some);
  some.build();
  std::size_t held = 0;
  for (int i = 0; i < 20'000; ++i) {
    Point p = random_point({-0.6, -0.6, 1.6, 1.6}, random);
    if (i % 4 == 0) p = some.vertices[random() % some.vertices.size()];
    const std::uint32_t expected = some.tree.holding(p).place;
    ASSERT_EQ(some.first_that_holds(p), expected) << p.x << " " << p.y;
    held += expected != kNone;
  }
  EXPECT_GT(held, 10'000u);
  EXPECT_LT(held, 19'000u);
}

TEST(TriangleCells, FindTheFirstOfThoseWithACommonEdgeOrVertex) {
  Triangles grid;
  add_grid(64, grid);
  std::mt19937_64 random(2);
  std::shuffle(grid.triangles.begin(), grid.triangles.end(), random);
  for (std::size_t i = 0; i < grid.triangles.size(); ++i)
    grid.triangles[i].number = static_cast<std::uint32_t>(2 * i + 1);
  grid.build();
  for (int i = 0; i <= 128; ++i) {
    for (int j = 0; j <= 128; ++j) {
      const Point p{0.5 * i, 0.5 * j};
      const auto near = grid.cells.near(p);
      ASSERT_TRUE(near);
      ASSERT_LE(near->size(), 32u);
      ASSERT_NE(grid.first_that_holds(p), kNone);
      ASSERT_EQ(grid.first_that_holds(p), grid.tree.holding(p).place) << p.x << " " << p.y;
    }
  }
}

TEST(TriangleCells, HaveAListOutsideAndAtANan) {
  Triangles grid;
  add_grid(8, grid);
  grid.build();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Point p : {Point{-1, 3}, Point{1e300, -1e300}, Point{HUGE_VAL, 1}, Point{kNan, kNan}})
    EXPECT_EQ(grid.first_that_holds(p), kNone);
}

TEST(TriangleCells, LeaveManyCopiesAndSliversToTheTree) {
  constexpr std::size_t kMany = 20'000;
  Triangles copies;
  Triangles fan;
  for (std::size_t i = 0; i < kMany; ++i) {
    copies.add({0, 0}, {1, 0}, {0, 1});
    const double angle = 1.5 * static_cast<double>(i) / kMany;
    fan.add({0, 0}, {std::cos(angle), std::sin(angle)},
            {std::cos(angle + 1e-3), std::sin(angle + 1e-3)});
  }
  for (Triangles* const many : {&copies, &fan}) {
    many->build();
    EXPECT_FALSE(many->cells.near({0.1, 0.1}));
    EXPECT_LT(many->cells.bytes(), TriangleCells::bytes_to_build(kMany));
    EXPECT_EQ(many->first_that_holds({0.1, 0.1}), many->tree.holding({0.1, 0.1}).place);
  }
}

TEST(TriangleCells, AreTheSameOnAnyNumberOfThreads) {
  std::mt19937_64 random(3);
  Triangles alone;
  add_random(20'000, random, alone);
  add_grid(40, alone);
  Triangles together;
  together.vertices = alone.vertices;
  together.triangles = alone.triangles;
  alone.build();
  Arena arena(3);
  ExecutionContext context;
  context.set_arena(arena);
  together.build(context);
  EXPECT_EQ(alone.cells.bytes(), together.cells.bytes());
  for (int i = 0; i < 5'000; ++i) {
    const Point p = random_point(i % 2 == 0 ? Box{0, 0, 1, 1} : Box{0, 0, 40, 40}, random);
    const auto here = alone.cells.near(p);
    const auto there = together.cells.near(p);
    ASSERT_EQ(here.has_value(), there.has_value());
    if (here) {
      ASSERT_TRUE(std::equal(here->begin(), here->end(), there->begin(), there->end()));
    }
  }
}

}  // namespace
}  // namespace weft
