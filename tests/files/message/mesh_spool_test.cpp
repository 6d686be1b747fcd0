// SPDX-License-Identifier: Apache-2.0
#include "files/message/mesh_spool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

// The pieces of square_mesh(n), a row each; vertices come with the row above them.
std::vector<Mesh> rows_of(const Mesh& mesh, std::size_t n) {
  std::vector<Mesh> rows;
  for (std::size_t row = 0; row < n; ++row) {
    Mesh piece;
    const std::size_t vertices = row == 0 ? 2 * (n + 1) : n + 1;
    const std::size_t first = row == 0 ? 0 : (row + 1) * (n + 1);
    piece.coordinates.assign(&mesh.coordinates[2 * first],
                             &mesh.coordinates[2 * first] + 2 * vertices);
    piece.triangles.assign(&mesh.triangles[6 * n * row], &mesh.triangles[6 * n * row] + 6 * n);
    piece.regions.assign(&mesh.regions[2 * n * row], &mesh.regions[2 * n * row] + 2 * n);
    rows.push_back(std::move(piece));
  }
  rows.back().edges = mesh.edges;
  rows.back().edge_markers = mesh.edge_markers;
  return rows;
}

TEST(MeshSpool, GivesTheMeshBackThatCameInPieces) {
  const TempFolder folder;
  const Mesh mesh = square_mesh(40);
  const auto spool = MeshSpool::create(folder.path()).value();
  for (const Mesh& row : rows_of(mesh, 40)) ASSERT_TRUE(spool->append(row.view()));
  const MeshView view = spool->view().value();
  EXPECT_TRUE(std::ranges::equal(view.coordinates, mesh.coordinates));
  EXPECT_TRUE(std::ranges::equal(view.triangles, mesh.triangles));
  EXPECT_TRUE(std::ranges::equal(view.regions, mesh.regions));
  EXPECT_TRUE(std::ranges::equal(view.edges, mesh.edges));
  EXPECT_TRUE(std::ranges::equal(view.edge_markers, mesh.edge_markers));
}

TEST(MeshSpool, TakesMissingRegionsAndMarkersForZeros) {
  const TempFolder folder;
  Mesh mesh = square_mesh(4);
  const Mesh with = mesh;
  mesh.regions.clear();
  mesh.edge_markers.clear();
  const auto spool = MeshSpool::create(folder.path()).value();
  for (const MeshView& piece : {mesh.view(), with.view(), mesh.view()})
    ASSERT_TRUE(spool->append(piece));
  const MeshView view = spool->view().value();
  const auto expect = [](std::span<const std::int32_t> values, const std::vector<int>& middle) {
    std::vector<int> expected(middle.size());
    expected.insert(expected.end(), middle.begin(), middle.end());
    expected.resize(3 * middle.size());
    EXPECT_TRUE(std::ranges::equal(values, expected));
  };
  expect(view.regions, with.regions);
  expect(view.edge_markers, with.edge_markers);
}

TEST(MeshSpool, ShowsEachPieceWithAllVerticesSoFar) {
  const TempFolder folder;
  const Mesh mesh = square_mesh(300);
  const std::vector<Mesh> rows = rows_of(mesh, 300);
  std::size_t seen = 0;
  const auto watch = [&](const MeshView& piece) {
    const std::size_t vertices = 301 * (seen + 2);
    EXPECT_TRUE(
        std::ranges::equal(piece.coordinates, std::span(mesh.coordinates).first(2 * vertices)));
    EXPECT_TRUE(std::ranges::equal(piece.triangles, rows[seen].triangles));
    EXPECT_TRUE(std::ranges::equal(piece.edges, rows[seen].edges));
    ++seen;
  };
  const auto spool =
      MeshSpool::create(folder.path(), {.vertices_only = true, .on_piece = watch}).value();
  for (const Mesh& row : rows) ASSERT_TRUE(spool->append(row.view()));
  EXPECT_EQ(seen, 300u);
  EXPECT_EQ(spool->triangles(), 180'000u);
  EXPECT_EQ(spool->edges(), 1200u);
  EXPECT_EQ(spool->view().value().triangle_count(), 0u);
  EXPECT_TRUE(std::ranges::equal(spool->view().value().edge_markers, mesh.edge_markers));
}

}  // namespace
}  // namespace weft::files
