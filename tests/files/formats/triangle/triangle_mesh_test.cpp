// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_mesh.h"

#include <gtest/gtest.h>

#include "files/formats/domain_formats.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

TEST(TriangleMesh, ComesBackAsItWas) {
  const Mesh mesh = square_mesh(30);
  const auto back = round_trip(mesh, "m.node");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST(TriangleMesh, KeepsEveryBitOfACoordinate) {
  Mesh mesh = square_mesh(1);
  mesh.coordinates[2] = 0.1 + 0.2;
  mesh.coordinates[3] = 5e-324;
  mesh.coordinates[5] = 1.7976931348623157e308;
  const auto back = round_trip(mesh, "m.node");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->coordinates, mesh.coordinates);
}

TEST(TriangleMesh, WritesThreeFilesThatTriangleReads) {
  TempFolder folder;
  Mesh mesh = square_mesh(1);
  ASSERT_TRUE(write_files(mesh.view(), folder / "m.node"));
  EXPECT_EQ(contents_of(folder / "m.node"), "4 2 0 1\n1 0 0 1\n2 1 0 1\n3 0 1 3\n4 1 1 2\n");
  EXPECT_EQ(contents_of(folder / "m.ele"), "2 3 1\n1 1 2 4 0\n2 1 4 3 0\n");
  EXPECT_EQ(contents_of(folder / "m.poly"),
            "0 2 0 1\n4 1\n1 1 2 1\n2 2 4 2\n3 4 3 3\n4 3 1 4\n0\n");
}

TEST(TriangleMesh, MarksVerticesByPointThenByEdgeThenByBoundary) {
  TempFolder folder;
  Mesh mesh = square_mesh(2);
  mesh.edge_markers.assign(mesh.edge_markers.size(), 0);
  mesh.edge_markers[0] = 6;  // from vertex 0 to vertex 1
  MeshView view = mesh.view();
  const std::vector<std::uint32_t> input_points = {0, 1};  // vertex 0 is input point 1
  const std::vector<std::int32_t> markers = {8, 9};
  view.input_points = input_points;
  view.input_point_markers = markers;
  ASSERT_TRUE(write_files(view, folder / "m.node"));
  EXPECT_EQ(
      contents_of(folder / "m.node"),
      "9 2 0 1\n1 0 0 9\n2 1 0 6\n3 2 0 1\n4 0 1 1\n5 1 1 0\n6 2 1 1\n7 0 2 1\n8 1 2 1\n9 2 2 1\n");
}

TEST(TriangleMesh, ReadsAMeshWithoutEdges) {
  TempFolder folder;
  folder.write("m.node", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
  folder.write("m.ele", "1 3 0\n0 0 1 2\n");
  const auto mesh = read_mesh(folder / "m.ele");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(TriangleMesh, RefusesWhatDoesNotFit) {
  TempFolder folder;
  folder.write("m.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n");
  const auto refusal = [&folder](const std::string& ele) {
    folder.write("m.ele", ele);
    const auto mesh = read_mesh(folder / "m.node");
    return mesh ? "it was read" : mesh.error().message.substr(folder.path().string().size() + 1);
  };
  EXPECT_EQ(refusal("1 3 0\n1 1 2 4\n"), "m.ele:2:7: a corner is 4, the numbers run from 1 to 3");
  EXPECT_EQ(refusal("1 6 0\n1 1 2 3 1 2 3\n"),
            "m.node: node 0 is the middle of a side, and the end of one");
  EXPECT_EQ(refusal("1 10 0\n1 1 2 3 1 2 3\n"),
            "m.ele:1:3: the corners per triangle are 10, only 3 and 6 are read");
  EXPECT_EQ(refusal("2 3 0\n1 1 2 3\n"), "m.ele:3: the file ends where a triangle should follow");
}

TEST(TriangleMesh, GivesAttributesThatAreNoIntegersTheIdsThatTheDomainGivesThem) {
  TempFolder folder;
  folder.write("m.node", "4 2 0 0\n1 0 0\n2 1 0\n3 0 1\n4 1 1\n");
  folder.write("m.ele", "2 3 1\n1 1 2 3 0.7\n2 2 4 3 0.35\n");
  const auto mesh = read_mesh(folder / "m.node");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{2, 1}));
}

TEST(MeshFormats, RefuseUnknownExtensions) {
  const auto mesh = read_mesh("m.stl");
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().exit, ExitCode::kUsage);
  EXPECT_EQ(
      mesh.error().message,
      "m.stl: the extension '.stl' is not that of a mesh that is read: .vtu, .msh, .node, .ele, "
      ".14, .grd, .gr3, .2dm, .nc, .slf, .su2, .mesh, .vol, .mfem, .inp, .npz, .obj, .off");
  const auto domain = read_domain("m.stp");
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().exit, ExitCode::kUsage);
}

}  // namespace
}  // namespace weft::files
