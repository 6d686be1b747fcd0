// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_domain.h"

#include <gtest/gtest.h>

#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

TEST(MeshDomain, CountsATriangleOfTwoGroupsOnce) {
  const Mesh once = square_mesh(3);
  Mesh twice = once;
  for (std::size_t t = 0; t < once.triangles.size() / 3; ++t) {
    for (const std::size_t corner : {1, 2, 0})
      twice.triangles.push_back(once.triangles[3 * t + corner]);
    twice.regions.push_back(99);
  }
  const Domain expected = domain_of_mesh("m.msh", once.view());
  const Domain domain = domain_of_mesh("m.msh", twice.view());
  EXPECT_EQ(domain.points, expected.points);
  EXPECT_EQ(domain.segments, expected.segments);
  EXPECT_EQ(domain.regions, expected.regions);
  EXPECT_TRUE(expected.warnings.empty());
  EXPECT_EQ(sentences(domain.warnings),
            (std::vector<std::string>{"m.msh: 18 triangles that repeat others are left out, the "
                                      "first is triangle 18"}));
}

TEST(MeshDomain, TellsOfASingleTriangleThatIsThereTwice) {
  Mesh mesh = square_mesh(1);
  mesh.triangles.insert(mesh.triangles.end(),
                        {mesh.triangles[2], mesh.triangles[1], mesh.triangles[0]});
  mesh.regions.push_back(0);
  EXPECT_EQ(
      sentences(domain_of_mesh("m.msh", mesh.view()).warnings),
      (std::vector<std::string>{"m.msh: 1 triangle that repeats another is left out, triangle 2"}));
}

}  // namespace
}  // namespace weft::files
