// SPDX-License-Identifier: Apache-2.0
#include "tests/files/support/sample_mesh.h"

namespace weft::files {

Mesh square_mesh(std::uint32_t n) {
  Mesh mesh;
  const auto vertex = [n](std::uint32_t column, std::uint32_t row) {
    return row * (n + 1) + column;
  };
  for (std::uint32_t row = 0; row <= n; ++row)
    for (std::uint32_t column = 0; column <= n; ++column)
      mesh.coordinates.insert(mesh.coordinates.end(), {double(column), double(row)});
  for (std::uint32_t row = 0; row < n; ++row) {
    for (std::uint32_t column = 0; column < n; ++column) {
      const std::uint32_t a = vertex(column, row);
      const std::uint32_t b = vertex(column + 1, row);
      const std::uint32_t c = vertex(column + 1, row + 1);
      const std::uint32_t d = vertex(column, row + 1);
      mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
      mesh.regions.insert(mesh.regions.end(), 2, 2 * column < n ? 0 : 7);
    }
  }
  const auto edge = [&mesh](std::uint32_t a, std::uint32_t b, std::int32_t marker) {
    mesh.edges.insert(mesh.edges.end(), {a, b});
    mesh.edge_markers.push_back(marker);
  };
  for (std::uint32_t i = 0; i < n; ++i) edge(vertex(i, 0), vertex(i + 1, 0), 1);
  for (std::uint32_t i = 0; i < n; ++i) edge(vertex(n, i), vertex(n, i + 1), 2);
  for (std::uint32_t i = 0; i < n; ++i) edge(vertex(i + 1, n), vertex(i, n), 3);
  for (std::uint32_t i = 0; i < n; ++i) edge(vertex(0, i + 1), vertex(0, i), 4);
  return mesh;
}

Mesh two_triangles() {
  Mesh mesh;
  mesh.coordinates = {0, 0, 1, 0, 1, 1, 0, 0.5};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.regions = {7, -2};
  mesh.edges = {1, 0, 2, 3, 3, 0, 2, 0};
  mesh.edge_markers = {2, -1, 5, 9};
  mesh.names.markers = {{2, "the inlet"}, {9, "inside"}};
  mesh.names.regions = {{7, "fluid"}};
  return mesh;
}

Domain square_domain(std::uint32_t n) {
  Domain domain;
  const double side = n;
  domain.points = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  domain.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return domain;
}

}  // namespace weft::files
