// SPDX-License-Identifier: Apache-2.0
// What a weft that was built without GDAL says.
#include <gtest/gtest.h>

#include "files/formats/domains/ogr.h"
#include "files/formats/rasters/raster_source.h"

namespace weft::files {
namespace {

TEST(NoGdal, IsNamedInTheError) {
  const auto source = open_with_gdal("gebco.tif", "");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(source.error().message,
            "gebco.tif: this weft was built without GDAL; of rasters it reads .asc alone");
}

TEST(NoGdal, IsNamedInTheErrorOfADomain) {
  const auto domain = read_with_ogr(*domain_format("coast.gpkg"), "coast.gpkg", {});
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(domain.error().message,
            "coast.gpkg: this weft was built without GDAL, which reads such files");
}

TEST(NoGdal, ComparesCoordinateSystemsByTheirText) {
  const CoordinateSystem utm{"UTM", false, "EPSG:32618"};
  EXPECT_TRUE(are_same(utm, {"zone 18", false, "EPSG:32618"}));
  EXPECT_FALSE(are_same(utm, {"UTM", false, "EPSG:32619"}));
  EXPECT_TRUE(are_same({"WGS 84", true, "a"}, {"NAD27", true, "b"}));
}

}  // namespace
}  // namespace weft::files
