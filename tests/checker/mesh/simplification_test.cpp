// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/simplification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "checker/check.h"

namespace weft::check::testing {
namespace {

// The square [0, 10] x [0, 10] with a notch of `depth` in the middle of its lower side, marker 1
// below and 2 elsewhere.
Domain notched(double depth) {
  Domain domain;
  domain.points = {{0, 0}, {4, 0}, {5, depth}, {6, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (std::uint32_t i = 0; i < 7; ++i) {
    domain.segments.push_back({i, (i + 1) % 7});
    domain.markers.push_back(i < 4 ? 1 : 2);
  }
  return domain;
}

// The square without the notch, around its middle.
Mesh square_mesh() {
  Mesh mesh;
  mesh.vertices = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 5}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  mesh.edges = {{0, 1, 1}, {1, 2, 2}, {2, 3, 2}, {3, 0, 2}};
  return mesh;
}

// Edges of at most 20, features down to `share` of that.
Report judged(const Domain& domain, const Mesh& mesh, double share) {
  Requirements requirements;
  requirements.size = 20.0;
  requirements.size.measure = Measure::kEdge;
  requirements.simplify = share;
  return check(domain, mesh, requirements);
}

void expect_broken(const Report& report, const char* sentence) {
  EXPECT_EQ(report.total(Rule::kSimplified), report.violations.size()) << to_text(report);
  ASSERT_GT(report.total(Rule::kSimplified), 0u) << to_text(report);
  EXPECT_NE(report.violations[0].sentence.find(sentence), std::string::npos) << to_text(report);
}

TEST(Simplification, WithinWhatIsAskedHolds) {
  const Report report = judged(notched(0.5), square_mesh(), 0.1);
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_NEAR(*report.facts.area_change, 0.5, 1e-12);
}

TEST(Simplification, IsNoExcuseWithoutBeingAsked) {
  EXPECT_FALSE(check(notched(0.5), square_mesh()).ok());
}

TEST(Simplification, FartherThanAskedIsFound) {
  Mesh mesh = square_mesh();
  mesh.vertices[1].y = 0;
  Domain domain = notched(0.5);
  for (Vec2& p : domain.points)
    if (p.y < 1) p.y -= 3;  // the mesh's lower side is 3 above it
  expect_broken(judged(domain, mesh, 0.1), "the edge with marker 1");
}

TEST(Simplification, AnotherMarkerIsFound) {
  Mesh mesh = square_mesh();
  mesh.edges[2].marker = 1;
  expect_broken(judged(notched(0.5), mesh, 0.1), "the edge with marker 1 from (10, 10) to (0, 10)");
}

TEST(Simplification, ALargeIslandThatIsGoneIsFound) {
  Domain domain = notched(0.5);
  for (const Vec2 p : {Vec2{2, 3}, {8, 3}, {8, 9}, {2, 9}}) domain.points.push_back(p);
  for (std::uint32_t i = 0; i < 4; ++i) {
    domain.segments.push_back({7 + i, 7 + (i + 1) % 4});
    domain.markers.push_back(3);
  }
  domain.holes = {{5, 6.5}};
  expect_broken(judged(domain, square_mesh(), 0.1), "was not meshed and is in region 0");
  EXPECT_TRUE(judged(domain, square_mesh(), 0.2).ok());
}

TEST(Simplification, ALargePartThatIsGoneIsFound) {
  Domain domain = notched(0.5);
  for (const Vec2 p : {Vec2{20, 0}, {30, 0}, {30, 10}, {20, 10}}) domain.points.push_back(p);
  for (std::uint32_t i = 0; i < 4; ++i) {
    domain.segments.push_back({7 + i, 7 + (i + 1) % 4});
    domain.markers.push_back(3);
  }
  expect_broken(judged(domain, square_mesh(), 0.1), "was in region 0 and is not meshed");
}

// The square [0, 10] x [0, 10], a channel of 0.2 by 2, and a water of `width` by 10.
Domain two_waters(double width) {
  Domain domain;
  domain.points = {{0, 0},           {10, 0},  {10, 4.9}, {12, 4.9}, {12, 0},  {12 + width, 0},
                   {12 + width, 10}, {12, 10}, {12, 5.1}, {10, 5.1}, {10, 10}, {0, 10}};
  for (std::uint32_t i = 0; i < 12; ++i) domain.segments.push_back({i, (i + 1) % 12});
  return domain;
}

// Squares of 10 around their middles, from their lower left corners; corners that coincide are one.
Mesh squares_mesh(const std::vector<Vec2>& corners) {
  Mesh mesh;
  const auto vertex = [&](Vec2 p) {
    const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), p);
    const auto index = static_cast<std::uint32_t>(found - mesh.vertices.begin());
    if (found == mesh.vertices.end()) mesh.vertices.push_back(p);
    return index;
  };
  for (const auto& [x, y] : corners) {
    const std::uint32_t a = vertex({x, y}), b = vertex({x + 10, y}), c = vertex({x + 10, y + 10}),
                        d = vertex({x, y + 10}), middle = vertex({x + 5, y + 5});
    for (const auto& [p, q] :
         {std::array{a, b}, std::array{b, c}, std::array{c, d}, std::array{d, a}}) {
      mesh.triangles.push_back({p, q, middle});
      mesh.edges.push_back({p, q, 0});
    }
  }
  return mesh;
}

TEST(Simplification, ASmallWaterBehindAClosedChannelMayGo) {
  const Report report = judged(two_waters(10), squares_mesh({{0, 0}}), 0.1);
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Simplification, ALargeWaterBehindAClosedChannelThatIsGoneIsFound) {
  expect_broken(judged(two_waters(60), squares_mesh({{0, 0}}), 0.1),
                "was in region 0 and is not meshed");
}

TEST(Simplification, PartsThatWereConnectedAreFound) {
  const Report report = judged(two_waters(10), squares_mesh({{0, 0}, {12, 0}}), 0.1);
  expect_broken(report, "are not connected, though the domain is there");
  EXPECT_EQ(report.total(Rule::kSimplified), 1u);
}

TEST(Simplification, PartsThatWereConnectedAcrossALineAreFound) {
  Domain domain = two_waters(10);
  domain.points.push_back({11, 4.9});
  domain.points.push_back({11, 5.1});
  domain.segments.push_back({12, 13});
  const std::string report = to_text(judged(domain, squares_mesh({{0, 0}, {12, 0}}), 0.1));
  EXPECT_NE(report.find("are not connected, though the domain is there"), std::string::npos)
      << report;
}

TEST(Simplification, PartsThatWereApartHold) {
  Domain domain = two_waters(10);
  domain.points[2].x = domain.points[9].x = 9;  // the channel begins inside the square, as a notch
  domain.segments[2] = {2, 9};
  domain.segments[8] = {3, 8};
  EXPECT_TRUE(judged(domain, squares_mesh({{0, 0}, {12, 0}}), 0.1).ok());
}

TEST(Simplification, APinchIsFoundUnlessTheDomainHasIt) {
  Domain domain;
  domain.points = {{0, 0},   {10, 0},  {10, 9.5},  {10.5, 10}, {20, 10},
                   {20, 20}, {10, 20}, {10, 10.5}, {9.5, 10},  {0, 10}};
  for (std::uint32_t i = 0; i < 10; ++i) domain.segments.push_back({i, (i + 1) % 10});
  const Mesh mesh = squares_mesh({{0, 0}, {10, 10}});
  const Report report = judged(domain, mesh, 0.1);
  expect_broken(report, "are not connected");
  ASSERT_EQ(report.violations.size(), 2u);
  EXPECT_NE(report.violations[1].sentence.find("at (10, 10) 2 times"), std::string::npos)
      << to_text(report);
  domain = {};
  domain.points = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {20, 10}, {20, 20}, {10, 20}};
  domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 4}, {4, 5}, {5, 6}, {6, 2}};
  EXPECT_TRUE(judged(domain, mesh, 0.1).ok()) << to_text(judged(domain, mesh, 0.1));
}

TEST(Simplification, AnotherRegionIsFound) {
  Mesh mesh = square_mesh();
  mesh.regions = {4, 4, 4, 4};
  expect_broken(judged(notched(0.5), mesh, 0.1), "was in region 0 and is in region 4");
}

TEST(Simplification, AnEndOfAMarkerThatIsGoneIsFound) {
  Domain domain = notched(0.5);
  domain.markers[1] = 7;
  expect_broken(judged(domain, square_mesh(), 0.1), "where segments meet, or a marker ends");
}

TEST(Simplification, APointThatNoSegmentNamesAndThatIsGoneIsFound) {
  Domain domain = notched(0.5);
  domain.points.push_back({2, 5});
  expect_broken(judged(domain, square_mesh(), 0.1), "which no segment names");
  domain.points.back() = {5, 5};
  EXPECT_TRUE(judged(domain, square_mesh(), 0.1).ok());
}

TEST(Simplification, OfAMeshThatIsNotSoundIsNotJudged) {
  Mesh mesh = square_mesh();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const Report report = judged(notched(0.5), mesh, 0.1);
  EXPECT_GT(report.total(Rule::kOrientation), 0u);
  EXPECT_EQ(report.not_judged.back(), Rule::kSimplified);
}

TEST(Simplification, StillJudgesTheMeshByItself) {
  Mesh mesh = square_mesh();
  mesh.edges.pop_back();  // a boundary edge that is not listed
  EXPECT_GT(judged(notched(0.5), mesh, 0.1).total(Rule::kEdges), 0u);
  Requirements requirements;
  requirements.simplify = 0.1;
  requirements.size = 5.0;
  EXPECT_GT(check(notched(0.5), square_mesh(), requirements).total(Rule::kArea), 0u);
}

}  // namespace
}  // namespace weft::check::testing
