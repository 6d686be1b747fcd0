// SPDX-License-Identifier: Apache-2.0
// Of larger meshes: tests/client/read_back.py.
#include "files/formats/derived/voronoi_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace weft::files {
namespace {

using Polygon = std::vector<Point>;

// Cells by vertex.
std::map<std::uint32_t, Polygon> cells_of(const Mesh& mesh) {
  const auto view = mesh.view();
  const VoronoiCells cells(view);
  std::vector<Point> corners;
  cells.each_corner([&corners](Point at) { corners.push_back(at); });
  EXPECT_EQ(corners.size(), cells.corner_count());
  std::map<std::uint32_t, Polygon> polygons;
  cells.each_cell([&](std::uint32_t vertex, std::span<const std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) polygons[vertex].push_back(corners.at(number));
  });
  EXPECT_EQ(polygons.size(), cells.cell_count());
  return polygons;
}

Mesh mesh_of(const Polygon& points, std::vector<std::uint32_t> triangles) {
  Mesh mesh;
  for (const Point& point : points)
    mesh.coordinates.insert(mesh.coordinates.end(), {point.x, point.y});
  mesh.regions.resize(triangles.size() / 3);
  mesh.triangles = std::move(triangles);
  return mesh;
}

// Positive if it is clockwise.
double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i];
    const Point b = polygon[(i + 1) % polygon.size()];
    twice += b.x * a.y - a.x * b.y;
  }
  return twice / 2;
}

double whole_area(const std::map<std::uint32_t, Polygon>& cells) {
  double sum = 0;
  for (const auto& [vertex, polygon] : cells) sum += area(polygon);
  return sum;
}

// No corner of a cell is nearer to another vertex.
void expect_nearest(const Polygon& points, const std::map<std::uint32_t, Polygon>& cells) {
  for (const auto& [vertex, polygon] : cells)
    for (const Point at : polygon) {
      const auto distance = [at](Point p) { return std::hypot(p.x - at.x, p.y - at.y); };
      double nearest = std::numeric_limits<double>::infinity();
      for (const Point point : points) nearest = std::min(nearest, distance(point));
      EXPECT_NEAR(distance(points[vertex]), nearest, 1e-12)
          << "of vertex " << vertex << " at " << at.x << ", " << at.y;
    }
}

std::vector<std::pair<double, double>> sorted(const Polygon& polygon) {
  std::vector<std::pair<double, double>> out;
  for (const Point at : polygon) out.emplace_back(at.x, at.y);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(VoronoiCells, OfASquareAreFourSquares) {
  const auto cells = cells_of(mesh_of({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {0, 1, 2, 0, 2, 3}));
  ASSERT_EQ(cells.size(), 4u);
  for (const auto& [vertex, polygon] : cells) {
    EXPECT_EQ(polygon.size(), 4u);
    EXPECT_EQ(area(polygon), 1);
  }
}

TEST(VoronoiCells, OfATriangleThatIsObtuseAtTheBoundaryEndThere) {
  const Polygon points = {{0, 0}, {4, 0}, {2, 1}};
  const auto cells = cells_of(mesh_of(points, {0, 1, 2}));
  EXPECT_DOUBLE_EQ(whole_area(cells), 2);
  expect_nearest(points, cells);
  const std::vector<std::pair<double, double>> left = {{0, 0}, {1, 0.5}, {1.25, 0}};
  EXPECT_EQ(sorted(cells.at(0)), left);
  EXPECT_EQ(cells.at(2).size(), 5u);
}

// The circumcentres of both triangles of vertex 3 are below the boundary.
TEST(VoronoiCells, OfSeveralTrianglesBeyondOneSideShareIt) {
  const Polygon points = {{0, 0}, {10, 0}, {3, 0.5}, {6, 1}, {5, 3}};
  const auto cells = cells_of(mesh_of(points, {0, 1, 2, 2, 1, 3, 0, 2, 4, 2, 3, 4, 3, 1, 4}));
  EXPECT_NEAR(whole_area(cells), 15, 1e-12);
  expect_nearest(points, cells);
}

TEST(VoronoiCells, CrossEdgesThatAreNotDelaunay) {
  const Polygon points = {{0, 0}, {4, -1}, {8, 0}, {4, 1}};
  const auto cells = cells_of(mesh_of(points, {0, 1, 2, 0, 2, 3}));
  EXPECT_DOUBLE_EQ(whole_area(cells), 8);
  expect_nearest(points, cells);
}

TEST(VoronoiCells, OfAVertexBetweenTwoHolesHaveBothParts) {
  const auto cells =
      cells_of(mesh_of({{0, 0}, {2, -1}, {2, 1}, {-2, 1}, {-2, -1}, {9, 9}}, {0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(cells.size(), 5u);  // none of the vertex without a triangle
  EXPECT_DOUBLE_EQ(whole_area(cells), 4);
  EXPECT_GT(area(cells.at(0)), area(cells.at(1)));
}

}  // namespace
}  // namespace weft::files
