// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/stitch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

Mesh moved(Mesh mesh, double x, double y) {
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    mesh.coordinates[i] += i % 2 == 0 ? x : y;
  return mesh;
}

Result<StitchedMesh> joined(const Mesh& first, const Mesh& second, double tolerance = 0) {
  return stitch(first, second, {.tolerance = tolerance, .names = {"a", "b"}});
}

std::string refusal(const Mesh& first, const Mesh& second, double tolerance = 0) {
  const auto made = joined(first, second, tolerance);
  return made ? "it was joined" : made.error().message;
}

TEST(Stitch, JoinsTwoSquaresAtTheirSide) {
  const Mesh square = square_mesh(4);
  const auto made = joined(square, moved(square, 4, 0));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->common_vertices, 5u);
  EXPECT_EQ(made->common_edges, 4u);
  const Mesh& mesh = made->mesh;
  EXPECT_EQ(mesh.coordinates.size() / 2, 25u + 20u);
  EXPECT_EQ(mesh.triangles.size() / 3, 64u);
  EXPECT_EQ(mesh.edges.size() / 2, 16u + 12u);
  EXPECT_TRUE(
      std::equal(square.coordinates.begin(), square.coordinates.end(), mesh.coordinates.begin()));
  EXPECT_TRUE(std::equal(square.triangles.begin(), square.triangles.end(), mesh.triangles.begin()));
  EXPECT_EQ(std::count(mesh.edge_markers.begin(), mesh.edge_markers.end(), 2), 8)
      << "the right sides of both";
  EXPECT_EQ(std::count(mesh.edge_markers.begin(), mesh.edge_markers.end(), 4), 4)
      << "the left side of the first";
}

TEST(Stitch, TakesVerticesWithinTheToleranceForOne) {
  const Mesh square = square_mesh(4);
  EXPECT_EQ(refusal(square, moved(square, 4 + 1e-3, 0), 1e-4),
            "a and b have no vertex of their outlines in common, within 1e-04");
  const auto made = joined(square, moved(square, 4 + 1e-3, 0), 1e-2);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->common_vertices, 5u);
  EXPECT_EQ(made->mesh.coordinates[2 * made->vertices[1]], 5.001) << "others stay where they are";
}

TEST(Stitch, NamesAVertexThatLiesOnAnEdge) {
  const Mesh first = square_mesh(4);
  const Mesh fine = [&] {
    Mesh mesh = square_mesh(8);
    for (double& x : mesh.coordinates) x /= 2;
    return moved(mesh, 4, 0);
  }();
  const std::string on_first = refusal(first, fine);
  EXPECT_TRUE(on_first.starts_with("b: vertex ")) << on_first;
  EXPECT_NE(on_first.find(" at (4, 0.5) lies on an edge of a, "), std::string::npos) << on_first;
  const std::string on_second = refusal(fine, first);
  EXPECT_NE(on_second.find("a: vertex "), std::string::npos) << on_second;
  EXPECT_NE(on_second.find(" lies on an edge of b, "), std::string::npos) << on_second;
}

TEST(Stitch, NamesTwoVerticesThatWouldBeOne) {
  const Mesh square = square_mesh(4);
  const std::string said = refusal(square, moved(square, 4, 0), 1.1);
  EXPECT_NE(said.find(" lies within 1.1 of two vertices of a, "), std::string::npos) << said;
}

TEST(Stitch, RefusesMeshesThatOverlap) {
  const Mesh square = square_mesh(4);
  EXPECT_EQ(refusal(square, moved(square, 3, 0)), "a and b overlap");
}

TEST(Stitch, GivesNumbersThatMeanOtherThingsNewOnes) {
  Mesh first = square_mesh(2), second = moved(square_mesh(2), 2, 0);
  first.names.markers = {{1, "floor"}, {3, "roof"}};
  second.names.markers = {{1, "wet"}, {2, "floor"}, {4, "sea"}};
  const auto made = joined(first, second);
  ASSERT_TRUE(made) << made.error().message;
  const Mesh& mesh = made->mesh;
  const auto count = [&](std::int32_t marker) {
    return std::count(mesh.edge_markers.begin(), mesh.edge_markers.end(), marker);
  };
  const NameTable& names = mesh.names.markers;
  ASSERT_TRUE(id_of(names, "wet"));
  EXPECT_EQ(id_of(names, "floor"), 1);
  EXPECT_EQ(id_of(names, "roof"), 3);
  EXPECT_EQ(count(*id_of(names, "wet")), 2) << "the lower side of the second";
  EXPECT_EQ(count(1), 4) << "the lower side of the first and the right side of the second";
  EXPECT_FALSE(names.contains(2));
}

}  // namespace
}  // namespace weft::files
