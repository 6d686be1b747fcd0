// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/mesh_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "tests/engine/size/fields/field_laws.h"

namespace weft {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

MeshField made(FieldMesh mesh) {
  auto field = MeshField::make(std::move(mesh), "here", ExecutionContext());
  EXPECT_TRUE(field) << field.error().message;
  return std::move(*field);
}

// Of the square from 0 to 1: n x n cells of two triangles, inner nodes moved, triangles in random
// order and orientation, values f(p).
template <class F>
FieldMesh square(std::uint32_t n, const F& f, std::mt19937_64& random) {
  FieldMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      Point p{static_cast<double>(i) / n, static_cast<double>(j) / n};
      if (i > 0 && i < n) p.x += 0.3 * (uniform(random) - 0.5) / n;
      if (j > 0 && j < n) p.y += 0.3 * (uniform(random) - 0.5) / n;
      mesh.vertices.push_back(p);
      mesh.values.push_back(f(p));
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 1, a + n + 2});
    }
  }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

double linear(Point p) {
  return 3 * p.x - 4 * p.y + 1;
}
double wave(Point p) {
  return std::sin(9 * p.x) * std::cos(7 * p.y);
}
const Box kSquare{0, 0, 1, 1};

FieldMesh random_triangles(std::size_t n, std::mt19937_64& random) {
  FieldMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Point middle = random_point(kSquare, random);
    const double size = std::pow(10, -3 * uniform(random));
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(
          {middle.x + size * (uniform(random) - 0.5), middle.y + size * (uniform(random) - 0.5)});
      mesh.values.push_back(uniform(random) - 0.5);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(MeshField, OfALinearFunctionIsThatFunctionAndItsSlope) {
  std::mt19937_64 random(1);
  const MeshField field = made(square(30, linear, random));
  const auto slope = field.slope();
  for (int i = 0; i < 3'000; ++i) {
    const Point p = random_point(kSquare, random);
    EXPECT_NEAR(field(p), linear(p), 1e-14);
    EXPECT_NEAR((*slope)(p), 5, 1e-12);
  }
  EXPECT_NEAR(field.steepness({0.3, 0.3, 0.7, 0.7}), 5, 1e-12);
  const Interval bounds = field.bounds({0.41, 0.42, 0.43, 0.44});
  EXPECT_NEAR(bounds.lo, 3 * 0.41 - 4 * 0.44 + 1, 1e-11);
  EXPECT_NEAR(bounds.hi, 3 * 0.43 - 4 * 0.42 + 1, 1e-11);
}

TEST(MeshField, IsItsValuesAtItsVerticesAndLinearBetween) {
  const MeshField field = made({{{0, 0}, {2, 0}, {0, 2}}, {{2, 1, 0}}, {1, 3, -5}});
  EXPECT_EQ(field({0, 0}), 1);
  EXPECT_EQ(field({2, 0}), 3);
  EXPECT_EQ(field({0, 2}), -5);
  EXPECT_EQ(field({1, 0}), 2);
  EXPECT_EQ(field({1, 1}), -1);
  EXPECT_EQ((*field.slope())({0.5, 0.5}), std::sqrt(1 + 9));
}

TEST(MeshField, IsOutsideThatOfTheNearestPoint) {
  const MeshField field = made({{{0, 0}, {2, 0}, {0, 2}}, {{0, 1, 2}}, {1, 3, -5}});
  EXPECT_EQ(field({1, -1e-12}), 2);
  EXPECT_EQ(field({1, -7}), 2);
  EXPECT_EQ(field({9, -7}), 3);
  EXPECT_EQ(field({-4, 1}), -2);
  EXPECT_EQ(field({4, 4}), -1);
  EXPECT_EQ(field({-1, -1}), 1);
  EXPECT_EQ(field({1e300, 0}), 3);
  EXPECT_EQ(field({0, HUGE_VAL}), -5);
  EXPECT_TRUE(std::isnan(field({kNan, 0})));
}

TEST(MeshField, AgreesWithAllTrianglesTriedInTurn) {
  std::mt19937_64 random(2);
  const FieldMesh mesh = random_triangles(300, random);
  const MeshField field = made(mesh);
  int held = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Point p = random_point({-0.5, -0.5, 1.5, 1.5}, random);
    double expected = kNan;
    double nearest = HUGE_VAL;
    for (const auto& t : mesh.triangles) {
      const Point a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
      const auto twice = [](Point u, Point v, Point w) {
        return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
      };
      const double all = twice(a, b, c);
      const double u = twice(p, b, c) / all, v = twice(a, p, c) / all, w = twice(a, b, p) / all;
      if (u >= 0 && v >= 0 && w >= 0) {
        expected = u * mesh.values[t[0]] + v * mesh.values[t[1]] + w * mesh.values[t[2]];
        ++held;
        break;
      }
      for (int k = 0; k < 3; ++k) {
        const Point from = mesh.vertices[t[k]], to = mesh.vertices[t[(k + 1) % 3]];
        const double s =
            std::clamp(((p.x - from.x) * (to.x - from.x) + (p.y - from.y) * (to.y - from.y)) /
                           distance2(from, to),
                       0.0, 1.0);
        const Point q{from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)};
        if (distance2(p, q) < nearest) {
          nearest = distance2(p, q);
          expected = (1 - s) * mesh.values[t[k]] + s * mesh.values[t[(k + 1) % 3]];
        }
      }
    }
    ASSERT_NEAR(field(p), expected, 1e-9) << p.x << " " << p.y;
  }
  EXPECT_GT(held, 200);
  EXPECT_LT(held, 1'800);
}

TEST(MeshField, OfTrianglesThatOverlapIsTheFirst) {
  const std::vector<Point> vertices{{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}};
  const std::vector<double> values{1, 1, 1, 2, 2, 2};
  EXPECT_EQ(made({vertices, {{0, 1, 2}, {3, 4, 5}}, values})({0.2, 0.2}), 1);
  EXPECT_EQ(made({vertices, {{4, 3, 5}, {0, 1, 2}}, values})({0.2, 0.2}), 2);
  EXPECT_EQ(made({vertices, {{4, 3, 5}, {0, 1, 2}}, values})({2, 0}), 2);
}

TEST(MeshField, IsUndefinedInTrianglesOfAVertexWithoutValue) {
  const MeshField field =
      made({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {1, 1, 1, kNan}});
  EXPECT_EQ(field({0.9, 0.1}), 1);
  EXPECT_TRUE(std::isnan(field({0.1, 0.9})));
  EXPECT_TRUE(std::isnan(field({-5, 0.9})));
  EXPECT_TRUE(std::isnan((*field.slope())({0.1, 0.9})));
  EXPECT_TRUE(field.bounds({0.1, 0.9, 0.1, 0.9}).may_be_nan);
  EXPECT_FALSE(field.bounds({0.9, 0.1, 0.9, 0.1}).may_be_nan);
}

TEST(MeshField, HasBoundsAndSteepnessThatHoldInEveryBox) {
  std::mt19937_64 random(3);
  for (const std::uint32_t n : {1u, 2u, 5u, 60u}) {
    FieldMesh mesh = square(n, wave, random);
    if (n == 5) mesh.values[7] = kNan;
    const MeshField field = made(mesh);
    expect_bounds_to_hold(field, kSquare, 1.0 / n, 2'000, true, n);
    expect_bounds_to_hold(*field.slope(), kSquare, 1.0 / n, 2'000, false, n);
    if (HasFatalFailure()) return;
  }
}

TEST(MeshField, HasBoundsAndSteepnessThatHoldOnAHostileMesh) {
  std::mt19937_64 random(4);
  FieldMesh overlap = random_triangles(200, random);
  FieldMesh needles = random_triangles(200, random);
  for (Point& p : needles.vertices) p.y = 0.5 + 1e-7 * p.y;
  // Two layers with common edges inside, whose triangles take turns.
  FieldMesh layers = square(8, wave, random);
  const FieldMesh second = square(
      8, [](Point p) { return 5 + wave(p); }, random);
  const auto offset = static_cast<std::uint32_t>(layers.vertices.size());
  for (std::size_t i = 0; i < second.triangles.size(); ++i) {
    const auto& t = second.triangles[i];
    layers.triangles.insert(layers.triangles.begin() + static_cast<std::ptrdiff_t>(2 * i),
                            {t[0] + offset, t[1] + offset, t[2] + offset});
  }
  layers.vertices.insert(layers.vertices.end(), second.vertices.begin(), second.vertices.end());
  layers.values.insert(layers.values.end(), second.values.begin(), second.values.end());
  for (const FieldMesh& mesh : {overlap, needles, layers}) {
    const MeshField field = made(mesh);
    expect_bounds_to_hold(field, kSquare, 0.1, 3'000, true, 1);
    expect_bounds_to_hold(field, {-0.1, 0.5 - 1e-7, 1.1, 0.5 + 2e-7}, 1e-8, 3'000, true, 1);
    expect_bounds_to_hold(*field.slope(), kSquare, 0.1, 3'000, false, 2);
    if (HasFatalFailure()) return;
  }
}

TEST(MeshField, KnowsItsSteepnessInsideAndNowhereElse) {
  std::mt19937_64 random(5);
  const MeshField field = made(square(20, wave, random));
  EXPECT_LT(field.steepness({0.2, 0.2, 0.7, 0.6}), 12);
  EXPECT_LT(field.steepness({0.5, 0.5, 0.501, 0.501}), 12);
  EXPECT_TRUE(std::isinf(field.steepness({0.5, 0.5, 1.1, 0.6})));
  EXPECT_TRUE(std::isinf(field.steepness({1.5, 0.5, 1.6, 0.6})));
}

TEST(MeshField, HasTheSameBitsAloneAndInBatches) {
  std::mt19937_64 random(6);
  const MeshField field = made(square(40, wave, random));
  expect_same_bits_in_batches(field, {-0.2, -0.2, 1.2, 1.2}, 6);
  expect_same_bits_in_batches(*field.slope(), {-0.2, -0.2, 1.2, 1.2}, 7);
  const MeshField overlap = made(random_triangles(400, random));
  expect_same_bits_in_batches(overlap, {-0.2, -0.2, 1.2, 1.2}, 8);
}

TEST(MeshField, IsTheSameOnAnyNumberOfThreads) {
  std::mt19937_64 random(7);
  const FieldMesh mesh = square(150, wave, random);
  const MeshField alone = made(mesh);
  for (const int threads : {2, 3, 7}) {
    Arena arena(threads);
    ExecutionContext context;
    context.set_arena(arena);
    const auto field = MeshField::make(mesh, "here", context);
    ASSERT_TRUE(field);
    EXPECT_EQ(alone.operations(), field->operations());
    for (int i = 0; i < 1'000; ++i) {
      const Box box = random_box(kSquare, 0.1, random);
      EXPECT_EQ(bits(alone.bounds(box).lo), bits(field->bounds(box).lo));
      EXPECT_EQ(bits(alone.bounds(box).hi), bits(field->bounds(box).hi));
      EXPECT_EQ(bits(alone.steepness(box)), bits(field->steepness(box)));
      EXPECT_EQ(bits(alone({box.min_x, box.min_y})), bits((*field)({box.min_x, box.min_y})));
    }
  }
}

TEST(MeshField, OfManySliversOrCopiesTakesLittleTimeForAPoint) {
  constexpr std::uint32_t kMany = 200'000;
  FieldMesh fan{{{0, 0}}, {}, {0}};
  FieldMesh copies{{{0, 0}, {1, 0}, {0, 1}}, {}, {1, 2, 3}};
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const double angle = 2 * std::numbers::pi * i / kMany;
    fan.vertices.push_back({std::cos(angle), std::sin(angle)});
    fan.values.push_back(1);
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kMany});
    copies.triangles.push_back({0, 1, 2});
  }
  const MeshField field = made(fan);
  EXPECT_NEAR(field({0.3, 0.4}), 0.5, 1e-8);
  EXPECT_GT(field.operations(), 10'000u);  // it says what it costs
  const Interval bounds = field.bounds({-0.1, -0.1, 0.1, 0.1});
  EXPECT_LE(bounds.lo, 0);
  EXPECT_GE(bounds.hi, 0.14);
  const MeshField same = made(copies);
  EXPECT_NEAR(same({0.25, 0.25}), 1.75, 1e-15);
  EXPECT_TRUE(std::isinf(same.steepness({0.25, 0.25, 0.26, 0.26})));
}

TEST(MeshField, LeavesOutFlatTriangles) {
  const MeshField field =
      made({{{0, 0}, {1, 0}, {2, 0}, {0, 1}}, {{0, 1, 2}, {0, 0, 3}, {0, 2, 3}}, {0, 9, 2, 0}});
  EXPECT_EQ(field({1, 0}), 1);
}

TEST(MeshField, HasNoValueThatItsBoundsDoNotExpectNearTheLargestDouble) {
  const double most = std::numeric_limits<double>::max();
  const MeshField field =
      made({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {most, -most, most, -most}});
  expect_bounds_to_hold(field, kSquare, 1, 1'000, false, 1);
  expect_bounds_to_hold(*field.slope(), kSquare, 1, 1'000, false, 1);
}

TEST(MeshField, StaysGoodWhenItMoves) {
  MeshField field = made({{{0, 0}, {2, 0}, {0, 2}}, {{0, 1, 2}}, {1, 3, -5}});
  const MeshField moved = std::move(field);
  EXPECT_EQ(moved({1, 0}), 2);
}

TEST(MeshField, NamesWhatIsWrong) {
  const FieldMesh good{{{0, 0}, {2, 0}, {0, 2}}, {{0, 1, 2}}, {1, 3, -5}};
  const auto error = [](const FieldMesh& mesh) {
    const auto field = MeshField::make(mesh, "size.fields[1].mesh", ExecutionContext());
    EXPECT_FALSE(field);
    return field ? Error{} : field.error();
  };
  const auto expect = [&](const FieldMesh& mesh, ErrorCode code, const char* field) {
    EXPECT_EQ(error(mesh).code, code);
    EXPECT_EQ(error(mesh).field, field);
  };
  FieldMesh bad = good;
  bad.vertices[1].x = kNan;
  expect(bad, ErrorCode::kBadCoordinate, "size.fields[1].mesh.vertices[1].x");
  bad = good;
  bad.vertices[2].y = 1e51;
  expect(bad, ErrorCode::kBadCoordinate, "size.fields[1].mesh.vertices[2].y");
  bad = good;
  bad.triangles.push_back({0, 3, 1});
  expect(bad, ErrorCode::kIndexOutOfRange, "size.fields[1].mesh.triangles[1]");
  bad = good;
  bad.values[2] = -HUGE_VAL;
  expect(bad, ErrorCode::kBadSizeValue, "size.fields[1].mesh.values[2]");
  bad = good;
  bad.values.pop_back();
  expect(bad, ErrorCode::kBadOption, "size.fields[1].mesh.values");
  bad = good;
  bad.triangles = {{0, 1, 1}};
  expect(bad, ErrorCode::kBadOption, "size.fields[1].mesh.triangles");
  expect({}, ErrorCode::kBadOption, "size.fields[1].mesh.triangles");
}

TEST(MeshField, StopsWhenTheJobIsCancelled) {
  ExecutionContext context;
  context.cancel();
  const FieldMesh mesh{{{0, 0}, {2, 0}, {0, 2}}, {{0, 1, 2}}, {1, 3, -5}};
  EXPECT_EQ(MeshField::make(mesh, "here", context).error().code, ErrorCode::kCancelled);
}

TEST(MeshField, TakesNoMoreMemoryThanItSays) {
  std::mt19937_64 random(8);
  for (const std::uint32_t n : {1u, 3u, 100u}) {
    const FieldMesh mesh = square(n, wave, random);
    const std::size_t held = mesh.vertices.size() * (sizeof(Point) + sizeof(double));
    EXPECT_LE(made(mesh).bytes() - held, MeshField::bytes_to_make(mesh.triangles.size()));
  }
}

}  // namespace
}  // namespace weft
