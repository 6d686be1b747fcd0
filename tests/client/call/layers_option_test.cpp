// SPDX-License-Identifier: Apache-2.0
#include "client/call/layers_option.h"

#include <gtest/gtest.h>

#include "client/call/request_rows.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

TEST(LayersOption, IsReadFromText) {
  const auto full = LayersOption::parse("wall:region=-3,rows=20,ratio=1.2,first=1e-5");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->marker, "wall");
  EXPECT_EQ(full->rows.first(), 1e-5);
  EXPECT_EQ(full->rows.ratio(), 1.2);
  EXPECT_EQ(full->rows.rows(), 20u);
  EXPECT_EQ(full->rows.region(), -3);
  EXPECT_FALSE(LayersOption::parse("4:first=1,rows=2")->rows.has_region());
  for (const char* text : {"", "wall", ":first=1,rows=2", "wall:", "wall:first=1", "wall:rows=2",
                           "wall:first=1,rows=2,", "wall:first=1,rows=-2", "wall:first=nan,rows=2",
                           "wall:first=inf,rows=2", "wall:first=1,rows=2,height=3",
                           "wall:first=1,rows=2.5", "wall:first,rows=2"})
    EXPECT_FALSE(LayersOption::parse(text)) << text;
}

TEST(LayersOption, ReachTheRequestWithNumbersOfMarkers) {
  Domain domain = square_domain(1);
  domain.names.markers = {{3, "wall"}};
  RequestOptions given;
  ASSERT_EQ(wall_layers().read({"wall:first=1,rows=2", "-4:first=2,rows=3"}, "", given), "");
  const auto options = with_size(given, domain);
  ASSERT_TRUE(options) << options.error().message;
  const auto request = make_request(domain, *options);
  ASSERT_EQ(request.quality().layers_size(), 2);
  EXPECT_EQ(request.quality().layers(0).marker(), 3);
  EXPECT_EQ(request.quality().layers(1).marker(), -4);
  EXPECT_EQ(request.quality().layers(1).rows(), 3u);
  ASSERT_EQ(wall_layers().read({"wal:first=1,rows=2"}, "", given), "");
  given.given = {"layers"};
  EXPECT_EQ(with_size(given, domain).error().message,
            "--layers wal: no marker of the domain is named 'wal': did you mean `wall`?");
}

}  // namespace
}  // namespace weft::client
