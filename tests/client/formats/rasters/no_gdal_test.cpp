// SPDX-License-Identifier: Apache-2.0
// What a weft that was built without GDAL says.
#include <gtest/gtest.h>

#include "client/formats/rasters/raster_source.h"

namespace weft::client {
namespace {

TEST(NoGdal, IsNamedInTheError) {
  const auto source = open_with_gdal("gebco.tif", "");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(source.error().message,
            "gebco.tif: this weft was built without GDAL; of rasters it reads .asc alone");
}

}  // namespace
}  // namespace weft::client
