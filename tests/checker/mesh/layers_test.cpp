// SPDX-License-Identifier: Apache-2.0
// Layers along a wall.
#include "checker/mesh/layers.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

constexpr std::uint32_t kColumns = 3;
constexpr int kLayers = 9;

// The rectangle from (0, 0) to (2, 1.1), with columns at x = 0, 1, 2, and rows that end at y = 0.1
// and 0.3, in the region 9, along the wall below, whose marker is 1.
Problem plate_with_layers() {
  Problem plate;
  plate.domain.points = {{0, 0}, {2, 0}, {2, 1.1}, {0, 1.1}};
  plate.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  plate.domain.markers = {1, 2, 3, 4};
  Mesh& mesh = plate.mesh;
  for (const double y : {0.0, 0.1, 0.3, 1.1})
    for (const double x : {0.0, 1.0, 2.0}) mesh.vertices.push_back({x, y});
  for (std::uint32_t row = 0; row < 3; ++row) {
    for (std::uint32_t column = 0; column + 1 < kColumns; ++column) {
      const std::uint32_t v = kColumns * row + column;
      mesh.triangles.push_back({v, v + 1, v + 1 + kColumns});
      mesh.triangles.push_back({v, v + 1 + kColumns, v + kColumns});
      for (int i = 0; i < 2; ++i) mesh.regions.push_back(row < 2 ? kLayers : 0);
    }
    mesh.edges.push_back({kColumns * row + kColumns - 1, kColumns * (row + 2) - 1, 2});
    mesh.edges.push_back({kColumns * (row + 1), kColumns * row, 4});
  }
  for (std::uint32_t column = 0; column + 1 < kColumns; ++column) {
    mesh.edges.push_back({column, column + 1, 1});
    mesh.edges.push_back({3 * kColumns + column + 1, 3 * kColumns + column, 3});
  }
  plate.requirements.min_angle_deg = 20;
  plate.requirements.layers = {{1, 0.1, 2, 2, kLayers}};
  return plate;
}

std::string text(const Problem& problem, Rules rules) {
  const Report report = problem.check();
  EXPECT_EQ(violated(report), rules) << to_text(report);
  return to_text(report);
}

TEST(LayersRule, OfRowsAlongTheWallHolds) {
  const Problem plate = plate_with_layers();
  EXPECT_TRUE(plate.check().ok()) << to_text(plate.check());
}

TEST(LayersRule, ThinnerOnesAreAllowed) {
  Problem plate = plate_with_layers();
  plate.requirements.layers[0].first = 0.11;
  EXPECT_TRUE(plate.check().ok()) << to_text(plate.check());
}

TEST(LayersRule, ThickerOnesAreAViolation) {
  Problem plate = plate_with_layers();
  plate.requirements.layers[0].first = 0.09;
  EXPECT_NE(text(plate, {Rule::kLayers}).find("layers at (0, 0) are 0.3"), std::string::npos);
}

TEST(LayersRule, ARowOfAnotherHeightIsAViolation) {
  Problem plate = plate_with_layers();
  plate.mesh.vertices[kColumns + 1].y = 0.11;
  EXPECT_NE(text(plate, {Rule::kLayers}).find("of layers is in no column of their rows"),
            std::string::npos);
}

TEST(LayersRule, AWallWithoutThemIsAViolation) {
  Problem plate = plate_with_layers();
  for (std::size_t t = 0; t < 8; t += 4) plate.mesh.regions[t] = 0;
  EXPECT_NE(text(plate, {Rule::kLayers})
                .find("has an edge with marker 1, but is not of the region 9 of its layers"),
            std::string::npos);
}

}  // namespace
}  // namespace weft::check::testing
