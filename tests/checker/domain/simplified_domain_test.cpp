// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/simplified_domain.h"

#include <gtest/gtest.h>

#include "checker/report.h"

namespace weft::check::testing {
namespace {

SimplifiedDomain read(const Domain& original, const Mesh& mesh) {
  Findings findings(10);
  HalfEdges half_edges(mesh);
  EXPECT_TRUE(half_edges.judge_conformity(findings));
  return simplified_domain(original, mesh, half_edges);
}

// Two squares side by side, with a vertex in the middle of the lower side of each.
Mesh two_squares() {
  Mesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 2}, {2, 2}, {0, 2}};
  mesh.triangles = {{0, 1, 7}, {1, 2, 6}, {1, 6, 7}, {2, 3, 6}, {3, 4, 5}, {3, 5, 6}};
  mesh.regions = {1, 1, 1, 2, 2, 2};
  mesh.edges = {{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 5, 5},
                {5, 6, 5}, {6, 7, 5}, {7, 0, 5}, {2, 6, 9}};
  return mesh;
}

TEST(SimplifiedDomain, JoinsEdgesThatRunStraightOn) {
  const SimplifiedDomain simple = read({}, two_squares());
  EXPECT_EQ(simple.domain.points.size(), 6u);    // without (1, 0) and (3, 0)
  EXPECT_EQ(simple.domain.segments.size(), 7u);  // (2, 0) and (2, 2) are junctions
  EXPECT_EQ(simple.mesh.input_points.size(), 6u);
  EXPECT_EQ(simple.domain.regions.size(), 2u);
  int borders = 0;
  for (std::size_t s = 0; s < 7; ++s) {
    borders += simple.domain.segment_areas[s] == 1 ? 1 : 0;
    EXPECT_EQ(simple.domain.segment_areas[s], simple.domain.markers[s] == 5 ? 1u : 0u);
  }
  EXPECT_EQ(borders, 6);
}

TEST(SimplifiedDomain, KeepsPointsOfTheOriginalAndEndsOfMarkers) {
  Domain original;
  original.points = {{1, 0}};
  Mesh mesh = two_squares();
  mesh.edges[3].marker = 6;  // from (3, 0) on
  EXPECT_EQ(read(original, mesh).domain.points.size(), 8u);
}

TEST(SimplifiedDomain, HasTheLargestBoundOfARegion) {
  Domain original;
  original.regions = {{{1, 1}, 1, 3.0}, {{1, 1}, 1, 4.0}, {{3, 1}, 2, {}}};
  const SimplifiedDomain simple = read(original, two_squares());
  EXPECT_EQ(simple.domain.regions[0].max_area, 4.0);
  EXPECT_EQ(simple.domain.regions[1].max_area, std::nullopt);
}

}  // namespace
}  // namespace weft::check::testing
