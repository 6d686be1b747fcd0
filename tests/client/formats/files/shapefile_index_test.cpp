// SPDX-License-Identifier: Apache-2.0
#include "client/formats/files/shapefile_index.h"

#include <gtest/gtest.h>

#include "client/formats/files/file_contents.h"
#include "tests/client/support/shapefile_writer.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

TEST(ShapefileIndex, IsThatWhichShapelibWrites) {
  TempFolder folder;
  write_sample_shapefile(folder / "d");
  const auto shp = read_file(folder / "d.shp", 1 << 20);
  const auto shx = read_file(folder / "d.shx", 1 << 20);
  ASSERT_TRUE(shp && shx);
  EXPECT_EQ(index_of_shapes(shp->text()), shx->text());
}

TEST(ShapefileIndex, EndsWhereTheFileEndsAndIsEmptyOfOtherFiles) {
  TempFolder folder;
  write_sample_shapefile(folder / "d");
  const auto shp = read_file(folder / "d.shp", 1 << 20);
  ASSERT_TRUE(shp);
  EXPECT_EQ(index_of_shapes(shp->text().substr(0, shp->text().size() - 1)).size(), 100U + 8U);
  EXPECT_EQ(index_of_shapes(shp->text().substr(0, 100)).size(), 100U);
  EXPECT_EQ(index_of_shapes(shp->text().substr(0, 99)), "");
  EXPECT_EQ(index_of_shapes(std::string(200, 'x')), "");
}

}  // namespace
}  // namespace weft::client
