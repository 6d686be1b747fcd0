// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/overlapping_mesh.h"

#include <gtest/gtest.h>

#include "files/formats/derived/mesh_domain.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

// Adds the mesh once more, `right` of where it is.
Mesh with_copy(Mesh mesh, double right) {
  const auto vertices = static_cast<std::uint32_t>(mesh.coordinates.size() / 2);
  const Mesh one = mesh;
  for (std::size_t i = 0; i < one.coordinates.size(); ++i)
    mesh.coordinates.push_back(one.coordinates[i] + (i % 2 == 0 ? right : 0));
  for (const std::uint32_t v : one.triangles) mesh.triangles.push_back(v + vertices);
  mesh.regions.insert(mesh.regions.end(), one.regions.begin(), one.regions.end());
  return mesh;
}

TEST(OverlappingMesh, IsTheUnionOfItsParts) {
  const Mesh mesh = with_copy(square_mesh(4), 2);  // squares of 4
  const auto domain = domain_of_overlapping("m.14", mesh.view());
  ASSERT_TRUE(domain);
  EXPECT_EQ(domain->fill, Domain::Fill::kUnion);
  EXPECT_EQ(
      sentences(domain->warnings),
      std::vector<std::string>{"m.14: 32 triangles overlap others, the first two are triangle "
                               "4 and triangle 32; what any of them covers is meshed"});
  // Each area is closed: an even number of its segments is at each of its points.
  for (std::uint32_t area = 1; area <= domain->areas.size(); ++area) {
    std::vector<int> ends(domain->points.size(), 0);
    for (const Domain::Segment& segment : domain->segments)
      if (segment.area == area) ++ends[segment.a], ++ends[segment.b];
    for (const int count : ends) EXPECT_EQ(count % 2, 0);
  }
  EXPECT_EQ(domain_of_mesh("m.14", mesh.view()).fill, Domain::Fill::kUnion);
}

TEST(OverlappingMesh, HasEachTriangleThatIsFoldedOverItsNeighbourAsAnArea) {
  Mesh mesh = square_mesh(1);
  mesh.coordinates.insert(mesh.coordinates.end(), {0.9, 0.5});
  // Over the first triangle, with a side of the second.
  const std::uint32_t a = mesh.triangles[0], b = mesh.triangles[1];
  mesh.triangles.insert(mesh.triangles.end(), {a, b, 4});
  mesh.regions.push_back(0);
  const auto domain = domain_of_overlapping("m.14", mesh.view());
  ASSERT_TRUE(domain);
  EXPECT_GE(domain->areas.size(), 2u);
}

TEST(OverlappingMesh, IsNoneIfTrianglesTouch) {
  EXPECT_FALSE(domain_of_overlapping("m.14", square_mesh(5).view()));
  EXPECT_FALSE(domain_of_overlapping("m.14", with_copy(square_mesh(4), 4).view()));
  EXPECT_FALSE(domain_of_overlapping("m.14", Mesh{}.view()));
}

}  // namespace
}  // namespace weft::files
