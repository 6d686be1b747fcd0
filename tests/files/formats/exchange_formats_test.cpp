// SPDX-License-Identifier: Apache-2.0
// Formats of others that weft writes and reads itself. That others read what is written is for
// read_back.py to say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <set>

#include "files/formats/mesh_formats.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
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
       {"m.vtu",  "m.msh", "m.node", "m.edge",    "m.neigh", "m.14",  "m.su2",  "m.2dm",
        "m.nc",   "m.slf", "m.npz",  "m.geojson", "m.obj",   "m.off", "m.ply",  "m.stl",
        "m.xdmf", "m.exo", "m.disv", "m.foam",    "m.mesh",  "m.vol", "m.mfem", "m.inp"})
    EXPECT_TRUE(write_files(MeshView{}, folder_ / name)) << name;
  for (const char* name : {"m.vtu", "m.msh", "m.node", "m.14", "m.su2", "m.mesh", "m.npz", "m.obj",
                           "m.off", "m.vol", "m.mfem", "m.inp"}) {
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
  EXPECT_EQ(refusal("m.14", "title\n1 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 5 1 2 3 3 3\n"),
            "m.14:6:3: the nodes per element are 5, only 3 and 4 are read");
  EXPECT_EQ(refusal("m.14", "title\n1 99999999\n1 0 0 0\n"),
            "m.14:2:3: the node count is 99999999, more than the rest of the file can hold");
  EXPECT_EQ(refusal("m.su2", "NDIME= 3\n"), "m.su2:1:8: the dimension is 3, only 2 is read");
  EXPECT_EQ(refusal("m.su2", "NDIME= 2\nNELEM= 1\n12 0 1 2 3 0\n"),
            "m.su2:3:1: the element's type is 12, only 5 and 9 are read here");
  EXPECT_EQ(refusal("m.su2", "NDIME= 2\nNELEM= 1\n5 0 1 7 0\nNPOIN= 1\n0 0\n"),
            "m.su2: triangle 0 has vertex 1 of 1");
  EXPECT_EQ(refusal("m.obj", "v 0 0 0\nf 1 2 3\n"),
            "m.obj:2:5: the vertex is 2, so far there are 1");
  EXPECT_EQ(refusal("m.off", "XOFF\n"),
            "m.off:1:1: expected the word OFF, COFF, NOFF or STOFF, found 'XOFF'");
  EXPECT_EQ(refusal("m.off", "OFF BINARY\n"), "m.off:1:1: the file is binary, only text is read");
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

TEST_F(ExchangeFormat, SecondOrderComesBackAsEdgesOnArcs) {
  Mesh mesh = square_mesh(8);
  mesh.regions.assign(mesh.regions.size(), 0);  // Gmsh's elements are in order of their regions
  mesh.edge_bulges.assign(mesh.edge_markers.size(), 0);
  mesh.edge_bulges[3] = 0.2;
  mesh.edge_bulges[20] = -0.125;
  for (double& c : mesh.coordinates) c = 2e5 + 0.1 * c;  // far away
  std::vector<double> depth(mesh.coordinates.size() / 2);
  for (std::size_t v = 0; v < depth.size(); ++v) depth[v] = static_cast<double>(v * v);
  const VertexValues values{"depth", depth};
  for (const auto& [name, version] :
       {std::pair{"m.vtu", MshVersion::k41}, std::pair{"m.msh", MshVersion::k41},
        std::pair{"m.msh", MshVersion::k22}, std::pair{"m.node", MshVersion::k41}}) {
    SCOPED_TRACE(name);
    std::vector<OutputFile> files;
    for (const auto& file : mesh_files(folder_ / name))
      files.push_back(OutputFile::create(file, {}).value());
    MeshView view = mesh.view();
    view.vertex_values = {&values, 1};
    EXPECT_EQ(write_mesh(*mesh_format(name), view, files, {.order = 2, .msh_version = version}),
              0u);
    ASSERT_TRUE(commit(files));
    const auto back = read_mesh_with_arrays(folder_ / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->mesh.coordinates, mesh.coordinates);
    EXPECT_EQ(back->mesh.triangles, mesh.triangles);
    EXPECT_EQ(back->mesh.edges, mesh.edges);
    EXPECT_EQ(back->mesh.edge_markers, mesh.edge_markers);
    EXPECT_THAT(back->mesh.edge_bulges,
                ::testing::Pointwise(::testing::DoubleNear(1e-9), mesh.edge_bulges));
    EXPECT_TRUE(back->mesh.warnings.empty());
    for (const NamedArray& array : back->arrays) EXPECT_EQ(array.values.value(), depth);
  }
}

TEST_F(ExchangeFormat, BentSidesThatAreNoArcsAreToldAndStraight) {
  // The first side bends, and is no edge; the middle of the edge is not on its bisector.
  folder_.write("m.node", "6 2 0 0\n1 0 0\n2 1 0\n3 0 1\n4 0.5 -0.1\n5 0.5 0.6\n6 0 0.4\n");
  folder_.write("m.ele", "1 6 0\n1 1 2 3 5 6 4\n");
  folder_.write("m.poly", "0 2 0 1\n1 1\n1 3 1 5\n0\n");
  const auto mesh = read_mesh(folder_ / "m.node");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_TRUE(mesh->edge_bulges.empty());
  ASSERT_EQ(mesh->warnings.size(), 1u);
  EXPECT_EQ(mesh->warnings[0].count, 3u);
  EXPECT_EQ(mesh->warnings[0].text,
            "3 bent sides are read as straight: only edges with a node on their bisector are arcs");
}

TEST_F(ExchangeFormat, SecondOrderIsForFormatsThatHaveIt) {
  const auto checked = check_writable("m.su2", {.order = 2});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().exit, ExitCode::kUsage);
  EXPECT_EQ(checked.error().message,
            "m.su2: the extension '.su2' is not that of a mesh of second order: .vtu, .msh, .node, "
            ".xdmf, .exo, .e, .inp");
}

// A unit of two triangles whose points have these lines.
std::string su2_with(const std::string& points) {
  return "NDIME= 2\nNPOIN= 4\n" + points + "NELEM= 2\n5 0 1 2 0\n5 0 2 3 1\n";
}

TEST_F(ExchangeFormat, Su2ObeysTheNumbersOfItsPoints) {
  const std::vector<double> square = {0, 0, 2, 0, 2, 1, 0, 1};
  for (const char* points : {"0 0 0\n2 0 1\n2 1 2\n0 1 3\n", "2 1 2\n0 0 0\n2 0 1\n0 1 3\n",
                             "0 0 1\n2 0 2\n2 1 3\n0 1 4\n", "0 0\n2 0\n2 1\n0 1\n"}) {
    const auto mesh = read_mesh(folder_.write("m.su2", su2_with(points)));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->coordinates, square) << points;
  }
  EXPECT_EQ(
      refusal("m.su2", su2_with("0 0 0\n2 0 2\n2 1 2\n0 1 3\n")),
      "m.su2:5:5: the number of the point is 2, but points have the numbers from 0 to 3, each "
      "once");
  EXPECT_EQ(
      refusal("m.su2", su2_with("0 0 0\n2 0 1\n2 1 4\n0 1 3\n")),
      "m.su2:5:5: the number of the point is 4, but points have the numbers from 0 to 3, each "
      "once");
}

// The header of an array, and its bytes.
std::string npy(const std::string& type, bool by_columns, const std::string& shape,
                const std::string& values) {
  std::string head = "{'descr': '" + type +
                     "', 'fortran_order': " + (by_columns ? "True" : "False") + ", 'shape': (" +
                     shape + "), }";
  head.resize(117, ' ');
  return "\x93NUMPY" + std::string("\1\0\x76\0", 4) + head + "\n" + values;
}

template <class T>
std::string raw(std::initializer_list<T> values) {
  return {reinterpret_cast<const char*>(std::data(values)), sizeof(T) * values.size()};
}

// An archive without compression.
std::string archive(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string local, directory;
  const auto number = [](std::size_t value, std::size_t bytes) {
    return std::string(reinterpret_cast<const char*>(&value), bytes);
  };
  for (const auto& [name, body] : files) {
    const std::string common = number(20, 2) + number(0, 8) + number(0, 4) +
                               number(body.size(), 4) + number(body.size(), 4) +
                               number(name.size(), 2) + number(0, 2);
    directory += "PK\1\2" + number(20, 2) + common + number(0, 10) + number(local.size(), 4) + name;
    local += "PK\3\4" + common + name + body;
  }
  return local + directory + "PK\5\6" + number(0, 4) + number(files.size(), 2) +
         number(files.size(), 2) + number(directory.size(), 4) + number(local.size(), 4) +
         number(0, 2);
}

TEST_F(ExchangeFormat, NpzMayBeInTheOrderOfColumnsAndOfAnyNumbers) {
  const std::string be_doubles = [] {
    std::string bytes = raw<double>({0, 0, 2, 0, 0, 2});
    for (std::size_t i = 0; i < bytes.size(); i += 8) std::reverse(&bytes[i], &bytes[i] + 8);
    return bytes;
  }();
  const std::vector<std::string> points = {
      npy("<f8", true, "3, 2", raw<double>({0, 2, 0, 0, 0, 2})),
      npy("<f4", true, "3, 2", raw<float>({0, 2, 0, 0, 0, 2})),
      npy("<f4", false, "3, 3", raw<float>({0, 0, 9, 2, 0, 9, 0, 2, 9})),
      npy("<f4", true, "3, 3", raw<float>({0, 2, 0, 0, 0, 2, 9, 9, 9})),
      npy("<i8", true, "3, 2", raw<std::int64_t>({0, 2, 0, 0, 0, 2})),
      npy("|i1", false, "3, 2", raw<std::int8_t>({0, 0, 2, 0, 0, 2})),
      npy("<u2", false, "3, 2", raw<std::uint16_t>({0, 0, 2, 0, 0, 2})),
      npy(">f8", false, "3, 2", be_doubles)};
  const std::vector<std::string> triangles = {
      npy("<i8", true, "1, 3", raw<std::int64_t>({0, 1, 2})),
      npy("<i2", false, "1, 3", raw<std::int16_t>({0, 1, 2})),
      npy("|u1", true, "1, 3", raw<std::uint8_t>({0, 1, 2}))};
  for (const std::string& of_points : points)
    for (const std::string& of_triangles : triangles) {
      const auto mesh = read_mesh(folder_.write(
          "m.npz", archive({{"points.npy", of_points},
                            {"triangles.npy", of_triangles},
                            {"regions.npy", npy("<i8", true, "1,", raw<std::int64_t>({4}))}})));
      ASSERT_TRUE(mesh) << mesh.error().message;
      EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 2, 0, 0, 2}));
      EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
      EXPECT_EQ(mesh->regions, std::vector<std::int32_t>{4});
    }
  EXPECT_EQ(
      refusal("m.npz",
              archive({{"points.npy", points[0]},
                       {"triangles.npy", npy("<f8", false, "1, 3", raw<double>({0, 1, 2}))}})),
      "m.npz: array 'triangles' has the type '<f8', which does not fit");
  EXPECT_EQ(refusal("m.npz", archive({{"points.npy", npy("<c16", false, "3, 2", "")}})),
            "m.npz: array 'points' has the type '<c16', which is not read");
}

TEST_F(ExchangeFormat, TheBedComesBackFromWhereItIsWritten) {
  Mesh mesh = square_mesh(1);
  const std::vector<double> depths = {1, 2, 3, 4.5};
  const VertexValues bed{"depth", depths};
  MeshView view = mesh.view();
  view.vertex_values = {&bed, 1};
  for (const char* name : {"m.nc", "m.2dm", "m.14", "m.slf"}) {
    std::vector<OutputFile> files;
    files.push_back(OutputFile::create(folder_ / name, {}).value());
    write_mesh(*mesh_format(name), view, files);
    ASSERT_TRUE(commit(files));
    const auto back = read_mesh_with_arrays(folder_ / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->mesh.coordinates, mesh.coordinates) << name;
    EXPECT_EQ(back->mesh.triangles, mesh.triangles) << name;
    ASSERT_EQ(back->arrays.size(), 1u) << name;
    ASSERT_TRUE(back->arrays[0].values) << name;
    std::vector<double> found = *back->arrays[0].values;
    if (back->arrays[0].name == "elevation")
      for (double& value : found) value = -value;
    EXPECT_EQ(found, depths) << name;
  }
  EXPECT_EQ(read_mesh_with_arrays(folder_ / "m.2dm")->arrays[0].name, "elevation");
}

TEST_F(ExchangeFormat, SelafinThatIsDamagedIsRefused) {
  ASSERT_TRUE(write_files(square_mesh(1).view(), folder_ / "whole.slf"));
  const std::string whole = contents_of(folder_ / "whole.slf");
  ASSERT_TRUE(read_mesh(folder_ / "whole.slf"));
  EXPECT_EQ(refusal("m.slf", "what is this"),
            "m.slf: is not in TELEMAC's format: it does not begin with a title");
  EXPECT_EQ(refusal("m.slf", whole.substr(0, 200)),
            "m.slf: ends inside the counts of elements and points");
  std::string odd = whole;
  odd[84] = '\1';  // the length behind the title
  EXPECT_EQ(refusal("m.slf", odd), "m.slf: is damaged at the title");
}

TEST_F(ExchangeFormat, AdcircSaysWhichOfItsBoundariesAreOpen) {
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(folder_ / "fort.14", {}).value());
  write_mesh(*mesh_format("fort.14"), square_mesh(1).view(), files, {.open_boundaries = {2, 3}});
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(read_mesh(folder_ / "fort.14")->open_markers, (std::vector<std::int32_t>{2, 3}));
}

}  // namespace
}  // namespace weft::files
