// SPDX-License-Identifier: Apache-2.0
#include "files/formats/raster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

using testing::ElementsAre;
using testing::IsNan;

constexpr char kGrid[] =
    "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\nNODATA_value -9999\n"
    "4 5 6\n1 2 3\n";

class RasterFile : public ::testing::Test {
 protected:
  Result<Raster> read(std::string_view text) { return read_raster(folder_.write("g.asc", text)); }
  // What is said of a text that must be refused, less the folder.
  std::string refusal(std::string_view text) {
    const auto grid = read(text);
    if (grid) return "it was read";
    EXPECT_EQ(grid.error().exit, ExitCode::kUnreadableInput);
    return grid.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

TEST_F(RasterFile, HasItsValuesAtTheCentresOfCellsFromTheSouth) {
  const auto grid = read(kGrid);
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->x, 11);
  EXPECT_EQ(grid->y, 21);
  EXPECT_EQ(grid->dx, 2);
  EXPECT_EQ(grid->dy, 2);
  EXPECT_EQ(grid->columns, 3u);
  EXPECT_EQ(grid->rows, 2u);
  EXPECT_EQ(grid->values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST_F(RasterFile, MayNameTheCentreAndBothSizesInCapitals) {
  const auto grid =
      read("NCOLS 2\r\nNROWS 1\r\nXLLCENTER -1.5\r\nYLLCENTER 4\r\nDX 0.5\r\nDY 3\r\n7\r\n8\r\n");
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->x, -1.5);
  EXPECT_EQ(grid->y, 4);
  EXPECT_EQ(grid->dx, 0.5);
  EXPECT_EQ(grid->dy, 3);
  EXPECT_EQ(grid->values, (std::vector<double>{7, 8}));
}

TEST_F(RasterFile, IsRefusedWhereACellHasNoPositiveValue) {
  const std::string header =
      "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  EXPECT_EQ(refusal(header + "1 -9999\n"),
            "g.asc:7:3: a cell without a value, but a size needs one in every cell");
  EXPECT_EQ(refusal(header + "0 1\n"), "g.asc:7:1: the bound on the area is not positive");
  EXPECT_EQ(refusal(header + "nan 1\n").substr(0, 8), "g.asc:7:");
}

TEST_F(RasterFile, IsRefusedWhereItsHeaderOrItsLengthIsWrong) {
  EXPECT_NE(refusal("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\n1 2\n").find("no cellsize"),
            std::string::npos);
  EXPECT_NE(refusal("ncols 0\n").find("ncols is 0"), std::string::npos);
  EXPECT_NE(refusal("ncols 268435456\nnrows 268435456\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n")
                .find("ncols times nrows"),
            std::string::npos);
  EXPECT_NE(refusal("ncols 16384\nnrows 16384\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n")
                .find("fewer values"),
            std::string::npos);
  EXPECT_NE(refusal("columns 2\n").find("'columns'"), std::string::npos);
  EXPECT_NE(refusal(std::string(kGrid) + "7\n").find("more values"), std::string::npos);
  EXPECT_NE(refusal("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n")
                .find("the file ends where a value"),
            std::string::npos);
}

TEST_F(RasterFile, IsReadBackAsItWasWritten) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double dy : {0.1, 3.0}) {
    const Raster written{-1.5, 1e6 + 0.1, 0.1, dy, 3, 2, {1, kNan, 1.0 / 3, 4e9, kInfinity, 6}};
    const auto name = folder_.path() / "w.asc";
    std::vector<OutputFile> files;
    files.push_back(*OutputFile::create(name, {}));
    write_raster(written, files.back());
    ASSERT_TRUE(commit(files));
    const auto grid = read_raster(name, RasterValues::kAny);
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_EQ(
        std::tie(grid->x, grid->y, grid->dx, grid->dy, grid->columns, grid->rows),
        std::tie(written.x, written.y, written.dx, written.dy, written.columns, written.rows));
    EXPECT_THAT(grid->values, ElementsAre(1, IsNan(), 1.0 / 3, 4e9, IsNan(), 6));
  }
}

}  // namespace
}  // namespace weft::files
