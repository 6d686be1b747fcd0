// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_request.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

TEST(RasterOfARequest, IsTheOneThatItsSizeNames) {
  const TempFolder folder;
  const auto file = folder.write("G.ASC",
                                 "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\n"
                                 "NODATA_value -9999\n4 5 6\n1 2 3\n");
  const auto request_options = with_size({.size = file.string()}, square_domain(4));
  ASSERT_TRUE(request_options) << request_options.error().message;
  const auto request = make_request(square_domain(4), *request_options);
  const v1::Raster& raster = request.size().raster();
  EXPECT_EQ(raster.x(), 11);
  EXPECT_EQ(raster.columns(), 3u);
  EXPECT_EQ(raster.rows(), 2u);
  EXPECT_EQ((std::vector<double>{raster.values().begin(), raster.values().end()}),
            (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

}  // namespace
}  // namespace weft::client
