// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/second_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft::files {
namespace {

// A regular polygon around (3, -2), whose sides are chords of its circle, in triangles from the
// centre. Every other side runs clockwise.
Mesh fan(std::uint32_t sides) {
  constexpr double kPi = std::numbers::pi;
  Mesh mesh;
  mesh.coordinates = {3, -2};
  for (std::uint32_t i = 0; i < sides; ++i) {
    mesh.coordinates.push_back(3 + std::cos(2 * kPi * i / sides));
    mesh.coordinates.push_back(-2 + std::sin(2 * kPi * i / sides));
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % sides;
    mesh.triangles.insert(mesh.triangles.end(), {0, a, b});
    mesh.edges.insert(mesh.edges.end(), {i % 2 == 0 ? a : b, i % 2 == 0 ? b : a});
    mesh.edge_bulges.push_back((i % 2 == 0 ? 1 : -1) * std::tan(kPi / (2 * sides)));
  }
  mesh.regions.resize(sides);
  mesh.edge_markers.resize(sides);
  return mesh;
}

// Of the triangles, whose sides are parabolas through their middle nodes.
double area_of(const MeshView& mesh) {
  double twice = 0;
  const auto cross = [&](std::uint32_t a, std::uint32_t b) {
    const auto at = [&](std::uint32_t v, int axis) {
      return mesh.coordinates[2 * std::size_t{v} + axis] - (axis == 0 ? 3 : -2);
    };
    return at(a, 0) * at(b, 1) - at(a, 1) * at(b, 0);
  };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[6 * t + k], b = mesh.triangles[6 * t + (k + 1) % 3],
                          m = mesh.triangles[6 * t + 3 + k];
      twice += (4 * (cross(a, m) + cross(m, b)) - cross(a, b)) / 3;
    }
  return twice / 2;
}

TEST(SecondOrderMesh, MiddlesOfArcsLieOnThem) {
  for (const auto& [sides, off] : {std::pair{8u, 7.8e-4}, {16u, 4.94e-5}, {32u, 3.1e-6}}) {
    const Mesh mesh = fan(sides);
    const MeshView view = mesh.view();
    const SecondOrderMesh second(view);
    EXPECT_EQ(second.straightened(), 0u);
    const MeshView made = second.view();
    for (std::size_t e = 0; e < made.edge_count(); ++e) {
      const double* middle = &made.coordinates[2 * std::size_t{made.edges[3 * e + 2]}];
      EXPECT_NEAR(std::hypot(middle[0] - 3, middle[1] + 2), 1, 1e-15 * 4);
    }
    EXPECT_NEAR(area_of(made), std::numbers::pi, off * std::numbers::pi) << sides;
  }
}

TEST(SecondOrderMesh, ArcsThatWouldTurnATriangleOverAreStraight) {
  // A flat triangle below a chord that bends down through it, and one above.
  Mesh mesh;
  mesh.coordinates = {0, 0, 4, 0, 2, -0.4, 2, 3};
  mesh.triangles = {0, 2, 1, 0, 1, 3};
  mesh.regions = {0, 0};
  mesh.edges = {0, 1, 2, 1};
  mesh.edge_markers = {0, 0};
  mesh.edge_bulges = {0.25, -0.01};
  const MeshView view = mesh.view();
  const SecondOrderMesh second(view);
  EXPECT_EQ(second.straightened(), 2u);  // both sides of the one triangle
  const MeshView made = second.view();
  EXPECT_EQ(made.coordinates[2 * std::size_t{made.edges[2]} + 1], 0);
  mesh.edge_bulges = {-0.25, -0.01};
  EXPECT_EQ(SecondOrderMesh(mesh.view()).straightened(), 0u);
}

TEST(SecondOrderMesh, SidesWithoutArcsAreStraight) {
  Mesh mesh = fan(4);
  mesh.edge_bulges.clear();
  const MeshView view = mesh.view();
  const SecondOrderMesh second(view);
  EXPECT_NEAR(area_of(second.view()), 2, 1e-15 * 8);
}

}  // namespace
}  // namespace weft::files
