// SPDX-License-Identifier: Apache-2.0
// Meshes of domains whose segments are arcs. Every mesh is judged by the independent checker.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "engine/engine.h"
#include "tests/engine/domain/arcs/arc_shapes.h"
#include "tests/engine/parallel/parallel.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

Pslg two_circles(double radius, Point centre, double from = 0) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  add_circle(pslg, centre, radius, 4, from);
  return pslg;
}

double area_of(const CollectedMesh& collected) {
  double area = 0;
  for (const auto& [a, b, c] : collected.mesh.triangles) {
    const auto &p = collected.mesh.vertices[a], &q = collected.mesh.vertices[b],
               &r = collected.mesh.vertices[c];
    area += 0.5 * ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
  }
  return area;
}

struct Case {
  std::string name;
  Pslg pslg;
  std::uint64_t edges, triangles;  // at most, at 20, 25 and 30 degrees
};

// Bounds are those of a sequential prototype, or what this engine makes.
std::vector<Case> cases() {
  std::vector<Case> all;
  Pslg circle;
  add_circle(circle, {0, 0}, 1);
  all.push_back({"circle", circle, 12, 12});
  Pslg ring = two_circles(1.001, {0, 0});
  ring.holes.push_back({0, 0});
  all.push_back({"thin ring", ring, 8192, 8192});
  all.push_back({"circle that touches from inside", two_circles(0.5, {0.5, 0}), 42, 66});
  all.push_back({"circle that nearly fills another", two_circles(0.999, {0.001, 0}), 5562, 14357});
  all.push_back({"circle that touches from outside", two_circles(1, {2, 0}, kPi), 42, 80});
  Pslg half_as_large = two_circles(0.5, {0.5, 0});  // parts of the one lie on chords of the other
  add_box(half_as_large, {-2, -2}, {2, 2});
  all.push_back({"circle of half the radius that touches", half_as_large, 90, 170});
  all.push_back({"circles that cross", two_circles(0.8, {1, 0.1}), 60, 90});
  Pslg half;
  half.points = {{-1, 0}, {1, 0}};
  add_arc(half, 1, 0, 1);
  half.segments.push_back({0, 1});
  all.push_back({"half disk", half, 8, 6});
  Pslg sector;
  sector.points = {{0, 0}, {1, 0}, {std::cos(0.05), std::sin(0.05)}};
  sector.segments = {{0, 1}, {2, 0}};
  add_arc(sector, 1, 2, std::tan(0.05 / 4));
  all.push_back({"sector", sector, 11, 9});
  Pslg lens;
  lens.points = {{-1, 0}, {1, 0}};
  add_arc(lens, 0, 1, std::tan(0.02 / 4));
  add_arc(lens, 1, 0, std::tan(0.02 / 4));
  all.push_back({"lens", lens, 40, 40});
  Pslg tangent;
  add_box(tangent, {-2, 0}, {2, 3});
  add_circle(tangent, {0, 1}, 1, 4, 0.3);
  tangent.holes.push_back({0, 1});
  all.push_back({"hole that touches the border", tangent, 42, 60});
  all.push_back({"plate", plate_with_holes(4), 260, 520});
  return all;
}

TEST(Arcs, NamedDomainsHaveFewTriangles) {
  for (const Case& c : cases()) {
    for (const double angle : {20.0, 25.0, 30.0}) {
      SCOPED_TRACE(c.name + " at " + std::to_string(angle));
      const Sound made = sound({.pslg = c.pslg, .min_angle_deg = angle});
      EXPECT_LE(made.summary.edges, c.edges);
      EXPECT_LE(made.summary.triangles, c.triangles);
      EXPECT_EQ(made.summary.unrefined.total(), made.summary.unrefined.small_input_angle);
    }
  }
}

TEST(Arcs, BoundariesFollowTheArcAsTheyGetFiner) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  add_circle(pslg, {0, 0}, 1, 2);
  pslg.holes.push_back({0, 0});
  for (const double edge : {0.2, 0.05, 0.0125}) {
    const Sound made = sound({.pslg = pslg, .size = 0.433 * edge * edge});
    EXPECT_NEAR(area_of(made.mesh), 16 - kPi, 0.35 * edge * edge) << edge;
  }
}

// Of the triangles with a parabola through the middle of each arc for a side.
TEST(Arcs, TheAreaOfSecondOrderIsThatOfTheCircleToTheFourthOrder) {
  for (const auto& [edges, most] :
       {std::pair{16, 4.94e-5}, std::pair{32, 3.1e-6}, std::pair{64, 1.94e-7}}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1, static_cast<std::uint32_t>(edges));
    const Sound made = sound({.pslg = pslg, .min_angle_deg = 0});
    const check::Mesh& mesh = made.mesh.mesh;
    ASSERT_EQ(mesh.edges.size(), static_cast<std::size_t>(edges));
    double area = area_of(made.mesh);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      const check::Vec2 p = mesh.vertices[mesh.edges[e].a], q = mesh.vertices[mesh.edges[e].b];
      const double side = p.x * q.y - p.y * q.x > 0 ? 1 : -1;  // the centre is left of the edge
      area += side * mesh.bulges[e] / 3 * ((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
    }
    EXPECT_NEAR(area, kPi, most * kPi) << edges;
  }
}

TEST(Arcs, RandomDomainsKeepTheirBounds) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 30 : 150); ++seed) {
    for (const double angle : {20.0, 30.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " at " + std::to_string(angle));
      sound({.pslg = random_arcs(seed), .min_angle_deg = angle});
    }
  }
}

TEST(Arcs, SizesAndSmoothingKeepToThem) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    MeshRequest request{.pslg = random_arcs(seed), .size = "0.01 + 0.01 * (x^2 + y^2)"};
    request.sweeps = seed % 3;
    sound(request);
  }
}

TEST(Arcs, ACircleHasAsManyVerticesAsAreAskedFor) {
  for (const double points : {6.0, 36.0, 100.5, 1000.0}) {
    MeshRequest request{.pslg = plate_with_holes(2)};
    request.size.points_per_circle = points;
    const Sound made = sound(request);
    EXPECT_GE(made.summary.edges, 4 * std::ceil(points) + 8) << points;
    EXPECT_LE(made.summary.edges, 4 * (points + 12) + 120) << points;
  }
}

TEST(Arcs, AMarkersLengthHoldsOnThem) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  add_circle(pslg, {0, 0}, 1, 3, 0.1, 7);
  MeshRequest request{.pslg = pslg};
  request.size.at = {{.marker = 7, .max_edge = 0.05}};
  const Sound made = sound(request);
  const auto on_circle = std::count_if(made.mesh.mesh.edges.begin(), made.mesh.mesh.edges.end(),
                                       [](const auto& edge) { return edge.marker == 7; });
  EXPECT_GE(on_circle, 126);
  EXPECT_LE(on_circle, 200);
}

TEST(Arcs, SizesByDistanceSeeTheArc) {
  Pslg pslg;
  add_box(pslg, {-4, -4}, {4, 4});
  add_circle(pslg, {0, 0}, 1, 2, 0, 7);
  MeshRequest request{.pslg = pslg, .size = "0.001 + 0.05 * d^2"};
  request.size.fields = {{.name = "d", .kind = DistanceSpec{.markers = {7}}}};
  const Sound made = sound(request);
  EXPECT_GT(made.summary.triangles, 3000U);
}

TEST(Arcs, RefinementEndsAtAContactHoweverSmallTheSize) {
  for (const auto& [radius, size] : {std::pair{1.0, "max(1e-18, 0.02*((x-1)^2+y^2))"},
                                     std::pair{1e-6, "max(1e-22, 0.02*((x-1e-6)^2+y^2))"}}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, radius, 2);
    add_circle(pslg, {radius - 0.6 * radius, 0}, 0.6 * radius, 2);
    sound({.pslg = pslg, .size = std::string(size), .allow_unrefined = true});
  }
}

TEST(Arcs, ThoseWhoseEndsRoundToOnePointAreThatPoint) {
  for (const double length : {0.0, 1e-15}) {
    for (const double bulge : {0.4, -1.0, 3.0, 1e3}) {
      SCOPED_TRACE(std::to_string(length) + ", " + std::to_string(bulge));
      Pslg pslg;
      add_box(pslg, {-2, -2}, {2, 2});
      pslg.points.push_back({0.5, 0.5});
      pslg.points.push_back({0.5 + length, 0.5});
      pslg.points.push_back({0, 1});
      add_arc(pslg, 4, 5, bulge);
      add_arc(pslg, 5, 6, 0.5);
      sound({.pslg = pslg});
    }
  }
}

TEST(Arcs, TheBudgetHoldsForThePolylinesOfSizes) {
  MeshRequest request{.pslg = plate_with_holes(20), .size = "1 + 0.1 * d"};
  request.size.fields = {{.name = "d", .kind = DistanceSpec{.markers = {0}}}};
  ForgetfulSink sink;
  ExecutionContext context({.max_bytes = 10'000'000});
  const auto made = generate_mesh(request, sink, context);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kBudgetExceeded);
}

// A circle of area `area` around `centre`, region 1, and a square of area pi around (0.5, 0.1),
// region 2, that overlap.
Pslg circle_and_square(Point centre, double area) {
  Pslg pslg;
  add_circle(pslg, centre, std::sqrt(area / kPi), 3, 0.2);
  const double half = std::sqrt(kPi) / 2;
  add_box(pslg, {0.5 - half, 0.1 - half}, {0.5 + half, 0.1 + half});
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) pslg.segments[s].area = s < 3 ? 0 : 1;
  pslg.areas = {{.region = 1}, {.region = 2}};
  pslg.fill = Fill::kUnion;
  return pslg;
}

double area_of_region(const Sound& made, std::int32_t region) {
  double area = 0;
  for (std::size_t t = 0; t < made.mesh.mesh.triangles.size(); ++t) {
    if (made.mesh.mesh.regions[t] != region) continue;
    CollectedMesh one;
    one.mesh.vertices = made.mesh.mesh.vertices;
    one.mesh.triangles = {made.mesh.mesh.triangles[t]};
    area += area_of(one);
  }
  return area;
}

TEST(Arcs, OfAreasThatOverlapTheSmallerHasTheRegionUpToItsArcs) {
  for (const double share : {0.98, 0.9999, 1.0001, 1.02}) {
    const Sound made = sound({.pslg = circle_and_square({0, 0}, share * kPi), .size = 0.01});
    // The whole of the smaller one.
    const double whole = share < 1 ? share * kPi : kPi;
    EXPECT_NEAR(area_of_region(made, share < 1 ? 1 : 2), whole, 0.02) << share;
  }
}

TEST(Arcs, OfCirclesOfOneSizeTheFirstHasTheRegion) {
  for (const double size : {1.0, 0.05, 0.01}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1, 2);
    add_circle(pslg, {1, 0}, 1, 2);
    for (std::size_t s = 0; s < 4; ++s) pslg.segments[s].area = s < 2 ? 0 : 1;
    pslg.areas = {{.region = 1}, {.region = 2}};
    pslg.fill = Fill::kUnion;
    const Sound made = sound({.pslg = pslg, .size = size});
    EXPECT_GT(area_of_region(made, 1), area_of_region(made, 2)) << size;
  }
}

TEST(Arcs, NestedArcsWithNothingBetweenThemAreRefused) {
  Pslg pslg = two_circles(0.7, {0.3, 0});
  add_box(pslg, {-2, -2}, {2, 2});
  pslg.holes.push_back({-0.9, 0});
  const auto made = mesh_on(nullptr, {.pslg = pslg});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kBadOption);
  EXPECT_NE(made.error().message.find("touch at (1, 0) and curve the same way"), std::string::npos)
      << made.error().message;
}

TEST(Arcs, ADomainWithThemIsNotSimplified) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  MeshRequest request{.pslg = pslg, .size = 0.01};
  request.simplify = 0.5;
  const auto made = mesh_on(nullptr, request);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().field, "simplify");
}

}  // namespace
}  // namespace weft
