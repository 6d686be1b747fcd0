// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/renumbered_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "files/formats/derived/mesh_edges.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

// The square with its vertices in any order.
Mesh shuffled_square(std::uint32_t n) {
  Mesh mesh = square_mesh(n);
  std::vector<std::uint32_t> numbers(mesh.coordinates.size() / 2);
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::shuffle(numbers.begin(), numbers.end(), std::mt19937(7));
  const std::vector<double> old = mesh.coordinates;
  for (std::size_t v = 0; v < numbers.size(); ++v)
    for (const std::size_t axis : {0, 1})
      mesh.coordinates[2 * std::size_t{numbers[v]} + axis] = old[2 * v + axis];
  for (auto* vertices : {&mesh.triangles, &mesh.edges})
    for (std::uint32_t& v : *vertices) v = numbers[v];
  return mesh;
}

std::uint32_t bandwidth_of(const MeshView& mesh) {
  const MeshEdges edges(mesh);
  std::uint32_t most = 0;
  for (std::size_t e = 0; e < edges.size(); ++e)
    most = std::max(most, edges.high(e) - edges.low(e));
  return most;
}

// Coordinates of the corners of each, in order.
std::vector<double> places(const MeshView& mesh, std::span<const std::uint32_t> vertices) {
  std::vector<double> out;
  for (const std::uint32_t v : vertices)
    for (const std::size_t axis : {0, 1})
      out.push_back(mesh.coordinates[2 * std::size_t{v} + axis]);
  return out;
}

TEST(RenumberedMesh, IsTheSameMesh) {
  const Mesh mesh = shuffled_square(20);
  const RenumberedMesh renumbered(mesh.view());
  const MeshView view = renumbered.view();
  EXPECT_EQ(view.coordinates.size(), mesh.coordinates.size());
  EXPECT_EQ(places(view, view.triangles), places(mesh.view(), mesh.triangles));
  EXPECT_EQ(places(view, view.edges), places(mesh.view(), mesh.edges));
  EXPECT_TRUE(std::equal(view.regions.begin(), view.regions.end(), mesh.regions.begin()));
  EXPECT_TRUE(
      std::equal(view.edge_markers.begin(), view.edge_markers.end(), mesh.edge_markers.begin()));
  std::set<std::uint32_t> used(view.triangles.begin(), view.triangles.end());
  EXPECT_EQ(used.size(), view.vertex_count());
}

// A square of n by n cells has no order with less than n + 1, and this one is at most twice that.
TEST(RenumberedMesh, HasABandwidthOfAboutTheWidthOfTheMesh) {
  const Mesh mesh = shuffled_square(30);
  const RenumberedMesh renumbered(mesh.view());
  EXPECT_EQ(renumbered.bandwidth_before(), bandwidth_of(mesh.view()));
  EXPECT_EQ(renumbered.bandwidth(), bandwidth_of(renumbered.view()));
  EXPECT_GT(renumbered.bandwidth_before(), 800u);
  EXPECT_LE(renumbered.bandwidth(), 62u);
}

TEST(RenumberedMesh, MovesTheInputPointsToo) {
  const Mesh mesh = shuffled_square(4);
  const std::uint32_t points[] = {3, 0, 11, 1};
  MeshView view = mesh.view();
  view.input_points = points;
  const RenumberedMesh renumbered(view);
  const MeshView after = renumbered.view();
  const std::uint32_t was[] = {points[0], points[2]};
  const std::uint32_t is[] = {after.input_points[0], after.input_points[2]};
  EXPECT_EQ(places(view, was), places(after, is));
  EXPECT_EQ(after.input_points[1], 0u);
  EXPECT_EQ(after.input_points[3], 1u);
}

TEST(RenumberedMesh, TakesSeveralComponentsLooseVerticesAndNothing) {
  const Mesh two{{0, 0, 1, 0, 0, 1, 9, 9, 5, 5, 6, 5, 5, 6}, {6, 4, 5, 0, 1, 2}, {0, 0}, {}, {}};
  const RenumberedMesh renumbered(two.view());
  const MeshView view = renumbered.view();
  EXPECT_EQ(view.vertex_count(), 7u);
  EXPECT_EQ(places(view, view.triangles), places(two.view(), two.triangles));
  EXPECT_EQ(renumbered.bandwidth(), 2u);
  EXPECT_EQ(RenumberedMesh(MeshView{}).bandwidth(), 0u);
}

}  // namespace
}  // namespace weft::files
