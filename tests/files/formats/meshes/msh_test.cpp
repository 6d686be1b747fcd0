// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/msh.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <set>
#include <tuple>

#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

constexpr char kAscii[] = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Comments
hello
$EndComments
$PhysicalNames
2
1 4 "marker -3"
2 9 "steel"
$EndPhysicalNames
$Entities
1 1 1 0
1 0 0 0 0
1 0 0 0 1 0 0 1 4 0
1 0 0 0 1 1 0 1 9 1 1
$EndEntities
$Nodes
1 3 10 40
2 1 0 3
10
40
20
0 0 0
0 1 0
1 0 0
$EndNodes
$Elements
3 3 1 3
0 1 15 1
1 10
1 1 1 1
2 10 20
2 1 2 1
3 10 20 40
$EndElements
)";

class Msh : public ::testing::Test {
 protected:
  // What is said of a file that must be refused, less its name.
  std::string refusal(std::string text) {
    const auto mesh = read_msh(folder_.write("m.msh", text));
    if (mesh) return "it was read";
    EXPECT_EQ(mesh.error().exit, ExitCode::kUnreadableInput);
    return mesh.error().message.substr((folder_ / "m.msh: ").string().size());
  }
  std::string ascii_with(const std::string& from, const std::string& to) {
    std::string text = kAscii;
    text.replace(text.find(from), from.size(), to);
    return text;
  }
  TempFolder folder_;
};

// Triangles with their regions, edges with their markers, in no order.
auto elements(const Mesh& mesh) {
  std::multiset<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::int32_t>> all;
  for (std::size_t t = 0; t < mesh.regions.size(); ++t)
    all.emplace(mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2],
                mesh.regions[t]);
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e)
    all.emplace(mesh.edges[2 * e], mesh.edges[2 * e + 1], std::numeric_limits<std::uint32_t>::max(),
                mesh.edge_markers[e]);
  return all;
}

TEST_F(Msh, ComesBackWithAllVerticesAndElements) {
  const Mesh mesh = square_mesh(30);
  const auto back = round_trip(mesh, "m.msh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->coordinates, mesh.coordinates);
  EXPECT_EQ(elements(*back), elements(mesh));
}

TEST_F(Msh, KeepsIdsThatAreNoTagsOfGmsh) {
  Mesh mesh = square_mesh(4);
  mesh.edge_markers.front() = std::numeric_limits<std::int32_t>::min();
  mesh.edge_markers.back() = std::numeric_limits<std::int32_t>::max();
  mesh.regions.front() = -1;
  mesh.regions.back() = 1;
  const auto back = round_trip(mesh, "m.msh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(elements(*back), elements(mesh));
}

TEST_F(Msh, ComesBackEmpty) {
  const auto back = round_trip(Mesh{}, "m.msh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, Mesh{});
}

TEST_F(Msh, ReadsAsciiByOthers) {
  const auto mesh = read_msh(folder_.write("m.msh", kAscii));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->regions, std::vector<std::int32_t>{9});
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(mesh->edge_markers, std::vector<std::int32_t>{-3});
}

TEST_F(Msh, RefusesWhatItCannotRead) {
  const auto says = [this](const std::string& text, const std::string& why) {
    const std::string refused = refusal(text);
    EXPECT_TRUE(refused.ends_with(": " + why)) << refused;
  };
  says("hello", "is not a Gmsh mesh: it does not start with $MeshFormat");
  says("", "is empty");
  says(ascii_with("4.1 0 8", "3 0 8"), "has the version 3, only 4.1 and 2.2 are read");
  says(ascii_with("1 10\n", "1 11\n"), "an element names the node 11, which is missing");
  says(ascii_with("2 1 2 1\n", "2 1 16 1\n"),
       "has elements of type 16, which are no triangles, quadrilaterals, lines or points");
  says(ascii_with("10\n40\n", "10\n10\n"), "has two nodes with the tag 10");
  says(ascii_with("1 3 10 40", "1 99999999 10 40"),
       "announces 99999999 items, more than the file can hold");
  says(ascii_with("$EndElements", ""), "expected $EndElements, found ''");
  says(ascii_with("$EndComments", ""), "a section does not end with $EndComments");
}

TEST_F(Msh, RefusesABinaryFileThatIsCutShort) {
  ASSERT_TRUE(write_files(square_mesh(3).view(), folder_ / "whole.msh"));
  const std::string whole = contents_of(folder_ / "whole.msh");
  EXPECT_NE(refusal(whole.substr(0, whole.size() - 60)).find("the file ends inside a section"),
            std::string::npos);
}

constexpr char kTwice[] = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
0 30 "tip"
1 7 "wall"
1 9 "inlet"
2 1 "all"
2 3 "left"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 2 0 0
3 2 2 0
4 0 2 0
$EndNodes
$Elements
8
1 1 2 7 1 1 2
2 1 2 9 1 2 1
3 1 2 9 1 2 3
4 2 2 1 1 1 2 3
5 2 2 1 1 1 3 4
6 2 2 3 1 2 3 1
7 2 2 3 1 1 3 4
8 15 2 30 1 1
$EndElements
)";

TEST_F(Msh, GivesAnElementOfSeveralGroupsTheFirst) {
  const std::filesystem::path path = folder_.write("m.msh", kTwice);
  const auto mesh = read_msh(path);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{7, 9}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(
      sentences(mesh->warnings),
      (std::vector<std::string>{
          path.string() + ": 1 edge of the physical curve 9 'inlet' is in the physical curve "
                          "7 'wall', too; the first group counts",
          path.string() + ": 2 faces of the physical surface 3 'left' are in the physical "
                          "surface 1 'all', too; the first group counts, so nothing carries "
                          "this one",
          path.string() + ": the physical point 30 'tip' is left out: vertices carry no markers"}));
}

TEST_F(Msh, GivesAnEntityOfSeveralGroupsTheFirst) {
  const auto mesh = read_msh(
      folder_.write("m.msh", ascii_with("1 0 0 0 1 0 0 1 4 0\n1 0 0 0 1 1 0 1 9 1 1",
                                        "1 0 0 0 1 0 0 2 4 5 0\n1 0 0 0 1 1 0 3 9 8 7 1 1")));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->edge_markers, std::vector<std::int32_t>{-3});
  EXPECT_EQ(mesh->regions, std::vector<std::int32_t>{9});
  EXPECT_EQ(mesh->warnings.size(), 3u);
}

}  // namespace
}  // namespace weft::files
