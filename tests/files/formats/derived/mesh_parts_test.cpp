// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

// Edges between two triangles of different parts, found by their vertices.
std::size_t cut_of(const Mesh& mesh, const MeshParts& parts) {
  std::map<std::array<std::uint32_t, 2>, std::vector<std::int32_t>> at;
  for (std::size_t side = 0; side < mesh.triangles.size(); ++side) {
    const auto [a, b] =
        std::minmax(mesh.triangles[side], mesh.triangles[side - side % 3 + (side + 1) % 3]);
    at[{a, b}].push_back(parts.of[side / 3]);
  }
  return static_cast<std::size_t>(std::count_if(at.begin(), at.end(), [](const auto& edge) {
    return edge.second.size() == 2 && edge.second[0] != edge.second[1];
  }));
}

TEST(MeshParts, HaveAboutTheSameSizeAndFewEdgesBetweenThem) {
  const Mesh mesh = square_mesh(40);  // 3,200 triangles
  const auto parts = divide(mesh.view(), 4);
  ASSERT_TRUE(parts) << parts.error().message;
  std::vector<std::size_t> sizes(4);
  ASSERT_EQ(parts->of.size(), 3200u);
  for (const std::int32_t part : parts->of) ++sizes.at(static_cast<std::size_t>(part));
  EXPECT_EQ(parts->least, *std::min_element(sizes.begin(), sizes.end()));
  EXPECT_EQ(parts->most, *std::max_element(sizes.begin(), sizes.end()));
  EXPECT_GE(parts->least, 700u);
  EXPECT_LE(parts->most, 900u);
  EXPECT_EQ(parts->cut, cut_of(mesh, *parts));
  EXPECT_LE(parts->cut, 200u);  // a cross has 80 to 160
}

TEST(MeshParts, AreTheSameEveryTime) {
  const Mesh mesh = square_mesh(20);
  EXPECT_EQ(divide(mesh.view(), 7)->of, divide(mesh.view(), 7)->of);
}

TEST(MeshParts, AreOneIfOneIsWanted) {
  const Mesh mesh = square_mesh(2);
  const auto parts = divide(mesh.view(), 1);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->of, std::vector<std::int32_t>(8, 0));
  EXPECT_EQ(parts->cut, 0u);
}

TEST(MeshParts, AreNotMoreThanTriangles) {
  const Mesh mesh = square_mesh(1);
  EXPECT_TRUE(divide(mesh.view(), 2));
  const auto parts = divide(mesh.view(), 3);
  ASSERT_FALSE(parts);
  EXPECT_EQ(parts.error().exit, ExitCode::kUsage);
  EXPECT_EQ(parts.error().message, "--parts is 3, but the mesh has 2 triangles");
}

}  // namespace
}  // namespace weft::files
