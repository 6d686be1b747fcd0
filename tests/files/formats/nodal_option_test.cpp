// SPDX-License-Identifier: Apache-2.0
// That programs of others find the values in files is for read_back.py to say.
#include "files/formats/nodal_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "files/formats/bed.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh_formats.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Texts = std::vector<std::string>;

std::string fault_of(const Texts& texts) {
  std::vector<NodalOption> options;
  for (const std::string& text : texts)
    if (auto fault = add_nodal(text, "", options); !fault.empty()) return fault;
  return "";
}

TEST(NodalOption, IsANameAndItsSourcesInOrder) {
  const TempFolder folder;
  folder.write("a.tif", "");
  std::vector<NodalOption> options;
  for (const char* text : {"depth=a.tif:2", "manning=0.02", "depth=/b.asc", "depth=-5"})
    EXPECT_EQ(add_nodal(text, folder.path(), options), "");
  const NodalOption depth{"depth",
                          {RasterPath{folder / "a.tif", "2"}, RasterPath{"/b.asc", ""}, -5.0}};
  EXPECT_EQ(options, (std::vector<NodalOption>{depth, {"manning", {0.02}}}));
}

TEST(NodalOption, HasANameThatEveryFormatTakes) {
  for (const char* text : {"", "depth", "=a.tif", "depth=", "1st=2", "a b=2", "a\"=2",
                           "seventeen_letters=2", "\xc3\xa4=1"})
    EXPECT_NE(fault_of({text}), "") << text;
  EXPECT_EQ(fault_of({"sixteen_letters_=2"}), "");
  EXPECT_EQ(fault_of({"points=2"}),
            "'points' is the name of something else in the files; choose another");
  EXPECT_EQ(fault_of({"BOTTOM=2"}),
            "'BOTTOM' is the name of something else in the files; choose another");
  EXPECT_EQ(fault_of({"Depth=2"}), "'Depth' is not the bed, which is called depth");
}

TEST(NodalOption, IsTheBedOnce) {
  EXPECT_EQ(fault_of({"depth=1", "elevation=2"}),
            "depth and elevation are the same values, positive down and positive up: give one");
}

// The raster has cells of 2 by 2 around (0, 0), (2, 0), (0, 2), ...: x + 10 y, and one without a
// value.
class NodalValues : public ::testing::Test {
 protected:
  Result<SampledValues> sample(std::vector<double> coordinates, const Texts& texts) {
    std::vector<NodalOption> options;
    for (const std::string& text : texts) EXPECT_EQ(add_nodal(text, folder_.path(), options), "");
    mesh_.coordinates = std::move(coordinates);
    return sample_nodal(options.at(0), mesh_.view(), {}, mesh_.coordinates);
  }
  std::vector<double> values(std::vector<double> coordinates, const Texts& texts) {
    const auto sampled = sample(std::move(coordinates), texts);
    if (!sampled) {
      ADD_FAILURE() << sampled.error().message;
      return {};
    }
    const auto all = sampled->values.values();
    return {all.begin(), all.end()};
  }

  TempFolder folder_;
  Mesh mesh_;
  const std::string raster_ = "h=" + folder_
                                         .write("r.asc",
                                                "ncols 4\nnrows 3\nxllcorner -1\n"
                                                "yllcorner -1\ncellsize 2\nnodata_value -9\n"
                                                "40 42 44 46\n20 22 24 26\n0 2 4 -9\n")
                                         .string();
};

TEST_F(NodalValues, AreBilinearBetweenTheCentresOfCells) {
  EXPECT_THAT(values({0, 0, 1, 0, 0.5, 1.5, 2, 4}, {raster_}), ElementsAre(0, 1, 15.5, 42));
}

TEST_F(NodalValues, AreThoseOfTheNextCentreInTheOuterHalfOfACell) {
  EXPECT_THAT(values({-1, -1, -1, 2, 7, 5}, {raster_}), ElementsAre(0, 20, 46));
}

TEST_F(NodalValues, AreOfTheFirstSourceThatHasOne) {
  EXPECT_THAT(values({0, 0, 5, 0, 9, 0, 5, 3}, {raster_, "h=-1"}), ElementsAre(0, -1, -1, 35));
}

TEST_F(NodalValues, AreRefusedIfAVertexHasNone) {
  const auto sampled = sample({0, 0, 5, 0, 9, 0}, {raster_});
  ASSERT_FALSE(sampled);
  EXPECT_EQ(sampled.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(
      sampled.error().message,
      "h has no value at vertex 1, (5, 0), and at 1 more; --nodal h=NUMBER, after the others, "
      "is the value where they have none");
}

TEST_F(NodalValues, OfADepthAreWarnedOfIfMostAreNegative) {
  const auto sampled = sample({0, 0, 1, 1}, {"depth=-3"});
  ASSERT_TRUE(sampled);
  EXPECT_THAT(sampled->warnings, ElementsAre(HasSubstr("depth is negative at 2 of 2 vertices")));
  EXPECT_TRUE(sample({0, 0, 1, 1}, {"elevation=-3"})->warnings.empty());
}

TEST(WrittenValues, ComeBackFromEveryFormatThatIsRead) {
  const Mesh mesh = square_mesh(3);
  std::vector<double> depths;
  for (std::size_t i = 0; i < mesh.view().vertex_count(); ++i) depths.push_back(0.1 * i - 1);
  const VertexValues depth[] = {{"depth", depths}};
  MeshView view = mesh.view();
  view.vertex_values = depth;
  TempFolder folder;
  for (const char* name : {"m.vtu", "m.msh", "m.npz", "m.14"}) {
    ASSERT_TRUE(write_files(view, folder / name));
    const auto back = read_vertex_values(folder / name, "depth");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->values, depths) << name;
  }
}

TEST(WrittenValues, OfTheBedTurnTheirSign) {
  const std::vector<double> elevations{-2, 0, 3};
  const VertexValues values[] = {{"elevation", elevations}};
  MeshView mesh;
  mesh.vertex_values = values;
  const Bed bed(mesh);
  EXPECT_EQ(bed.depth(0), 2);
  EXPECT_FALSE(std::signbit(bed.depth(1)));
  EXPECT_EQ(bed.elevation(2), 3);
  EXPECT_FALSE(Bed(MeshView{}).is_known());
}

TEST(WrittenValues, ThatAFormatDoesNotCarryAreNamed) {
  const std::vector<double> numbers{1};
  const VertexValues values[] = {{"depth", numbers}, {"manning", numbers}};
  const std::vector<std::int32_t> parts{0};
  MeshView mesh;
  mesh.vertex_values = values;
  EXPECT_THAT(not_carried("m.vtu", mesh), ElementsAre());
  EXPECT_THAT(not_carried("m.14", mesh),
              ElementsAre("m.14: the format does not carry these values at vertices: manning"));
  mesh.parts = parts;
  EXPECT_THAT(not_carried("m.vtu", mesh), ElementsAre());
  EXPECT_THAT(
      not_carried("m.su2", mesh),
      ElementsAre("m.su2: the format does not carry these values at vertices: depth, manning",
                  "m.su2: the format does not carry the parts of the triangles"));
}

}  // namespace
}  // namespace weft::files
