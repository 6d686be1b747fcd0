// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/vtu.h"

#include <gtest/gtest.h>

#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
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
  EXPECT_EQ(refusal(ascii_with("1 5 3<", "1 9 3<")), "cell 1 has a wrong offset");
  EXPECT_EQ(refusal(ascii_with("1 5 3<", "1 10 3<")),
            "cell 1 has the type 10, which is no vertex, line, triangle or polygon");
  EXPECT_EQ(refusal(ascii_with("1 5 3<", "1 22 3<")), "cell 1 has a wrong offset");
  EXPECT_EQ(refusal(ascii_with("0 0 1 2 1 2", "0 0 1 2 1 7")), "cell 2 has vertex 7 of 3");
  EXPECT_EQ(refusal(ascii_with("0 0 1 2 1 2", "0 0 1 2 1 -1")),
            "the array 'connectivity' of type 'Int32' holds a value that does not belong there");
  EXPECT_EQ(refusal(ascii_with("1 4 6", "1 3 6")), "cell 1 has a wrong offset");
  EXPECT_EQ(refusal(ascii_with("1 4 6", "1 4")),
            "the array 'offsets' has 2 values, it should have 3");
  EXPECT_EQ(refusal(ascii_with("1e0", "nan")), "vertex 2 has a coordinate that is not finite");
  EXPECT_EQ(refusal(ascii_with("\"types\"", "\"typos\"")), "has no array 'types'");
  EXPECT_EQ(refusal(ascii_with("format=\"ascii\"", "format=\"binary\"")),
            "the array 'Points' is not in base64");
  EXPECT_EQ(refusal(ascii_with("format=\"ascii\"", "format=\"hex\"")),
            "the array 'Points' is in the format 'hex', only ascii, binary and appended are read");
  EXPECT_EQ(refusal("<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkMine\">"),
            "is compressed by 'vtkMine', only vtkZLibDataCompressor, vtkLZ4DataCompressor and "
            "vtkLZMADataCompressor are read");
  EXPECT_EQ(refusal("<VTKFile type=\"PolyData\">"), "is not a VTK unstructured grid");
  EXPECT_EQ(refusal("what is this"), "is not a VTK unstructured grid");
}

// That VTK's files are read in all their encodings: read_others.py.
TEST_F(Vtu, ReadsAnArrayThatIsCompressedInBlocks) {
  const char* const zlib = "AQAAAACAAABIAAAAEgAAAA==eJxjYMAHPtjjlUaSBwA9VgJf";
  std::string text = ascii_with(
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0\n 0 1e0 0",
      std::string("<DataArray type=\"Float64\" format=\"binary\">") + zlib);
  // The other arrays stay text, which no compressor touches.
  text.insert(text.find(" byte_order"), " compressor=\"vtkZLibDataCompressor\"");
  const auto mesh = read_vtu(folder_.write("m.vtu", text));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  text.replace(text.find("AABIAAAA"), 8, "AABJAAAA");
  EXPECT_EQ(refusal(text), "the array 'Points' does not unpack to the size that it claims");
}

TEST_F(Vtu, CutsCellsOfMoreCornersIntoTriangles) {
  std::string text = ascii_with("1 5 3<", "1 9 3<");
  text.replace(text.find("NumberOfPoints=\"3\""), 18, "NumberOfPoints=\"4\"");
  text.replace(text.find("0 1e0 0"), 7, "1 1 0 0 1 0");
  text.replace(text.find("0 0 1 2 1 2"), 11, "0 0 1 2 3 1 2");
  text.replace(text.find("1 4 6"), 5, "1 5 7");
  const auto mesh = read_vtu(folder_.write("m.vtu", text));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 6u);
  EXPECT_EQ(mesh->regions.size(), 2u);
  EXPECT_EQ(mesh->cut_faces, 1u);
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(Vtu, RefusesAFileThatIsCutShort) {
  ASSERT_TRUE(write_files(square_mesh(3).view(), folder_ / "whole.vtu"));
  const std::string whole = contents_of(folder_ / "whole.vtu");
  EXPECT_EQ(refusal(whole.substr(0, whole.size() - 60)),
            "the array 'marker' goes on beyond the end of the file");
}

}  // namespace
}  // namespace weft::files
