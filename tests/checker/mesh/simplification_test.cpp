// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/simplification.h"

#include <gtest/gtest.h>

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
