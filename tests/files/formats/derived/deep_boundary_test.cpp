// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/deep_boundary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

constexpr double kDeeper = 50;

// The square of 4 x 4 with a bed; vertices are numbered row by row, from the lowest.
struct Sea {
  Mesh mesh = square_mesh(4);
  std::vector<double> bed = std::vector<double>(25, 10);

  DeepBoundary open(const std::vector<std::int32_t>& markers = {}, const char* name = "depth") {
    MeshView view = mesh.view();
    const VertexValues values{name, bed};
    view.vertex_values = {&values, 1};
    return deep_boundary(view, kDeeper, markers);
  }
};

using Edges = std::set<std::vector<std::uint32_t>>;

// Those that were opened, the lower vertex first.
Edges opened(const DeepBoundary& deep) {
  Edges edges;
  for (std::size_t e = deep.markers.size() - deep.opened; e < deep.markers.size(); ++e) {
    EXPECT_EQ(deep.markers[e], deep.marker);
    edges.insert({std::min(deep.edges[2 * e], deep.edges[2 * e + 1]),
                  std::max(deep.edges[2 * e], deep.edges[2 * e + 1])});
  }
  EXPECT_EQ(edges.size(), deep.opened);
  return edges;
}

TEST(DeepBoundary, IsDeeperAtBothEndsOfItsEdges) {
  Sea sea;
  for (const std::size_t v : {8, 9, 14, 19}) sea.bed[v] = 50.5;  // 8 is inside
  sea.bed[4] = kDeeper;                                          // no deeper
  EXPECT_EQ(opened(sea.open()), (Edges{{9, 14}, {14, 19}}));
}

TEST(DeepBoundary, KeepsTheEdgesOfTheMeshBeforeItsOwn) {
  Sea sea;
  for (const std::size_t v : {9, 14, 19}) sea.bed[v] = 60;
  DeepBoundary deep = sea.open();
  ASSERT_EQ(deep.markers.size(), sea.mesh.edge_markers.size() + deep.opened);
  deep.markers.resize(sea.mesh.edge_markers.size());
  deep.edges.resize(sea.mesh.edges.size());
  EXPECT_EQ(deep.markers, sea.mesh.edge_markers);
  EXPECT_EQ(deep.edges, sea.mesh.edges);
}

TEST(DeepBoundary, IsPartedByTwoShallowVerticesButNotByOne) {
  Sea sea;
  for (const std::size_t v : {0, 1, 3, 4, 9}) sea.bed[v] = 60;
  EXPECT_EQ(opened(sea.open()), (Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 9}}));
  sea.bed[1] = 10;
  EXPECT_EQ(opened(sea.open()), (Edges{{3, 4}, {4, 9}}));
}

TEST(DeepBoundary, HasTwoEdgesAtLeast) {
  Sea sea;
  for (const std::size_t v : {2, 3}) sea.bed[v] = 60;
  EXPECT_EQ(sea.open().opened, 0);
}

TEST(DeepBoundary, IsNeverAnIsland) {
  Sea sea;
  sea.bed.assign(25, 60);
  auto& triangles = sea.mesh.triangles;  // without those of the vertex in the middle
  for (std::size_t t = triangles.size(); t > 0; t -= 3)
    if (std::count(&triangles[t - 3], &triangles[t - 3] + 3, 12u) > 0)
      triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(t) - 3,
                      triangles.begin() + static_cast<std::ptrdiff_t>(t));
  const Edges outside = opened(sea.open());
  EXPECT_EQ(outside.size(), 16);
  EXPECT_TRUE(outside.contains({0, 1}));
  EXPECT_FALSE(outside.contains({7, 8}));
}

TEST(DeepBoundary, LeavesOpenMarkersAsTheyAre) {
  Sea sea;
  sea.bed.assign(25, 60);
  const DeepBoundary deep = sea.open({2, 5});
  EXPECT_EQ(deep.marker, 6);  // 1 to 4 are those of the sides
  EXPECT_EQ(deep.opened, 12);
  EXPECT_FALSE(opened(deep).contains({4, 9}));
  EXPECT_TRUE(opened(deep).contains({3, 4}));
}

TEST(DeepBoundary, TurnsAnElevation) {
  Sea sea;
  sea.bed.assign(25, -60);
  EXPECT_EQ(sea.open({}, "depth").opened, 0);
  EXPECT_EQ(sea.open({}, "elevation").opened, 16);
}

// A mesh of another program has no edges where no marker is.
TEST(DeepBoundary, OpensSidesThatAreNoEdgesOfTheMesh) {
  Sea sea;
  sea.bed.assign(25, 60);
  sea.mesh.edges.clear();
  sea.mesh.edge_markers.clear();
  const DeepBoundary deep = sea.open();
  EXPECT_EQ(deep.marker, 1);
  EXPECT_EQ(opened(deep).size(), 16);
}

}  // namespace
}  // namespace weft::files
