// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_request.h"

#include <gtest/gtest.h>

#include <vector>

#include "client/call/request_rows.h"
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

TEST(SnapOfARequest, IsThatOfTheDomainUnlessItIsAskedFor) {
  Domain domain = square_domain(1);
  EXPECT_EQ(make_request(domain, {}).domain().snap(), 0);
  domain.snap = 0.5;
  EXPECT_EQ(make_request(domain, {}).domain().snap(), 0.5);
  RequestOptions options;
  options.asked.mutable_domain()->set_snap(0.25);
  EXPECT_EQ(make_request(domain, options).domain().snap(), 0.25);
}

TEST(LayersOfARequest, HaveTheNumbersOfTheirMarkers) {
  Domain domain = square_domain(1);
  domain.names.markers = {{3, "wall"}};
  RequestOptions given;
  ASSERT_EQ(marker_value("layers").read({"wall:first=1,rows=2", "-4:first=2,rows=3"}, "", given),
            "");
  const auto options = with_size(given, domain);
  ASSERT_TRUE(options) << options.error().message;
  const auto request = make_request(domain, *options);
  ASSERT_EQ(request.quality().layers_size(), 2);
  EXPECT_EQ(request.quality().layers(0).marker(), 3);
  EXPECT_EQ(request.quality().layers(1).marker(), -4);
  EXPECT_EQ(request.quality().layers(1).rows(), 3u);
  ASSERT_EQ(marker_value("layers").read({"wal:first=1,rows=2"}, "", given), "");
  given.given = {"layers"};
  EXPECT_EQ(with_size(given, domain).error().message,
            "--layers wal: no marker of the domain is named 'wal': did you mean `wall`?");
}

}  // namespace
}  // namespace weft::client
