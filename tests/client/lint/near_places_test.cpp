// SPDX-License-Identifier: Apache-2.0
#include "client/lint/near_places.h"

#include <gtest/gtest.h>

#include "files/formats/domain_formats.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

TEST(NearPlaces, NameTheSnapThatLintNames) {
  const TempFolder folder;
  const auto file = folder.write(
      "crack.wkt",
      "MULTIPOLYGON (((0 0, 4 0, 4 3, 0 3, 0 0)), ((1 3.0000001, 2 3.0000002, 2 4, 1 4, 1 "
      "3.0000001)))");
  const Domain domain = read_domain(file).value();
  v1::Summary summary;
  EXPECT_EQ(near_places_text(domain, file.string(), summary), "");
  summary.mutable_unrefined()->set_small_input_angle(7);
  EXPECT_EQ(near_places_text(domain, file.string(), summary),
            "2 points of the input are up to 2e-07 off others or off segments: if they should be "
            "one, --snap 2.2e-07 merges them\n");
  const auto sound = folder.write("sound.wkt", "POLYGON ((0 0, 4 0, 4 0.001, 0 0))");
  EXPECT_EQ(near_places_text(read_domain(sound).value(), sound.string(), summary), "");
}

}  // namespace
}  // namespace weft::client
