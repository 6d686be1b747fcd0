// SPDX-License-Identifier: Apache-2.0
// Meshes with layers. Each is judged by the independent checker.
#include "engine/layers/layer_filler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "engine/base/arena.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

// The ring through these points; the segment from point i has the marker i + 1, or this one.
void add(Pslg& pslg, const std::vector<Point>& corners, std::int32_t marker = 0) {
  const auto first = static_cast<std::uint32_t>(pslg.points.size());
  const auto count = static_cast<std::uint32_t>(corners.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    pslg.points.push_back(corners[i]);
    pslg.segments.push_back({first + i, first + (i + 1) % count,
                             marker != 0 ? marker : static_cast<std::int32_t>(i + 1)});
  }
}
Pslg ring(const std::vector<Point>& corners) {
  Pslg pslg;
  add(pslg, corners);
  return pslg;
}
Pslg plate() {
  return ring({{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}});
}

// y of the vertices at this x, up to a height, from the lowest on.
std::vector<double> column_at(double x, double top, const check::Mesh& mesh) {
  std::vector<double> column;
  for (const check::Vec2 v : mesh.vertices)
    if (v.x == x && v.y <= top) column.push_back(v.y);
  std::sort(column.begin(), column.end());
  return column;
}

TEST(LayersOfAPlate, HaveTheHeightsThatAreAskedFor) {
  const MeshRequest request{.pslg = plate(), .size = 1e-3, .layers = {{1, 1e-5, 1.2, 20}}};
  const Sound made = sound(request);
  const double thickness = 1e-5 * (std::pow(1.2, 20) - 1) / 0.2;
  EXPECT_NEAR(thickness, 1.8669e-3, 1e-7);
  EXPECT_NEAR(thickness_of(request.layers[0]), thickness, 1e-16);
  ASSERT_TRUE(made.summary.layers);
  EXPECT_NEAR(made.summary.layers->least_thickness, thickness, 1e-16);
  EXPECT_EQ(made.summary.layers->cut, 0u);
  // The ends are on the sides.
  for (const double x : {0.0, 1.0}) {
    const std::vector<double> column = column_at(x, 1.0001 * thickness, made.mesh.mesh);
    ASSERT_EQ(column.size(), 21u);
    double height = 0;
    for (int i = 1; i <= 20; ++i) {
      height += 1e-5 * std::pow(1.2, i - 1);
      EXPECT_NEAR(column[i], height, 1e-12);
    }
  }
  EXPECT_GE(made.summary.min_angle_deg, 20);
  EXPECT_NEAR(made.summary.area, 0.5, 1e-12);
}

TEST(LayersOfAPlate, AreARegionOfTheirOwnOrTheOneThatIsAskedFor) {
  MeshRequest request{.pslg = plate(), .size = 0.01, .layers = {{1, 0.01, 1, 2}}};
  request.pslg.regions = {{{0.5, 0.4}, 7, {}}};
  const Sound made = sound(request);
  const auto count = [](const Sound& of, std::int32_t region) {
    return static_cast<std::uint64_t>(
        std::count(of.mesh.mesh.regions.begin(), of.mesh.mesh.regions.end(), region));
  };
  EXPECT_EQ(count(made, 8), made.summary.layers->triangles);
  EXPECT_EQ(count(made, 7), made.summary.triangles - made.summary.layers->triangles);
  request.layers[0].region = -3;
  EXPECT_EQ(count(sound(request), -3), made.summary.layers->triangles);
}

TEST(LayersOfAPlate, GoAroundCornersThatFaceTheMesh) {
  const MeshRequest request{
      .pslg = plate(),
      .size = 1e-3,
      .layers = {{1, 1e-3, 1.3, 6}, {2, 1e-3, 1.3, 6}, {3, 1e-3, 1.3, 6}, {4, 1e-3, 1.3, 6}}};
  const Sound made = sound(request);
  EXPECT_EQ(made.summary.layers->cut, 0u);
}

TEST(LayersInACorner, AreCutWhereTheyWouldPassIt) {
  for (const double degrees : {90.0, 45.0, 15.0}) {
    SCOPED_TRACE(degrees);
    const double a = degrees * kPi / 180;
    Pslg pslg = ring({{0, 0}, {1, 0}, {std::cos(a), std::sin(a)}});
    for (const double size : {1e-2, 1e-4}) {
      const Sound made =
          sound({.pslg = pslg, .size = size, .layers = {{1, 1e-3, 1.2, 10}, {3, 1e-3, 1.2, 10}}});
      EXPECT_GT(made.summary.layers->least_thickness, 0);
    }
  }
}

TEST(LayersAroundACorner, OpenAsAFan) {
  // An L whose inner corner has 270 degrees of mesh.
  const Pslg pslg = ring({{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {0, 1}});
  const MeshRequest request{
      .pslg = pslg, .size = 0.01, .layers = {{4, 0.01, 1.2, 5}, {5, 0.01, 1.2, 5}}};
  const Sound made = sound(request);
  EXPECT_EQ(made.summary.layers->cut, 0u);
  // 4 steps of 22.5 degrees.
  const double thickness = thickness_of(request.layers[0]);
  std::uint64_t around = 0;
  for (const check::Vec2 v : made.mesh.mesh.vertices)
    if (std::fabs(std::hypot(v.x - 1, v.y - 1) - thickness) < 1e-12) ++around;
  EXPECT_GE(around, 5u);
}

// NACA 0012 in a box, sharp or blunt at its end.
Pslg airfoil(bool is_sharp) {
  constexpr int kHalf = 60;
  const auto thickness = [&](double x) {
    return 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x -
                  (is_sharp ? 0.1036 : 0.1015) * x * x * x * x);
  };
  std::vector<Point> outline;
  for (int i = 0; i <= kHalf; ++i) {  // from the end over the top to the nose
    const double x = 0.5 * (1 + std::cos(kPi * i / kHalf));
    outline.push_back({x, i == 0 && is_sharp ? 0 : thickness(x)});
  }
  for (int i = kHalf - 1; i >= (is_sharp ? 1 : 0); --i)
    outline.push_back(
        {outline[static_cast<std::size_t>(i)].x, -outline[static_cast<std::size_t>(i)].y});
  Pslg pslg = ring({{-2, -2}, {4, -2}, {4, 2}, {-2, 2}});
  add(pslg, outline, 9);
  pslg.holes = {{0.3, 0}};
  return pslg;
}

TEST(LayersOfAnAirfoil, AreWholeAndFollowedByGoodTriangles) {
  for (const bool is_sharp : {true, false}) {
    SCOPED_TRACE(is_sharp ? "sharp" : "blunt");
    MeshRequest request{.pslg = airfoil(is_sharp),
                        .size = "0.0004 + 0.03 * hypot(x - 0.5, y)^2",
                        .layers = {{9, 1e-4, 1.2, 15}}};
    const Sound made = sound(request);
    EXPECT_GE(made.summary.min_angle_deg, 20);
    EXPECT_GT(made.summary.layers->triangles, 30u * 120);
  }
}

TEST(LayersInAChannel, TakeEightTenthsOfItAndSaySo) {
  const double thickness = thickness_of({1, 0.01, 1.2, 8});
  const double width = 1.5 * thickness;
  const MeshRequest request{.pslg = ring({{0, 0}, {2, 0}, {2, width}, {0, width}}),
                            .layers = {{1, 0.01, 1.2, 8}, {3, 0.01, 1.2, 8}}};
  const Sound made = sound(request);
  EXPECT_EQ(made.summary.layers->cut, 4u);
  EXPECT_LE(made.summary.layers->least_thickness, 0.4 * width);
  EXPECT_GE(made.summary.layers->least_thickness, 0.3 * width);
}

// In a sharp corner, spokes of a wall's ends lean over more than the wall is long.
TEST(LayersOfASharpCorner, DoNotTurnOver) {
  const Pslg blade = ring({{0.26, 0.52}, {-0.37, -0.26}, {-0.39, -0.73}});
  const Sound made =
      sound({.pslg = blade, .layers = {{1, 0.036, 1, 4}, {2, 0.036, 1, 4}, {3, 0.036, 1, 4}}});
  EXPECT_GT(made.summary.layers->triangles, 0u);
}

TEST(LayersOfNeighbours, ShareTheGapBetweenThem) {
  Pslg pslg = ring({{0, 0}, {10, 0}, {10, 5}, {0, 5}});
  add(pslg, {{2, 2}, {4, 2}, {4, 4}, {2, 4}}, 9);
  add(pslg, {{4.1, 2}, {6.1, 2}, {6.1, 4}, {4.1, 4}}, 9);
  pslg.holes = {{3, 3}, {5, 3}};
  const Sound made = sound({.pslg = pslg, .size = 0.1, .layers = {{9, 0.02, 1, 5}}});
  EXPECT_LE(made.summary.layers->least_thickness, 0.04);
  EXPECT_GT(made.summary.layers->cut, 0u);
}

TEST(LayersOfAPart, EndOnTheNextSideOrInAPoint) {
  // The wall's neighbours make 60, 130, 180 and 30 degrees with it.
  for (const auto& [left, right] : {std::pair{60.0, 130.0}, {180.0, 180.0}, {30.0, 90.0}}) {
    SCOPED_TRACE(std::to_string(left) + ", " + std::to_string(right));
    const double a = left * kPi / 180, b = right * kPi / 180;
    const Point from{2 * std::cos(a), 2 * std::sin(a)};
    const Point to{1 - 2 * std::cos(b), 2 * std::sin(b)};
    std::vector<Point> corners{{0, 0}, {0.25, 0}, {0.5, 0},    {1, 0},
                               to,     {to.x, 5}, {from.x, 5}, from};
    Pslg pslg = ring(corners);
    for (Segment& s : pslg.segments) s.marker = s.marker <= 3 ? 1 : 2;
    const Sound made = sound({.pslg = pslg, .size = 0.02, .layers = {{1, 0.001, 1.3, 8}}});
    EXPECT_GT(made.summary.layers->triangles, 0u);
  }
}

TEST(LayersOfASurfaceThatIsDirty, AreMadeOfWhatItIs) {
  // Sides that cross, overlap and are there twice.
  Pslg pslg = ring({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  pslg.segments.push_back({0, 1, 1});
  pslg.points.push_back({0.5, 0});
  pslg.points.push_back({1.5, 0});
  pslg.segments.push_back({4, 5, 1});
  for (const Fill fill : {Fill::kSeeds, Fill::kEvenOdd}) {
    MeshRequest request{.pslg = pslg, .size = 0.01, .layers = {{1, 0.002, 1.3, 5}}};
    request.pslg.fill = fill;
    if (fill == Fill::kEvenOdd) request.pslg.segments.resize(4);
    EXPECT_NEAR(sound(request).summary.area, 1, 1e-12);
  }
}

TEST(LayersAtASizeOfTheirWall, DivideItsEdges) {
  MeshRequest request{.pslg = plate(), .layers = {{1, 0.001, 1.2, 5}}};
  request.size.at = {{1, 0.01}};
  const Sound made = sound(request);
  EXPECT_GE(std::count_if(made.mesh.mesh.edges.begin(), made.mesh.mesh.edges.end(),
                          [](const auto& edge) { return edge.marker == 1; }),
            100);
}

TEST(LayersOnThreads, AreTheSame) {
  const MeshRequest request{.pslg = airfoil(true),
                            .size = "0.0001 + 0.003 * hypot(x - 0.5, y)^2",
                            .layers = {{9, 1e-4, 1.2, 15}},
                            .leaf_triangles = 2000};
  const std::string alone = outcome(mesh_on(nullptr, request));
  EXPECT_EQ(alone.substr(0, 5).find("error"), std::string::npos) << alone;
  for (const int threads : {2, 3}) {
    Arena arena(threads);
    EXPECT_EQ(outcome(mesh_on(&arena, request)), alone) << threads;
  }
}

}  // namespace
}  // namespace weft
