// SPDX-License-Identifier: Apache-2.0
// Sides that repeat each other. Every mesh is judged by the independent checker.
#include "engine/refine/periodic_sides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "tests/engine/parallel/parallel.h"
#include "tests/engine/refine/random_pslg.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

// The ring through these points; the segment from point i has the marker i + 1.
Pslg cell(const std::vector<Point>& corners) {
  Pslg pslg;
  add_ring(pslg, corners);
  for (std::size_t i = 0; i < corners.size(); ++i)
    pslg.segments[i].marker = static_cast<std::int32_t>(i + 1);
  return pslg;
}
Pslg unit_cell() {
  return cell({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}
constexpr PeriodicPair kBottomTop{1, 3};
constexpr PeriodicPair kLeftRight{4, 2};

std::set<std::pair<double, double>> vertices_on(std::int32_t marker, const CollectedMesh& made) {
  std::set<std::pair<double, double>> result;
  for (const check::Mesh::Edge& edge : made.mesh.edges) {
    if (edge.marker != marker) continue;
    for (const std::uint32_t v : {edge.a, edge.b})
      result.emplace(made.mesh.vertices[v].x, made.mesh.vertices[v].y);
  }
  return result;
}

// Vertices, edges and triangles of the surface that the sides are glued to; what one side of each
// pair has is counted once.
std::int64_t euler_number(const CollectedMesh& made, const std::vector<PeriodicPair>& pairs) {
  const auto& mesh = made.mesh;
  std::int64_t twice = 0;  // edges on sides, and vertices within sides
  std::set<std::pair<double, double>> on_sides;
  for (const PeriodicPair& pair : pairs) {
    const auto side = vertices_on(pair.from, made);
    twice += static_cast<std::int64_t>(side.size()) - 1;
  }
  const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
  const auto boundary = static_cast<std::int64_t>(
      std::count_if(mesh.edges.begin(), mesh.edges.end(),
                    [](const check::Mesh::Edge& edge) { return edge.marker != 0; }));
  const std::int64_t edges = (3 * triangles + boundary) / 2 - twice;
  // Of the corners, one is left for each class: 3 of 4 go if there are two pairs.
  const std::int64_t within = twice - static_cast<std::int64_t>(pairs.size());
  const std::int64_t corners = pairs.size() == 2 ? 3 : 2;
  return static_cast<std::int64_t>(mesh.vertices.size()) - within - corners - edges + triangles;
}

TEST(PeriodicSides, OfAUnitCellAreEqualToTheBit) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    MeshRequest request{.pslg = unit_cell(), .size = 0.01};
    // Squares that are turned, some of which cross the sides.
    for (int i = 0; i < 12; ++i) {
      const Point middle{1.2 * random.unit() - 0.1, 1.2 * random.unit() - 0.1};
      const double radius = 0.01 + 0.1 * random.unit(), turn = random.unit();
      for (const int dx : {-1, 0, 1}) {
        for (const int dy : {-1, 0, 1}) {
          const Point at{middle.x + dx, middle.y + dy};
          if (std::max({-at.x, -at.y, at.x - 1, at.y - 1}) > 0.1) continue;
          std::vector<Point> corners;
          for (int k = 0; k < 4; ++k)
            corners.push_back({at.x + radius * std::cos(turn + k * kPi / 2),
                               at.y + radius * std::sin(turn + k * kPi / 2)});
          for (int k = 0; k < 4; ++k) {
            // Only what is within the cell.
            const auto& p = corners[static_cast<std::size_t>(k)];
            const auto& q = corners[static_cast<std::size_t>((k + 1) % 4)];
            const auto inside = [](Point c) { return c.x > 0 && c.x < 1 && c.y > 0 && c.y < 1; };
            if (inside(p) && inside(q)) add_segment(request.pslg, p, q, 0);
          }
        }
      }
    }
    request.periodic = {kLeftRight, kBottomTop};
    const Sound made = sound(request);
    // The coordinate along a side; the other one is the same for all.
    const auto along = [&](std::int32_t marker, bool upright, double other) {
      std::set<double> result;
      for (const auto& [x, y] : vertices_on(marker, made.mesh)) {
        result.insert(upright ? y : x);
        EXPECT_EQ(upright ? x : y, other);
      }
      return result;
    };
    const auto left = along(4, true, 0);
    EXPECT_EQ(left, along(2, true, 1));
    EXPECT_EQ(along(1, false, 0), along(3, false, 1));
    EXPECT_GT(left.size(), 5u);
  }
}

TEST(PeriodicSides, MakeATorus) {
  MeshRequest request{.pslg = unit_cell(), .size = 1e-3};
  request.periodic = {kLeftRight, kBottomTop};
  EXPECT_EQ(euler_number(sound(request).mesh, request.periodic), 0);
  request.periodic = {kBottomTop};
  EXPECT_EQ(euler_number(sound(request).mesh, request.periodic), 0);  // a tube
}

// What crosses one side is a vertex of the other, too.
TEST(PeriodicSides, HaveTheCrossingsOfBoth) {
  MeshRequest request{.pslg = unit_cell()};
  add_segment(request.pslg, {-0.5, 0.3}, {0.4, 0.35}, 9);
  add_segment(request.pslg, {0.7, 0.5}, {1.25, 0.61}, 9);
  request.pslg.points.push_back({1, 0.9});
  request.periodic = {kLeftRight};
  const Sound made = sound(request);
  const auto left = vertices_on(4, made.mesh);
  EXPECT_TRUE(left.contains({0, 0.9}));
  EXPECT_GE(left.size(), 5u);
}

TEST(PeriodicSides, AreAsFineAsTheFinerOne) {
  MeshRequest request{.pslg = unit_cell(), .size = "max(1e-6, 0.01 * x)"};
  request.periodic = {kLeftRight};
  const Sound made = sound(request);
  EXPECT_GT(vertices_on(4, made.mesh).size(), 200u);
  EXPECT_EQ(vertices_on(4, made.mesh).size(), vertices_on(2, made.mesh).size());
  request.size = 0.01;
  request.size.at = {{4, 1e-3}};
  EXPECT_GE(vertices_on(2, sound(request).mesh).size(), 1001u);
}

TEST(PeriodicSides, OfSectorsAreTurned) {
  for (const double degrees : {10.0, 30.0, 45.0, 120.0, 180.0, 300.0}) {
    for (const double size : {1.0, 1e-2, 1e-4}) {
      for (const double angle : {0.0, 20.0, 30.0, 33.0}) {
        SCOPED_TRACE(std::to_string(degrees) + " degrees, size " + std::to_string(size) +
                     ", angles " + std::to_string(angle));
        const double turn = degrees * kPi / 180;
        std::vector<Point> corners{{0, 0}};
        constexpr int kPieces = 24;
        for (int i = 0; i <= kPieces; ++i)
          corners.push_back({std::cos(turn * i / kPieces), std::sin(turn * i / kPieces)});
        MeshRequest request{.pslg = cell(corners), .size = size, .min_angle_deg = angle};
        request.periodic = {{1, kPieces + 2}};
        if (degrees == 180) request.pslg.segments[0].marker = 1;
        const Sound made = sound(request);
        EXPECT_EQ(vertices_on(1, made.mesh).size(), vertices_on(kPieces + 2, made.mesh).size());
      }
    }
  }
}

TEST(PeriodicSides, OfHexagonsAndShearedCellsMatch) {
  const auto ring = [](int n, double radius, double turn) {
    std::vector<Point> corners;
    for (int i = 0; i < n; ++i)
      corners.push_back({3 + radius * std::cos(turn + 2 * kPi * i / n),
                         7 + radius * std::sin(turn + 2 * kPi * i / n)});
    return corners;
  };
  for (const double turn : {0.0, 0.1, 0.5}) {
    MeshRequest request{.pslg = cell(ring(6, 1, turn)), .size = 1e-3};
    request.periodic = {{1, 4}, {2, 5}, {3, 6}};
    sound(request);
  }
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double shear = 8 * random.unit() - 4;
    const double height = 0.2 + random.unit();
    MeshRequest request{.pslg = cell({{0, 0}, {1, 0}, {1 + shear, height}, {shear, height}})};
    if (seed % 2 == 0) request.size = 1e-3 + 0.1 * random.unit();
    constexpr double kAngles[] = {0, 20, 30, 33};
    request.min_angle_deg = kAngles[random.below(4)];
    request.periodic = {kLeftRight, kBottomTop};
    sound(request);
  }
}

// A wave, cut by a hole.
TEST(PeriodicSides, MayBeBentAndHaveGaps) {
  Pslg pslg;
  std::vector<Point> corners;
  constexpr int kPieces = 20;
  const auto wave = [](int i) { return 0.1 * std::sin(2 * kPi * i / kPieces); };
  for (int i = 0; i <= kPieces; ++i) corners.push_back({wave(i), static_cast<double>(i) / kPieces});
  for (int i = kPieces; i >= 0; --i)
    corners.push_back({2 + wave(i), static_cast<double>(i) / kPieces});
  add_ring(pslg, corners);
  for (int i = 0; i < kPieces; ++i) {
    pslg.segments[static_cast<std::size_t>(i)].marker = 4;
    pslg.segments[static_cast<std::size_t>(kPieces + 1 + i)].marker = 2;
  }
  for (const double x : {0.0, 2.0}) {
    add_ring(pslg, {{x - 0.2, 0.3}, {x + 0.2, 0.3}, {x + 0.2, 0.4}, {x - 0.2, 0.4}});
    pslg.holes.push_back({x - 0.15, 0.35});
    pslg.holes.push_back({x + 0.15, 0.35});
  }
  MeshRequest request{.pslg = pslg, .size = 1e-3};
  request.periodic = {kLeftRight};
  const Sound made = sound(request);
  EXPECT_EQ(vertices_on(4, made.mesh).size(), vertices_on(2, made.mesh).size());
}

TEST(PeriodicSides, MeshesAreTheSameAtAnyNumberOfThreads) {
  MeshRequest request{.pslg = unit_cell(),
                      .size = "max(2e-6, 2e-4 * x)",
                      .leaf_triangles = kSanitized ? 500.0 : 4000.0};
  if (kSanitized) request.size = "max(1e-4, 2e-3 * x)";
  request.periodic = {kLeftRight, kBottomTop};
  CollectedMesh mesh;
  const auto alone = mesh_on(nullptr, request, mesh);
  ASSERT_TRUE(alone);
  EXPECT_EQ(verdict(request, mesh, *alone), "");
  EXPECT_GT(alone->leaves.size(), 1u);
  EXPECT_FALSE(alone->streamed);
  for (const std::uint32_t threads : {2u, 3u, 7u}) {
    Arena arena(threads);
    EXPECT_EQ(outcome(mesh_on(&arena, request)), outcome(alone));
  }
}

// Insides that touch both sides at will, at any angle: then what one side splits for, the other
// need not, and the other way round.
TEST(PeriodicSides, OfRandomDomainsEnd) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 30 : 1000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    MeshRequest request{.pslg = unit_cell()};
    const auto anywhere = [&] { return std::clamp(1.4 * random.unit() - 0.2, 0.0, 1.0); };
    for (std::uint32_t n = random.below(20); n > 0; --n) {
      const Point p{anywhere(), anywhere()}, q{anywhere(), anywhere()};
      if (p != q) add_segment(request.pslg, p, q, 0);
    }
    if (seed % 2 == 0) request.size = 0.001 + 0.1 * random.unit();
    constexpr double kAngles[] = {0, 20, 30, 33};
    request.min_angle_deg = kAngles[random.below(4)];
    request.sweeps = static_cast<std::uint32_t>(seed % 3);
    request.periodic = {kLeftRight, kBottomTop};
    const Sound made = sound(request);
    EXPECT_LT(made.summary.triangles, 20'000u);
    if (request.min_angle_deg <= 20) EXPECT_EQ(made.summary.unrefined.kept, 0u);
  }
}

TEST(PeriodicSides, ThatDoNotRepeatEachOtherAreNamed) {
  const auto refusal = [](Pslg pslg, std::vector<PeriodicPair> pairs, double keep = 0) {
    MeshRequest request{.pslg = std::move(pslg), .size = 0.1};
    request.periodic = std::move(pairs);
    if (keep > 0) request.keep.emplace();
    const auto made = mesh_on(nullptr, request);
    return made ? "" : made.error().message;
  };
  EXPECT_EQ(refusal(cell({{0, 0}, {1, 0}, {1, 1 + 1e-6}, {0, 1}}), {kLeftRight}),
            "quality.periodic[0]: the sides with markers 4 and 2 are 1 and 1.000001 long; only "
            "sides that are alike repeat");
  EXPECT_EQ(refusal(unit_cell(), {kLeftRight, {1, 7}}),
            "quality.periodic[1]: no segment in the domain has the marker 7");
  EXPECT_EQ(refusal(unit_cell(), {kLeftRight, {4, 1}}),
            "quality.periodic[1]: the marker 4 names two sides");
  Pslg inner = unit_cell();
  add_segment(inner, {0.2, 0.2}, {0.2, 0.8}, 9);
  EXPECT_EQ(refusal(inner, {{4, 9}}),
            "quality.periodic[0]: segments with marker 9 are not on the boundary of the domain");
  Pslg round = unit_cell();
  round.arcs.push_back({1, 0.5});
  EXPECT_EQ(refusal(round, {kLeftRight}),
            "quality.periodic[0]: segments with marker 2 are arcs, and sides are straight");
  // The right side is cut where the left one is not.
  Pslg cut = unit_cell();
  add_ring(cut, {{0.9, 0.4}, {1.1, 0.4}, {1.1, 0.6}, {0.9, 0.6}});
  cut.holes.push_back({0.95, 0.5});
  cut.holes.push_back({1.05, 0.5});
  EXPECT_NE(refusal(cut, {kLeftRight}).find("are 1 and 0.8 long"), std::string::npos)
      << refusal(cut, {kLeftRight});
  Pslg shifted = cut;
  add_ring(shifted, {{-0.1, 0.1}, {0.1, 0.1}, {0.1, 0.3}, {-0.1, 0.3}});
  shifted.holes.push_back({-0.05, 0.2});
  shifted.holes.push_back({0.05, 0.2});
  EXPECT_EQ(refusal(shifted, {kLeftRight}),
            "quality.periodic[0]: the side at (0, 0.3) has no image at (1, 0.3)");
  EXPECT_EQ(refusal(unit_cell(), {kLeftRight}, 1),
            "quality.periodic[0] splits segments with marker 4, which quality.keep keeps as they "
            "are");
  EXPECT_EQ(refusal(unit_cell(), std::vector<PeriodicPair>(17, kLeftRight)),
            "quality.periodic has 17 pairs; it must have at most 16");
}

}  // namespace
}  // namespace weft
