// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/shapefile_index.h"

#include <gtest/gtest.h>

#include "files/bytes/file_contents.h"
#include "tests/files/support/shapefile_writer.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
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
}  // namespace weft::files
