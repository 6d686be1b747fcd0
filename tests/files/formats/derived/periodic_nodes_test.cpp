// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/periodic_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "files/formats/derived/second_order.h"

namespace weft::files {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using Sides = std::vector<std::array<std::int32_t, 2>>;
using Pair = std::array<std::uint32_t, 2>;

// A strip of two rows of squares: below are vertices 0 to 2, in the middle 3 to 5, above 6 to 8.
// The left side has the marker 4, the right one 2.
Mesh strip() {
  Mesh mesh;
  for (const double y : {0.0, 1.0, 2.0})
    for (const double x : {0.0, 1.0, 2.0}) mesh.coordinates.insert(mesh.coordinates.end(), {x, y});
  for (const std::uint32_t v : {0u, 1u, 3u, 4u}) {
    mesh.triangles.insert(mesh.triangles.end(), {v, v + 1, v + 4, v, v + 4, v + 3});
    mesh.regions.insert(mesh.regions.end(), {0, 0});
  }
  mesh.edges = {0, 3, 6, 3, 2, 5, 5, 8};
  mesh.edge_markers = {4, 4, 2, 2};
  return mesh;
}

TEST(PeriodicNodes, OfATranslationArePairedInTheOrderOfTheFirst) {
  const Mesh mesh = strip();
  const auto found = periodic_nodes(mesh.view(), Sides{{4, 2}});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].markers, (std::array{4, 2}));
  EXPECT_THAT(found[0].pairs, ElementsAre(Pair{0, 2}, Pair{3, 5}, Pair{6, 8}));
  EXPECT_EQ(found[0].cosine, 1);
  EXPECT_EQ(found[0].sine, 0);
  EXPECT_NEAR(found[0].dx, 2, 1e-15);
  EXPECT_NEAR(found[0].dy, 0, 1e-15);
}

TEST(PeriodicNodes, OfASectorAreThoseOfARotation) {
  Mesh mesh = strip();  // of radii 1 to 3, from 0 to 60 degrees, whose ends lie along a radius
  for (std::size_t v = 0; v < mesh.coordinates.size(); v += 2) {
    const double angle = -mesh.coordinates[v] * std::numbers::pi / 6,
                 radius = 1 + mesh.coordinates[v + 1];
    mesh.coordinates[v] = radius * std::cos(angle);
    mesh.coordinates[v + 1] = radius * std::sin(angle);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  const auto found = periodic_nodes(mesh.view(), Sides{{2, 4}});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].pairs, ElementsAre(Pair{2, 0}, Pair{5, 3}, Pair{8, 6}));
  EXPECT_NEAR(found[0].cosine, 0.5, 1e-12);
  EXPECT_NEAR(found[0].sine, std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(std::hypot(found[0].dx, found[0].dy), 0, 1e-12);
}

TEST(PeriodicNodes, HaveTheMiddlesOfEdgesOfSecondOrder) {
  const Mesh mesh = strip();
  const SecondOrderMesh second(mesh.view());
  const auto found = periodic_nodes(second.view(), Sides{{4, 2}});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].pairs, SizeIs(5));
  for (const auto& [a, b] : found[0].pairs) {
    EXPECT_EQ(second.view().coordinates[2 * b], 2);
    EXPECT_EQ(second.view().coordinates[2 * a + 1], second.view().coordinates[2 * b + 1]);
  }
}

TEST(PeriodicNodes, AreNoneOfSidesThatDoNotMatch) {
  Mesh mesh = strip();
  mesh.coordinates[2 * 3 + 1] = 1.25;  // of the left side alone
  EXPECT_THAT(periodic_nodes(mesh.view(), Sides{{4, 2}}), IsEmpty());
  EXPECT_THAT(periodic_nodes(strip().view(), Sides{{4, 7}, {7, 8}}), IsEmpty());
  mesh = strip();
  mesh.edge_markers.back() = 3;  // half of the right side
  EXPECT_THAT(periodic_nodes(mesh.view(), Sides{{4, 2}}), IsEmpty());
}

}  // namespace
}  // namespace weft::files
