// SPDX-License-Identifier: Apache-2.0
// Formats of finite-element solvers that want a number on every edge of the boundary: Medit's,
// Netgen's and MFEM's. That others read what is written is for read_back.py to say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "client/formats/mesh_formats.h"
#include "tests/client/support/mesh_files.h"
#include "tests/client/support/sample_mesh.h"

namespace weft::client {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Two triangles, the edge between them, and their boundary but for the right side, which has no
// edge.
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

std::string written(const Mesh& mesh, const std::string& name) {
  TempFolder folder;
  EXPECT_TRUE(write_files(mesh.view(), folder / name));
  return contents_of(folder / name);
}

std::string refusal(const std::string& text) {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write("m.mesh", text));
  if (mesh) return "it was read";
  EXPECT_EQ(mesh.error().exit, ExitCode::kUnreadableInput);
  return mesh.error().message.substr(folder.path().string().size() + 1);
}

TEST(Medit, HasEdgesInTheirOrderThenTheRestOfTheBoundary) {
  EXPECT_EQ(written(two_triangles(), "m.mesh"),
            "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 0.5 0\n"
            "Edges\n5\n2 1 2\n3 4 -1\n4 1 5\n3 1 9\n2 3 0\nTriangles\n2\n1 2 3 7\n1 3 4 -2\nEnd\n");
}

TEST(Medit, ComesBackAsItWas) {
  Mesh mesh = square_mesh(30);
  mesh.edge_markers.front() = std::numeric_limits<std::int32_t>::min();
  mesh.regions.front() = -1;
  const auto back = round_trip(mesh, "m.mesh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST(Medit, ByOthersMayBeInSpaceHaveOtherSectionsAndBreakLinesAnywhere) {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write(
      "m.mesh",
      "\n MeshVersionFormatted 1 # mmg\nDimension\n3\nTriangles 1\n1 2\n3 4\nCorners\n2\n1\n2\n"
      "RequiredEdges 1 1\nQuadrilaterals 0\nVertices\n3\n0 0 5 1\n1 0 5 1\n0 1.0D+00 5 1\n"
      "Edges\n1\n1 2 8\nNormals\n1\n-0.5 .5 1e-3\nEnd\nnothing\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{4}));
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{8}));
}

TEST(Medit, RefusesWhatItCannotRead) {
  const std::string head = "MeshVersionFormatted 2\nDimension 2\n";
  EXPECT_EQ(refusal("MFEM mesh v1.0\n"),
            "m.mesh:1:1: expected the word MeshVersionFormatted, found 'MFEM'");
  EXPECT_EQ(refusal("MeshVersionFormatted 2\nDimension 4\n"),
            "m.mesh:2:11: the dimension is 4, only 2 and 3 are read");
  EXPECT_EQ(refusal("MeshVersionFormatted 2\nVertices\n1\n0 0 0\n"),
            "m.mesh:2:1: Vertices stand before the Dimension");
  EXPECT_EQ(refusal(head + "Tetrahedra\n1\n1 2 3 4 0\n"),
            "m.mesh:4:1: there are Tetrahedra, only Triangles and Edges are read");
  EXPECT_EQ(refusal(head + "Triangles\n9999\n1 2 3 0\n"),
            "m.mesh:4:1: the triangle count is 9999, more than the rest of the file can hold");
  EXPECT_EQ(refusal(head + "Triangles\n1\n1 2 3 0\nEnd\n"), "m.mesh: triangle 0 has vertex 0 of 0");
  EXPECT_EQ(refusal(head + "Edges\n1\n0 1 0\n"),
            "m.mesh:5:1: a vertex is 0, the numbers run from 1 to 4294967295");
  EXPECT_EQ(refusal(head + "7\n"), "m.mesh:3:1: expected a keyword, found '7'");
}

TEST(Netgen, NumbersDomainsAndConditionsFromOneAndNamesAll) {
  EXPECT_EQ(written(two_triangles(), "m.vol"),
            "mesh3d\ndimension\n2\ngeomtype\n0\n\nsurfaceelements\n2\n3 2 0 0 3 1 2 3\n"
            "2 1 0 0 3 1 3 4\n\nedgesegmentsgi2\n5\n3 0 1 2 0 0 2 0 3 0 3 0\n"
            "1 0 3 4 0 0 1 0 1 0 1 0\n4 0 4 1 0 0 1 0 4 0 4 0\n5 0 3 1 0 0 2 1 5 0 5 0\n"
            "2 0 2 3 0 0 2 0 2 0 2 0\n\nbcnames\n5\n1 marker_-1\n2 marker_0\n3 the_inlet\n"
            "4 marker_5\n5 inside\n\npoints\n4\n0 0 0\n1 0 0\n1 1 0\n0 0.5 0\n\nmaterials\n2\n"
            "1 region_-2\n2 fluid\n\nendmesh\n");
}

TEST(Netgen, HasNamesThatNoEdgeHas) {
  Mesh mesh = square_mesh(2);
  mesh.names.markers = {{1, "marker_7"}, {9, "spare"}};
  EXPECT_THAT(written(mesh, "m.vol"),
              HasSubstr("bcnames\n5\n1 _marker_7\n2 marker_2\n3 marker_3\n4 marker_4\n5 spare\n"));
  EXPECT_THAT(not_carried("m.vol", mesh.view()),
              ElementsAre("m.vol: the format cannot spell all names, it has '_marker_7' for "
                          "'marker_7'"));
}

TEST(Mfem, HasAttributesFromOneAndNamesAsSets) {
  const std::string text = written(two_triangles(), "m.mfem");
  EXPECT_EQ(text,
            "MFEM mesh v1.3\n\ndimension\n2\n\nelements\n2\n7 2 0 1 2\n1 2 0 2 3\n\n"
            "attribute_sets\n1\n\"fluid\"\n1\n7\n\nboundary\n5\n2 1 1 0\n1 1 2 3\n5 1 3 0\n"
            "9 1 2 0\n3 1 1 2\n\nbdr_attribute_sets\n2\n\"the inlet\"\n1\n2\n\"inside\"\n1\n9\n\n"
            "vertices\n4\n2\n0 0\n1 0\n1 1\n0 0.5\n\nmfem_mesh_end\n");
}

TEST(Mfem, WithoutNamesIsOfTheVersionThatEveryMfemReads) {
  Mesh mesh = two_triangles();
  mesh.names = {};
  const std::string text = written(mesh, "m.mfem");
  EXPECT_THAT(text, StartsWith("MFEM mesh v1.0\n"));
  EXPECT_THAT(text, EndsWith("\nvertices\n4\n2\n0 0\n1 0\n1 1\n0 0.5\n"));
  EXPECT_THAT(not_carried("m.mfem", two_triangles().view()), IsEmpty());
}

}  // namespace
}  // namespace weft::client
