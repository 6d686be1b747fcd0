// SPDX-License-Identifier: Apache-2.0
// Formats of finite-element solvers that want a number on every edge of the boundary: Medit's,
// Netgen's and MFEM's. That others read what is written is for read_back.py to say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "files/formats/mesh_formats.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::string written(const Mesh& mesh, const std::string& name) {
  TempFolder folder;
  EXPECT_TRUE(write_files(mesh.view(), folder / name));
  return contents_of(folder / name);
}

std::string refusal(const std::string& text, const char* file = "m.mesh") {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write(file, text));
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

TEST(Netgen, ComesBackAsItWas) {
  Mesh mesh = square_mesh(30);
  mesh.edge_markers.front() = -9;
  mesh.names.markers = {{3, "inlet"}};
  mesh.names.regions = {{mesh.regions.front(), "fluid"}};
  const auto back = round_trip(mesh, "m.vol");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->coordinates, mesh.coordinates);
  EXPECT_EQ(back->triangles, mesh.triangles);
  // The numbers of what has a name are lost, those of all else stay.
  ASSERT_EQ(back->edge_markers.size(), mesh.edge_markers.size());
  const auto inlet = id_of(back->names.markers, "inlet");
  const auto fluid = id_of(back->names.regions, "fluid");
  ASSERT_TRUE(inlet && fluid);
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e)
    EXPECT_EQ(back->edge_markers[e], mesh.edge_markers[e] == 3 ? *inlet : mesh.edge_markers[e]);
  for (std::size_t t = 0; t < mesh.regions.size(); ++t)
    EXPECT_EQ(back->regions[t], mesh.regions[t] == mesh.regions.front() ? *fluid : mesh.regions[t]);
}

// As Netgen 6.2 writes it: comments, geometry in the rows, and sections that say nothing of the
// mesh.
TEST(Netgen, ByNetgenHasCommentsGeometryAndOtherSections) {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write(
      "m.vol",
      "# Generated by NETGEN v6.2\n\nmesh3d\ndimension\n2\ngeomtype\n0\n\n"
      "# surfnr    bcnr   domin  domout      np      p1      p2      p3\nsurfaceelementsgi\n1\n"
      "       2       1       0       0       3       1       2       3 0 0 0\n\n"
      "#  matnr      np\nvolumeelements\n0\n\n# surfid  0   p1   p2   trignum1\n"
      "edgesegmentsgi2\n2\n       1       0       1       2      -1      -1       1       0"
      "           1           0           1           1\n 2 0 2 3 -1 -1 1 0 2 0 2 1\n"
      "points\n3\n 0.0 0.0 0.0\n 1.0 0.0 0.0\n 0.0 1.0 0.0\npointelements\n0\n"
      "materials\n1\n1 default\nbcnames\n2\n1 the inlet\n2 default\n\nface_colours\n1\n"
      "1 0.0 1.0 0.0\nendmesh\nnothing\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{1}));
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(mesh->names.markers, (NameTable{{1, "the inlet"}}));
}

TEST(Netgen, RefusesWhatItCannotRead) {
  const std::string head = "mesh3d\ndimension\n2\n";
  EXPECT_EQ(refusal("mesh\n", "m.vol"), "m.vol:1:1: expected the word mesh3d, found 'mesh'");
  EXPECT_EQ(refusal("mesh3d\ndimension\n3\n", "m.vol"),
            "m.vol:3:1: the dimension is 3, only 2 is read");
  EXPECT_EQ(refusal(head + "surfaceelements\n1\n2 1 0 0 6 1 2 3 4 5 6\n", "m.vol"),
            "m.vol:6:9: the element has 6 points, only 3 and 4 are read");
  EXPECT_EQ(refusal(head + "volumeelements\n1\n1 4 1 2 3 4\n", "m.vol"),
            "m.vol:6:1: there are volume elements, only triangles are read");
  EXPECT_EQ(refusal(head + "points\n2\n0 0 0\n", "m.vol"),
            "m.vol:5:1: the point count is 2, more than the rest of the file can hold");
  EXPECT_EQ(refusal(head + "surfaceelements\n1\n2 1 0 0 3 1 2 0\n", "m.vol"),
            "m.vol:6:15: a point is 0, the numbers run from 1 to 4294967295");
  EXPECT_EQ(refusal(head + "surfaceelements\n1\n2 1 0 0 3 1 2 3\n", "m.vol"),
            "m.vol: triangle 0 has vertex 0 of 0");
}

TEST(Mfem, HasAttributesFromOneAndNamesAsSets) {
  const std::string text = written(two_triangles(), "m.mfem");
  EXPECT_EQ(text,
            "MFEM mesh v1.3\n\ndimension\n2\n\nelements\n2\n7 2 0 1 2\n1 2 0 2 3\n\n"
            "attribute_sets\n1\n\"fluid\"\n1\n7\n\nboundary\n5\n2 1 1 0\n1 1 2 3\n5 1 3 0\n"
            "9 1 2 0\n3 1 1 2\n\nbdr_attribute_sets\n2\n\"the inlet\"\n1\n2\n\"inside\"\n1\n9\n\n"
            "vertices\n4\n2\n0 0\n1 0\n1 1\n0 0.5\n\nmfem_mesh_end\n");
}

TEST(Mfem, ComesBackAsItWas) {
  Mesh mesh = square_mesh(30);
  for (std::int32_t& region : mesh.regions) region += 5;
  mesh.names.markers = {{3, "the #1 inlet"}};
  mesh.names.regions = {{mesh.regions.front(), "fluid"}};
  const auto back = round_trip(mesh, "m.mfem");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST(Mfem, ByOthersHasCommentsAndSetsOfSeveralAttributes) {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write(
      "m.mfem",
      "MFEM mesh v1.3\n\n#\n# MFEM Geometry Types (see fem/geom.hpp):\n#\n\ndimension\n2\n\n"
      "elements\n1\n4 2 0 1\n2\nattribute_sets\n1\n\"wet\"\n1\n4\nboundary\n1\n3 1 0 1\n\n"
      "bdr_attribute_sets\n1\n\"all of it\"\n2\n3 6\n\nvertices\n3\n3\n0 0 9\n1 0 9\n"
      "0 1 9\n\nmfem_mesh_end\nnothing\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{4}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{3}));
  EXPECT_EQ(mesh->names.regions, (NameTable{{4, "wet"}}));
  EXPECT_EQ(mesh->names.markers, (NameTable{{3, "all of it"}}));
  EXPECT_THAT(mesh->warnings, testing::SizeIs(1));  // a name is of one marker
}

TEST(Mfem, RefusesWhatItCannotRead) {
  const std::string head = "MFEM mesh v1.0\ndimension\n2\n";
  EXPECT_EQ(refusal("MFEM NC mesh v1.0\n", "m.mfem"),
            "m.mfem:1:6: expected MFEM mesh v1.0 to v1.3, found 'MFEM NC mesh v1.0'");
  EXPECT_EQ(refusal("MFEM mesh v1.0\ndimension\n3\n", "m.mfem"),
            "m.mfem:3:1: the dimension is 3, only 2 is read");
  EXPECT_EQ(refusal(head + "elements\n1\n1 4 0 1 2 3\n", "m.mfem"),
            "m.mfem:6:3: the element's type is 4, only 2 and 3 are read here");
  EXPECT_EQ(refusal(head + "vertices\n0\n\nnodes\n", "m.mfem"),
            "m.mfem:7:1: expected the number of coordinates, found 'nodes'");
  EXPECT_EQ(refusal(head + "nodes\nFiniteElementSpace\n", "m.mfem"),
            "m.mfem:4:1: the section 'nodes' is not read: only straight, conforming triangles are");
  EXPECT_EQ(refusal(head + "attribute_sets\n1\nfluid\n1\n1\n", "m.mfem"),
            "m.mfem:6:1: expected a name in quotes, found 'fluid'");
  EXPECT_EQ(refusal(head + "elements\n1\n1 2 0 1 2\n", "m.mfem"),
            "m.mfem: triangle 0 has vertex 0 of 0");
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
}  // namespace weft::files
