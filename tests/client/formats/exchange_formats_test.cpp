// SPDX-License-Identifier: Apache-2.0
// Formats of others that weft writes and reads itself. That others read what is written is for
// read_back.py to say.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <set>

#include "client/formats/mesh_formats.h"
#include "tests/client/support/mesh_files.h"
#include "tests/client/support/sample_mesh.h"

namespace weft::client {
namespace {

using Edges = std::multiset<std::array<std::int64_t, 3>>;

// Edges without their direction, with their markers.
Edges edges_of(const Mesh& mesh) {
  Edges edges;
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e) {
    const auto [a, b] = std::minmax(mesh.edges[2 * e], mesh.edges[2 * e + 1]);
    edges.insert({a, b, mesh.edge_markers[e]});
  }
  return edges;
}

class ExchangeFormat : public ::testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& text) {
    const auto mesh = read_mesh(folder_.write(name, text));
    if (mesh) return "it was read";
    EXPECT_EQ(mesh.error().exit, ExitCode::kUnreadableInput);
    return mesh.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

TEST_F(ExchangeFormat, NpzAndObjComeBackAsTheyWere) {
  const Mesh mesh = square_mesh(30);
  for (const char* name : {"m.npz", "m.obj"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(*back, mesh) << name;
  }
}

TEST_F(ExchangeFormat, PartsComeBack) {
  Mesh mesh = square_mesh(2);
  mesh.parts = {0, 0, 1, 1, 2, 2, 3, 3};
  for (const char* name : {"m.npz", "m.vtu", "m.nc"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->parts, mesh.parts) << name;
  }
}

TEST_F(ExchangeFormat, PartsThatAreNoneAreRefusedOrLeftOutOfVtu) {
  Mesh mesh = square_mesh(1);
  mesh.parts = {0, -1};
  for (const char* name : {"m.npz", "m.nc"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_FALSE(back) << name;
    EXPECT_TRUE(back.error().message.ends_with("triangle 1 has the part -1, they count from 0"))
        << back.error().message;
  }
  const auto back = round_trip(mesh, "m.vtu");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->parts.empty());
}

TEST_F(ExchangeFormat, Su2AndAdcircComeBackWithTheirBoundary) {
  const Mesh mesh = square_mesh(30);
  for (const char* name : {"m.su2", "m.14", "m.GRD", "m.gr3"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->coordinates, mesh.coordinates) << name;
    EXPECT_EQ(back->triangles, mesh.triangles) << name;
    EXPECT_EQ(edges_of(*back), edges_of(mesh)) << name;
  }
}

TEST_F(ExchangeFormat, OffComesBackWithItsTriangles) {
  const Mesh mesh = square_mesh(30);
  const auto back = round_trip(mesh, "m.off");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->coordinates, mesh.coordinates);
  EXPECT_EQ(back->triangles, mesh.triangles);
}

TEST_F(ExchangeFormat, EveryFormatTakesAMeshThatIsEmpty) {
  std::filesystem::create_directories(folder_ / "constant/polyMesh");  // of .foam
  for (const char* name :
       {"m.vtu",  "m.msh", "m.node", "m.edge",    "m.neigh", "m.14",  "m.su2", "m.2dm",
        "m.nc",   "m.slf", "m.npz",  "m.geojson", "m.obj",   "m.off", "m.ply", "m.stl",
        "m.xdmf", "m.exo", "m.disv", "m.foam",    "m.mesh",  "m.vol", "m.mfem"})
    EXPECT_TRUE(write_files(MeshView{}, folder_ / name)) << name;
  for (const char* name : {"m.vtu", "m.msh", "m.node", "m.14", "m.su2", "m.mesh", "m.npz", "m.obj",
                           "m.off", "m.vol", "m.mfem"}) {
    const auto back = read_mesh(folder_ / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(*back, Mesh{}) << name;
  }
}

TEST_F(ExchangeFormat, AdcircTellsOpenBoundariesFromLandByMarker) {
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(folder_ / "fort.14", {}).value());
  write_mesh(*mesh_format("fort.14"), square_mesh(1).view(), files, {.open_boundaries = {2, 3}});
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(contents_of(folder_ / "fort.14"),
            "weft\n2 4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n1 3 1 2 4\n2 3 1 4 3\n"
            "2 = Number of open boundaries\n4 = Total number of open boundary nodes\n"
            "2 0 = Number of nodes for open boundary 1, marker 2\n2\n4\n"
            "2 0 = Number of nodes for open boundary 2, marker 3\n4\n3\n"
            "2 = Number of land boundaries\n4 = Total number of land boundary nodes\n"
            "2 0 = Number of nodes for land boundary 1, marker 1\n1\n2\n"
            "2 0 = Number of nodes for land boundary 2, marker 4\n3\n1\n");
}

TEST_F(ExchangeFormat, AdcircOfOneMarkerIsOneClosedBoundary) {
  Mesh mesh = square_mesh(1);
  mesh.edge_markers.assign(4, 8);
  ASSERT_TRUE(write_files(mesh.view(), folder_ / "land.14"));
  EXPECT_TRUE(
      contents_of(folder_ / "land.14")
          .ends_with("5 0 = Number of nodes for land boundary 1, marker 8\n1\n2\n4\n3\n1\n"))
      << contents_of(folder_ / "land.14");
}

TEST_F(ExchangeFormat, AdcircByOthersGetsMarkersByTheKindOfBoundary) {
  const auto mesh = read_mesh(folder_.write(
      "fort.14",
      "# a title, with words\n 2 4  NE NP\n1 0.0 0.0 -1.5\n2 1 0 2\n3 1 1 3\n4 0 1 4\n1 3 1 2 3\n"
      "2 3 1 3 4\n1 ! NOPE\n2 ! NETA\n2 ! open 1\n2\n3\n2 = NBOU\n7 = NVEL\n3 20 = mainland\n3\n4\n"
      "1\n4 21\n1\n2\n3\n4\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(edges_of(*mesh),
            (Edges{{1, 2, 1}, {2, 3, 2}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {2, 3, 3}, {0, 3, 3}}));
}

TEST_F(ExchangeFormat, Su2ByOthersGetsMarkersInTheOrderOfItsTags) {
  const auto mesh = read_mesh(folder_.write(
      "m.su2",
      "% a comment\nNDIME=2\nNPOIN = 3 3\n0 0 0\n1 0 1\n0 1 2\nNELEM= 1\n5 0 1 2 0\nNMARK= 3\n"
      "MARKER_TAG= wall\nMARKER_ELEMS= 1\n3 0 1\nMARKER_TAG= 1\nMARKER_ELEMS= 1\n3 1 2\n"
      "MARKER_TAG= far\nMARKER_ELEMS= 1\n3 2 0\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{2, 1, 3}));
}

TEST_F(ExchangeFormat, ObjByOthersMayCountBackwardsAndNameTextures) {
  const auto mesh = read_mesh(folder_.write(
      "m.obj", "mtllib x\nv 0 0 5\nv 1 0 5\nv 0 1 5\nvt 0 0\nusemtl red\nf 1/1/2 2//1 -1\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
}

TEST_F(ExchangeFormat, RefusesWhatItCannotRead) {
  EXPECT_EQ(refusal("m.14", "title\n1 3\n1 0 0 0\n2 1 0 0\n2 0 1 0\n"),
            "m.14:5:1: the node number is 2, as that of another one before it");
  EXPECT_EQ(refusal("m.14", "title\n1 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 4 1 2 3 3\n"),
            "m.14:6:3: the nodes per element are 4, only 3 are read");
  EXPECT_EQ(refusal("m.14", "title\n1 99999999\n1 0 0 0\n"),
            "m.14:2:3: the node count is 99999999, more than the rest of the file can hold");
  EXPECT_EQ(refusal("m.su2", "NDIME= 3\n"), "m.su2:1:8: the dimension is 3, only 2 is read");
  EXPECT_EQ(refusal("m.su2", "NDIME= 2\nNELEM= 1\n9 0 1 2 3 0\n"),
            "m.su2:3:1: the element's type is 9, only 5 is read here");
  EXPECT_EQ(refusal("m.su2", "NDIME= 2\nNELEM= 1\n5 0 1 7 0\nNPOIN= 1\n0 0\n"),
            "m.su2: triangle 0 has vertex 1 of 1");
  EXPECT_EQ(refusal("m.obj", "v 0 0 0\nf 1 2 3\n"),
            "m.obj:2:5: the vertex is 2, so far there are 1");
  EXPECT_EQ(refusal("m.obj", "v 0 0 0\nf 1 1 1 1\n"), "m.obj:2:7: the face is not a triangle");
  EXPECT_EQ(refusal("m.off", "COFF\n"), "m.off:1:1: expected the word OFF, found 'COFF'");
  EXPECT_EQ(refusal("m.npz", "PK"), "m.npz: is not a zip archive, or it is cut short");
}

TEST_F(ExchangeFormat, NpzTellsWhichArrayIsWrong) {
  ASSERT_TRUE(write_files(square_mesh(1).view(), folder_ / "m.npz"));
  const std::string whole = contents_of(folder_ / "m.npz");
  const auto with = [&whole](const std::string& from, const std::string& to) {
    std::string text = whole;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refusal("x.npz", with("'<f8'", "'<c8'")),
            "x.npz: array 'points' has the type '<c8', which is not read");
  EXPECT_EQ(refusal("x.npz", with("(4, 2)", "(4, 9)")), "x.npz: array 'points' is cut short");
  EXPECT_EQ(refusal("x.npz", with("(2, 3)", "(3, 2)")),
            "x.npz: array 'triangles' does not have 3 columns");
  EXPECT_EQ(refusal("x.npz", whole.substr(0, whole.size() - 40)),
            "x.npz: is not a zip archive, or it is cut short");
}

TEST_F(ExchangeFormat, Gmsh22ComesBackWithAllVerticesAndElements) {
  Mesh mesh = square_mesh(30);
  mesh.edge_markers.front() = std::numeric_limits<std::int32_t>::min();
  mesh.regions.front() = -1;
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(folder_ / "m.msh", {}).value());
  write_mesh(*mesh_format("m.msh"), mesh.view(), files, {.msh_version = MshVersion::k22});
  ASSERT_TRUE(commit(files));
  EXPECT_TRUE(contents_of(folder_ / "m.msh").starts_with("$MeshFormat\n2.2 0 8\n"));
  const auto back = read_mesh(folder_ / "m.msh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST_F(ExchangeFormat, SecondOrderSharesMidsideNodes) {
  std::vector<OutputFile> files;
  for (const auto& name : mesh_files(folder_ / "m.node"))
    files.push_back(OutputFile::create(name, {}).value());
  write_mesh(*mesh_format("m.node"), square_mesh(1).view(), files, {.order = 2});
  ASSERT_TRUE(commit(files));
  // Edges by their vertices: 1-2, 1-3, 1-4, 2-4, 3-4.
  EXPECT_EQ(contents_of(folder_ / "m.node"),
            "9 2 0 1\n1 0 0 1\n2 1 0 1\n3 0 1 3\n4 1 1 2\n"
            "5 0.5 0 1\n6 0 0.5 4\n7 0.5 0.5 0\n8 1 0.5 2\n9 0.5 1 3\n");
  EXPECT_EQ(contents_of(folder_ / "m.ele"), "2 6 1\n1 1 2 4 8 7 5 0\n2 1 4 3 9 6 7 0\n");
}

TEST_F(ExchangeFormat, SecondOrderIsForFormatsThatHaveIt) {
  const auto checked = check_writable("m.su2", {.order = 2});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().exit, ExitCode::kUsage);
  EXPECT_EQ(checked.error().message,
            "m.su2: the extension '.su2' is not that of a mesh of second order: .vtu, .msh, .node, "
            ".xdmf, .exo, .e");
}

}  // namespace
}  // namespace weft::client
