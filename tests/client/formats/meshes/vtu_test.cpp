// SPDX-License-Identifier: Apache-2.0
#include "client/formats/meshes/vtu.h"

#include <gtest/gtest.h>

#include "tests/client/support/mesh_files.h"
#include "tests/client/support/sample_mesh.h"

namespace weft::client {
namespace {

constexpr char kAsciiVtu[] = R"(<?xml version="1.0"?>
<VTKFile type='UnstructuredGrid' version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="3">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0
 0 1e0 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 0 1 2 1 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">1 4 6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">1 5 3</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

class Vtu : public ::testing::Test {
 protected:
  // What is said of a file that must be refused, less its name.
  std::string refusal(std::string text) {
    const auto mesh = read_vtu(folder_.write("m.vtu", text));
    if (mesh) return "it was read";
    EXPECT_EQ(mesh.error().exit, ExitCode::kUnreadableInput);
    return mesh.error().message.substr((folder_ / "m.vtu: ").string().size());
  }
  std::string ascii_with(const std::string& from, const std::string& to) {
    std::string text = kAsciiVtu;
    text.replace(text.find(from), from.size(), to);
    return text;
  }
  TempFolder folder_;
};

TEST_F(Vtu, ComesBackAsItWas) {
  const Mesh mesh = square_mesh(30);
  const auto back = round_trip(mesh, "m.vtu");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST_F(Vtu, ComesBackWhenLargerThanABlock) {
  const Mesh mesh = square_mesh(200);
  const auto back = round_trip(mesh, "m.VTU");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, mesh);
}

TEST_F(Vtu, ComesBackEmpty) {
  const auto back = round_trip(Mesh{}, "m.vtu");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, Mesh{});
}

TEST_F(Vtu, ReadsAsciiByOthersAndDropsVertexCells) {
  const auto mesh = read_vtu(folder_.write("m.vtu", kAsciiVtu));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(mesh->regions, std::vector<std::int32_t>{0});
  EXPECT_EQ(mesh->edge_markers, std::vector<std::int32_t>{0});
}

TEST_F(Vtu, RefusesWhatIsNoTriangleMesh) {
  EXPECT_EQ(refusal(ascii_with("1 5 3<", "1 9 3<")),
            "cell 1 has the type 9, which is no vertex, line or triangle");
  EXPECT_EQ(refusal(ascii_with("0 0 1 2 1 2", "0 0 1 2 1 7")), "cell 2 has vertex 7 of 3");
  EXPECT_EQ(refusal(ascii_with("0 0 1 2 1 2", "0 0 1 2 1 -1")),
            "the array 'connectivity' of type 'Int32' holds a value that does not belong there");
  EXPECT_EQ(refusal(ascii_with("1 4 6", "1 3 6")), "cell 1 has a wrong offset");
  EXPECT_EQ(refusal(ascii_with("1 4 6", "1 4")),
            "the array 'offsets' has 2 values, it should have 3");
  EXPECT_EQ(refusal(ascii_with("1e0", "nan")), "vertex 2 has a coordinate that is not finite");
  EXPECT_EQ(refusal(ascii_with("\"types\"", "\"typos\"")), "has no array 'types'");
  EXPECT_EQ(refusal(ascii_with("format=\"ascii\"", "format=\"binary\"")),
            "the array 'Points' is neither ASCII nor appended");
  EXPECT_EQ(refusal("<VTKFile type=\"PolyData\">"), "is not a VTK unstructured grid");
  EXPECT_EQ(refusal("what is this"), "is not a VTK unstructured grid");
}

TEST_F(Vtu, RefusesAFileThatIsCutShort) {
  ASSERT_TRUE(write_files(square_mesh(3).view(), folder_ / "whole.vtu"));
  const std::string whole = contents_of(folder_ / "whole.vtu");
  EXPECT_EQ(refusal(whole.substr(0, whole.size() - 60)),
            "the array 'marker' goes on beyond the end of the file");
}

}  // namespace
}  // namespace weft::client
