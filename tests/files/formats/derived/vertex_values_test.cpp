// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/vertex_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "files/formats/mesh_formats.h"
#include "tests/files/support/temp_folder.h"
#include "tests/files/support/zip_writer.h"

namespace weft::files {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using testing::NanSensitiveDoubleEq;

const double kNan = std::nan("");

// "h" is 1, 2.5 and nan at the corners of a triangle; "flow" has two components; "cells" is of
// cells.
constexpr char kVtu[] = R"(<?xml version="1.0"?>
<VTKFile type='UnstructuredGrid' version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="h" format="ascii">1 2.5 nan</DataArray>
<DataArray type="Float64" Name="flow" NumberOfComponents="2" format="ascii">1 2 3 4 5 6</DataArray>
<DataArray type="Float32" Name="region" format="ascii">7.5 7.5 7.5</DataArray></PointData>
<CellData><DataArray type="Float64" Name="cells" format="ascii">3</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0
 0 1e0 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

// The step 0 of "h" is 9 everywhere, the step 1 has no value at the node 40.
constexpr char kMsh[] = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
3
10 0 0 0
40 0 1 0
20 1 0 0
$EndNodes
$Elements
1
1 2 2 0 1 10 20 40
$EndElements
$NodeData
1
"h"
1
0.0
3
0
1
3
10 9
20 9
40 9
$EndNodeData
$NodeData
2
"h"
"by a solver"
1
0.5
4
1
1
2
0
20 2.5
10 1
$EndNodeData
)";

class VertexValuesOf : public ::testing::Test {
 protected:
  Result<MeshWithValues> read(const std::string& name, const std::string& text,
                              const std::string& array) const {
    return read_vertex_values(folder_.write(name, text), array);
  }
  // What is said of a file that must be refused, less its name.
  std::string refusal(const std::string& name, const std::string& text,
                      const std::string& array) const {
    const auto values = read(name, text, array);
    if (values) return "it was read";
    EXPECT_EQ(values.error().exit, ExitCode::kUnreadableInput);
    return values.error().message.substr((folder_ / name).string().size() + 2);
  }
  static std::string with(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  }
  TempFolder folder_;
};

TEST_F(VertexValuesOf, VtuAreItsPointData) {
  const auto h = read("m.vtu", kVtu, "h");
  ASSERT_TRUE(h) << h.error().message;
  EXPECT_THAT(h->values, ElementsAre(1, 2.5, NanSensitiveDoubleEq(kNan)));
  EXPECT_THAT(h->mesh.coordinates, ElementsAre(0, 0, 1, 0, 0, 1));
  EXPECT_THAT(h->mesh.triangles, ElementsAre(0, 1, 2));
}

TEST_F(VertexValuesOf, VtuAreApartFromItsCellDataOfTheSameName) {
  const auto region = read("m.vtu", kVtu, "region");
  ASSERT_TRUE(region) << region.error().message;
  EXPECT_THAT(region->values, ElementsAre(7.5, 7.5, 7.5));
  EXPECT_THAT(region->mesh.regions, ElementsAre(0));
}

TEST_F(VertexValuesOf, MshAreItsLastNodeDataAndNanIfANodeHasNone) {
  const auto h = read("m.msh", kMsh, "");
  ASSERT_TRUE(h) << h.error().message;
  EXPECT_THAT(h->values, ElementsAre(1, 2.5, NanSensitiveDoubleEq(kNan)));
  EXPECT_THAT(h->mesh.triangles, ElementsAre(0, 1, 2));
}

TEST_F(VertexValuesOf, AdcircAreItsDepths) {
  const auto depth =
      read("fort.14", "title\n1 3\n1 0 0 5\n2 1 0 -2.5\n3 0 1 40\n1 3 1 2 3\n0\n0\n0\n0\n", "");
  ASSERT_TRUE(depth) << depth.error().message;
  EXPECT_THAT(depth->values, ElementsAre(5, -2.5, 40));
}

TEST_F(VertexValuesOf, AreListedIfOneIsMissing) {
  EXPECT_EQ(refusal("m.vtu", kVtu, "flwo"),
            "has no array 'flwo' of values at its vertices, but 'flow', 'h' and 'region'; did you "
            "mean `flow`?");
  EXPECT_EQ(refusal("m.vtu", kVtu, "cells"),
            "has no array 'cells' of values at its vertices, but 'flow', 'h' and 'region'");
  EXPECT_EQ(refusal("m.vtu", kVtu, ""),
            "has several arrays of values at its vertices, name one: 'flow', 'h' and 'region'");
  EXPECT_EQ(refusal("m.msh", with(kMsh, "\"h\"", "\"u\""), "w"),
            "has no array 'w' of values at its vertices, but 'h' and 'u'");
  EXPECT_EQ(refusal("m.14", "title\n", "h"),
            "has no array 'h' of values at its vertices, but 'depth'");
}

TEST_F(VertexValuesOf, AreOneFiniteNumberPerVertexOrRefused) {
  EXPECT_EQ(refusal("m.vtu", kVtu, "flow"), "the array 'flow' has 6 values, it should have 3");
  EXPECT_EQ(refusal("m.vtu", with(kVtu, "2.5 nan", "2.5 -inf"), "h"),
            "the array 'h' is infinite at vertex 2");
  EXPECT_EQ(refusal("m.vtu", with(kVtu, ">5<", ">1<"), "h"), "cell 0 has a wrong offset");
  EXPECT_THAT(refusal("m.msh", with(kMsh, "20 2.5", "21 2.5"), ""),
              EndsWith("node data names the node 21, which is missing"));
  EXPECT_THAT(refusal("m.msh", with(kMsh, "4\n1\n1\n2\n", "4\n1\n3\n2\n"), ""),
              EndsWith("the node data has 3 components, only one is read"));
  EXPECT_THAT(refusal("m.msh", with(kMsh, "\n2\n\"h\"", "\n0\n\"h\""), ""),
              EndsWith("the name of node data is not in quotes"));
  EXPECT_EQ(refusal("m.14", "title\n0 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n0\n0\n0\n0\n", ""),
            "has no triangles");
}

TEST_F(VertexValuesOf, AreAnErrorOfUseIfTheFormatHasNone) {
  const auto values = read_vertex_values("m.obj", "");
  ASSERT_FALSE(values);
  EXPECT_EQ(values.error().exit, ExitCode::kUsage);
  EXPECT_EQ(values.error().message,
            "m.obj: the extension '.obj' is not that of a mesh with values at its vertices: .vtu, "
            ".msh, .14, .grd, .gr3, .2dm, .nc, .slf, .npz");
}

std::string npz(std::vector<std::pair<std::string, std::string>> arrays) {
  for (auto& [name, data] : arrays) name += ".npy";
  return zip_of(arrays);
}

template <class T>
std::string npy(const std::string& type, const std::string& shape, const std::vector<T>& values) {
  const std::string head =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  std::string out = std::string("\x93NUMPY\1\0", 8) + static_cast<char>(head.size()) + '\0' + head;
  return out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

TEST_F(VertexValuesOf, NpzAreItsOtherArrays) {
  const std::pair<std::string, std::string> points = {
      "points", npy<double>("<f8", "3, 2", {0, 0, 1, 0, 0, 1})};
  const std::pair<std::string, std::string> triangles = {
      "triangles", npy<std::uint32_t>("<u4", "1, 3", {0, 1, 2})};
  const auto h = npy<double>("<f8", "3,", {1, 2.5, kNan});
  const auto single = npy<float>("<f4", "3,", {1, 2, 3});
  const auto two = npy<double>("<f8", "2,", {1, 2});
  const std::string file = npz({points, {"h", h}, triangles, {"single", single}, {"two", two}});
  const auto values = read("m.npz", file, "h");
  ASSERT_TRUE(values) << values.error().message;
  EXPECT_THAT(values->values, ElementsAre(1, 2.5, NanSensitiveDoubleEq(kNan)));
  EXPECT_THAT(values->mesh.triangles, ElementsAre(0, 1, 2));
  EXPECT_THAT(read("m.npz", file, "single")->values, ElementsAre(1, 2, 3));
  EXPECT_EQ(refusal("m.npz", file, "two"), "the array 'two' has 2 values for 3 vertices");
  EXPECT_EQ(refusal("m.npz", file, "points"),
            "has no array 'points' of values at its vertices, but 'h', 'single' and 'two'");
  EXPECT_EQ(refusal("m.npz", npz({points, triangles}), ""), "has no values at its vertices");
}

// Whatever becomes of the file: an error, or one number for each vertex.
TEST_F(VertexValuesOf, AreRefusedOrSoundOnceDamaged) {
  std::mt19937 random(7);
  const std::string archive = npz({{"points", npy<double>("<f8", "3, 2", {0, 0, 1, 0, 0, 1})},
                                   {"triangles", npy<std::uint32_t>("<u4", "1, 3", {0, 1, 2})},
                                   {"h", npy<double>("<f8", "3,", {1, 2, 3})}});
  int refused = 0;
  for (const auto& [name, whole] :
       {std::pair<std::string, std::string>("m.vtu", kVtu), {"m.msh", kMsh}, {"m.npz", archive}}) {
    for (int round = 0; round < 600; ++round) {
      std::string text = whole;
      const std::size_t at = random() % text.size();
      if (round % 3 == 0) text.resize(at);
      if (round % 3 == 1) text[at] = static_cast<char>(random());
      if (round % 3 == 2) text.replace(at, 1, "99999999999");
      const auto values = read(name, text, "h");
      refused += !values;
      if (!values) continue;
      EXPECT_EQ(values->values.size(), values->mesh.coordinates.size() / 2);
      for (const double value : values->values) EXPECT_FALSE(std::isinf(value));
    }
  }
  EXPECT_GT(refused, 600);
}

}  // namespace
}  // namespace weft::files
